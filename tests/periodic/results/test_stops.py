"""Why a branch ends, at both of its ends."""

from __future__ import annotations

import pytest
from support.traces import duffing_system

import periodic as per
from periodic.results.stop import Reason, Stop


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


NUMERICAL = {"MAX_POINTS", "MAX_NEWTON", "SMALL_STEP", "RETRACED", "NO_START", "INACCURATE"}


@pytest.mark.parametrize("reason", list(Reason))
def test_kinds_of_reasons(reason: Reason) -> None:
    """Assert which ends are numerical, and from which a branch goes on."""
    assert reason.numerical is (reason.name in NUMERICAL)
    assert reason.resumable is (reason.name in {"MAX_POINTS", "MAX_NEWTON", "INTERRUPTED"})


@pytest.mark.parametrize(
    ("stop", "said"),
    [
        (Stop.after(Reason.CLOSED, 7), "it came back to its start after 7 points"),
        (Stop.after(Reason.EQUILIBRIUM, 7), "the orbits shrank to it after 7 points"),
        (Stop.after(Reason.HOMOCLINIC, 12.34567), "the period grows without bound, 12.35 s here"),
        (
            Stop.after(Reason.VANISHED, 1.234e-9),
            "the motion has shrunk to rounding, 1.2e-09 peak to peak (scaled)",
        ),
        (
            Stop.after(Reason.UNBOUNDED, 1.234e9),
            "the parameter stands still, 1.2e+09 peak to peak (scaled) here",
        ),
        (Stop.after(Reason.INTERRUPTED, 7), "after 7 points"),
        (Stop.after(Reason.MAX_POINTS, 7), "7 points"),
        (Stop.asked("LP", 1), "LP met 1 time"),
        (Stop.asked("LP", 2), "LP met 2 times"),
        (Stop.max_newton(1), "1 iteration"),
        (Stop.max_newton(200, "at the start"), "200 iterations, at the start"),
    ],
)
def test_details_of_stops(stop: Stop, said: str) -> None:
    """Assert counts and sizes, in the plural of several."""
    assert stop.detail == said and str(stop) == f"{stop.reason.value}: {said}"
