"""The memory that condensed orbits are said to take, against what they do."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable, Sequence
from typing import Any

import pytest
from support.cantilevers import cantilever, cubic

import periodic as per
import symbolic as sym
from periodic.condensed.memory import CACHE, Memory, portions


def joint(tip: Any) -> list[sym.Part]:
    """An elastic element that slips: a state of its own."""
    return [sym.Jenkins(tip, 30.0, 0.1, creep=1e-2)]


@pytest.mark.parametrize(("parts", "own", "intervals"), [(cubic, 0, 200), (joint, 1, 400)])
def test_is_about_what_a_branch_takes(
    parts: Callable[[Any], Sequence[sym.Part]], own: int, intervals: int
) -> None:
    """Assert that three orbits of 20 modes take less, but more than a quarter: it allows for six."""
    system = cantilever(10, parts, damping=0.02, force=0.02)
    method = per.Collocation(ntst=intervals, ntst_min=intervals, ntst_max=intervals)
    few = per.ArclengthControl(max_points=3)
    tracemalloc.start()
    try:
        found = per.trace(system, "Omega", (2.045, 2.06), start=2.045, control=few, method=method)
        taken = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    orbit = found.points[-1].orbit
    assert orbit.mesh.ntst == intervals
    said = Memory(orbit.mesh.scheme.ncol, 2, 1, own, 20, 1.0, own > 0).peak(intervals)
    assert 0.25 * said < taken < said


def test_most_intervals_are_those_that_fit() -> None:
    """Assert that one interval more would not, and that all fit where they may take more."""
    given = Memory(6, 2, 1, 0, 20, 1.0, False)
    most = given.most(1000, 1e8)
    assert given.peak(most) <= 1e8 < given.peak(most + 1)
    assert given.most(1000, 1e12) == 1000
    assert given.most(1000, 1.0) == 0


@pytest.mark.parametrize(
    ("intervals", "each", "at_once"), [(7, CACHE / 3, 3), (6, CACHE / 3, 3), (4, 2 * CACHE, 1)]
)
def test_portions_are_all_intervals_in_turn(intervals: int, each: float, at_once: int) -> None:
    """Assert that no interval is left out, none comes twice, and none comes with more than CACHE holds."""
    found = list(portions(intervals, each))
    assert [k for some in found for k in range(intervals)[some]] == list(range(intervals))
    assert max(some.stop - some.start for some in found) == at_once
