"""Sliders side by side that come to be let go at once where a slip ends or begins (`rewrites/letgo.py`)."""

from __future__ import annotations

import pytest
from support.drawn.jointcases import DOWN, drawn_joints

import periodic as per

TOL = 1e-6


@pytest.mark.parametrize(
    ("seed", "bounds", "grazings"),
    [
        # three sliders slip as one and stop together; one slips by itself, less and less
        (177, (0.4096, 0.4090), (0.4092295930, 0.4091973773)),
        # a slider reaches its limit where the strain turns, at which another one stops
        (142, (0.6372, 0.6369), (0.6370639675,)),
    ],
)
def test_from_both_sides(seed: int, bounds: tuple[float, float], grazings: tuple[float, ...]) -> None:
    """Assert that branches lead past both kinds of places from either side, which lie where they lay.

    The places agree to 1e-8, what the orbits have at either end of the range to 1e-6 of it.
    """
    case = drawn_joints(DOWN, seed)
    control = per.ArclengthControl(max_points=40)
    found = []
    for way in (bounds, bounds[::-1]):
        branch = per.trace(case.system, "Omega", way, tol=TOL, control=control)
        assert branch.stop.reason is per.Reason.BOUND, str(branch.stop)
        at = sorted(point.parameter for point in branch if point.label is per.Label.GRAZING)
        assert at == pytest.approx(sorted(grazings), rel=1e-8)
        found.append(sorted(branch, key=lambda point: point.parameter))
    for one, other in ((found[0][k], found[1][k]) for k in (0, -1)):
        assert one.parameter == other.parameter
        for name in one.maximum:
            assert one.maximum[name] == pytest.approx(other.maximum[name], rel=1e-6, abs=1e-6)
        assert len(one.orbit.phases) == len(other.orbit.phases)
