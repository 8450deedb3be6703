"""A change of pattern just ahead of where even the shortest step fails: by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from periodic.tracing.steps import stepper, taken
from periodic.tracing.steps.stepsize import ArclengthControl


def test_change_just_ahead_of_the_shortest_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is sought twice as far, special points on the way located, and none left unaccounted."""
    asked: list[float] = []
    foresight: Any = SimpleNamespace(change=lambda base, ds: asked.append(ds) or "change")
    at = SimpleNamespace(end="end", ds=1.5e-7, change=SimpleNamespace(final=True))
    monkeypatch.setattr(stepper, "reached", lambda solver, base, near, ds, change: at if ds == 2e-7 else None)
    steps = stepper.Stepper(None, ArclengthControl(), foresight)  # type: ignore[arg-type]
    base: Any = "base"
    assert steps.just_ahead(base, 1e-7) is at and asked == [2e-7]
    sought: Any = taken.Sought([], 0.0, (), taken.Course())
    own: Any = SimpleNamespace(
        _stepper=steps, solver=None, control=ArclengthControl(), _course=lambda *_: "course"
    )
    own._check_balance = lambda *_: None
    monkeypatch.setattr(taken, "special_points", lambda *given: ["fold"] if given[4].final else [])
    step = taken.Steps._just_ahead(own, base, 1e-7, sought)
    assert step is not None and (step.end, step.special, step.change, step.course) == (
        "end",
        ["fold"],
        at,
        "course",
    )

    def unbalanced(*_: object) -> None:
        raise taken.RejectedError("multipliers leave the circle")

    own._check_balance = unbalanced
    assert taken.Steps._just_ahead(own, base, 1e-7, sought) is None
    assert taken.Steps._just_ahead(own, base, 3e-7, sought) is None
