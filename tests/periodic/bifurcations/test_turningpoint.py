"""Folds and what they are called among special points, of solutions that are given."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.bifurcations import turningpoint
from periodic.bifurcations.label import Label
from periodic.bifurcations.turningpoint import MERGED, Found
from periodic.stability.multipliers import Stability


@pytest.mark.parametrize(
    ("apart", "label"),
    [
        ((0.04, 0.5, 1.0), Label.BRANCH),
        ((0.04, 1.0, 0.5), Label.BRANCH),
        ((0.06, 0.5, 1.0), Label.FOLD),
        ((1.0, 0.01, 1.0), Label.FOLD),
        ((0.0, 0.0, 0.0), Label.FOLD),
        ((0.0, np.inf, 1.0), Label.FOLD),
    ],
)
def test_fold_at_an_orbit_of_a_smaller_period(
    apart: tuple[float, float, float], label: Label, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that it is a branch point where its orbit is far less from its own copy than the step's ends."""
    own, base, new = (SimpleNamespace(apart=each) for each in apart)
    new.discretisation = SimpleNamespace(stability=Stability.MULTIPLIERS)
    monkeypatch.setattr(turningpoint, "from_itself", lambda solution: solution.apart)
    monkeypatch.setattr(turningpoint, "shrinks", lambda *_: False)
    tests = SimpleNamespace(
        picked=lambda problem: None,
        TESTS={Stability.MULTIPLIERS: ()},
        BESIDE_FOLDS={Stability.MULTIPLIERS: ()},
    )
    monkeypatch.setattr(turningpoint, "codim2", tests)
    within: Any = SimpleNamespace(base=base, solver=SimpleNamespace(problem=SimpleNamespace(trivial=0)))
    fold = Found(Label.FOLD, 0.5, own)  # type: ignore[arg-type]
    assert turningpoint.named(within, fold, new, 1.0).label is label  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("spans", "autonomous", "gone"),
    [
        ((0.9 * MERGED, 1.0, 2.0), True, True),
        ((0.9 * MERGED, 2.0, 1.0), True, True),
        ((1.1 * MERGED, 1.0, 2.0), True, False),
        ((0.0, 1.0, 1.0), False, False),
    ],
)
def test_autonomous_orbits_that_shrink(
    spans: tuple[float, float, float], autonomous: bool, gone: bool
) -> None:
    """Assert that an orbit has shrunk to an equilibrium that is far smaller than both ends of the step."""
    problem = SimpleNamespace(autonomous=autonomous)
    fold, base, new = (
        SimpleNamespace(problem=problem, orbit=SimpleNamespace(span=lambda size=size: size)) for size in spans
    )
    assert turningpoint.shrinks(fold, base, new) is gone  # type: ignore[arg-type]
