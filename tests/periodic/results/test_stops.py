"""Why a branch ends, at both of its ends."""

from __future__ import annotations

import pytest
from support.traces import duffing_system

import periodic as per
from periodic.results.stop import Stop


def test_both_ends_are_told() -> None:
    """Assert that a branch cut short one way says so beside the bound that it reached the other way."""
    system = duffing_system(0.1, 1.0, 0.5)
    found = per.trace(
        system, "Omega", (0.5, 3.0), start=1.0, control=per.ArclengthControl(max_points=4, ds_max=0.02)
    )
    assert [stop.reason for stop in found.stops] == [found.stop_backwards.reason, found.stop.reason]
    assert found.ending == str(found.stop) and "the other way" not in repr(found)
    closed = per.trace(
        system, "Omega", (0.5, 1.01), start=1.0, control=per.ArclengthControl(max_points=4, ds_max=0.02)
    )
    assert [stop.reason for stop in closed.stops] == [per.Reason.MAX_POINTS, per.Reason.BOUND]
    assert closed.ending.endswith("the other way largest number of points reached: 4 points")
    assert closed.ending in repr(closed)


@pytest.mark.parametrize(
    ("value", "told"), [(0.5, "lower end of the range"), (3.0, "upper end of the range")]
)
def test_end_of_the_range(value: float, told: str) -> None:
    """Assert which end of the range is told, and that a branch is where it began if it is."""
    assert Stop.bound((0.5, 3.0), value, 1.0) == Stop(per.Reason.BOUND, told)
    back = Stop.bound((0.5, 3.0), value, value)
    assert back.detail == f"{told}, where it began: it turned back"
