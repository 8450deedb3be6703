"""A change of pattern just ahead of where even the shortest step fails: by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from periodic.tracing.steps import stepper, taken
from periodic.tracing.steps.stepsize import ArclengthControl


class Ledger(taken.Steps):
    """Steps whose ledger leaves open what is given."""

    left: tuple[str, ...] = ()

    def unaccounted(self, ledger: object) -> Any:
        """What is left open."""
        return self.left

    def _course(self, base: object, length: float) -> Any:
        return base, length


@pytest.mark.parametrize(
    ("failed", "left", "low", "value", "taken_so"),
    [
        (1e-7, (), 0.0, 0.5, True),
        (3e-7, (), 0.0, 0.5, False),  # there is no change so far ahead
        (1e-7, ("fold",), 0.0, 0.5, False),
        (1e-7, (), 0.9, 0.5, False),  # beyond the bound
        (1e-7, (), 0.0, 0.75, False),  # at a value of the user's
    ],
)
def test_change_just_ahead_of_the_shortest_step(
    failed: float,
    left: tuple[str, ...],
    low: float,
    value: float,
    taken_so: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Assert that it is sought twice as far, and reached where nothing is to be located on the way."""
    end: Any = SimpleNamespace(value=value)
    at = SimpleNamespace(end=end, ds=1.5e-7)
    monkeypatch.setattr(stepper, "reached", lambda solver, base, near, ds, change: at if ds == 2e-7 else None)
    monkeypatch.setattr(taken, "entry", lambda *_: None)
    solver: Any = SimpleNamespace(problem=SimpleNamespace(low=low, high=1.0))
    steps = Ledger(solver, ArclengthControl(), (), ())
    foresight: Any = SimpleNamespace(change=lambda base, ds: "change")
    object.__setattr__(steps, "left", left)
    object.__setattr__(steps, "_stepper", stepper.Stepper(solver, ArclengthControl(), foresight))
    base: Any = "base"
    step = steps._just_ahead(base, failed, taken.Sought([0.75], 0.6, (), taken.Course()))
    assert (step is not None) == taken_so
    if step is not None:
        assert (step.end, step.special, step.change, step.course) == (end, [], at, ("base", 1.5e-7))
