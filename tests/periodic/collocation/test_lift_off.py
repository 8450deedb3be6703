"""Branches on which a gap closes for good and opens again, judged by shooting and in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference.returning import Rates, shot
from support.kept import kept
from support.stops import errors, exactly, stopped

import periodic as per
import symbolic as sym
from periodic.events.switchpolynomials import SwitchPolynomials

each_way = pytest.mark.parametrize("start", [0.2, 2.0], ids=["closes", "opens"])


def rub(w: float) -> Rates:
    """m = k = 1, c = 0.2, e = 0.3, weight 0.1, stator of stiffness 2 and friction 0.1 at r = 1."""

    def found(tau: float, s: np.ndarray) -> list[float]:
        x, vx, y, vy = s
        r = math.hypot(x, y)
        p = 2 * max(r - 1, 0) / r
        fx = 0.3 * w**2 * math.cos(tau) - 0.2 * w * vx - x - p * (x - 0.1 * y)
        fy = 0.3 * w**2 * math.sin(tau) - 0.2 * w * vy - y - p * (y + 0.1 * x) - 0.1
        return [vx, fx / w**2, vy, fy / w**2]

    return found


@kept
def rotor(start: float) -> per.Branch:
    """A rotor that rubs: from no contact to a whirl all round the stator, and back to none."""
    places = (0.97, 0.971, 0.972)
    return per.trace(sym.scene("jeffcott-rub"), "speed", (0.2, 2.0), start=start, at=places)


@each_way
def test_last_gap_of_a_rotor(start: float) -> None:
    """Assert that the branch gets to its end, its folds, and orbits on either side of the last gap."""
    found = rotor(start)
    assert found.stop.reason is per.Reason.BOUND
    folds = sorted(point.parameter for point in found.labelled(per.Label.FOLD))
    assert folds == pytest.approx([1.1786537447, 1.3407996345], abs=1e-9)
    assert len(found.labelled(per.Label.USER)) == 3
    for point in found.labelled(per.Label.USER):
        begin = point.orbit.state(np.zeros(1))[0]
        own = shot(rub(point.parameter), begin, np.ones(4))
        assert begin == pytest.approx(own.start, abs=1e-7)
        assert abs(point.multipliers[0]) == pytest.approx(abs(own.multipliers[0]), rel=1e-4)
        path = own.path(np.linspace(0, 2 * np.pi, 4001))
        gap = 1 - np.hypot(path[0], path[2]).min()
        assert (gap > 0) == (point.parameter < 0.9715)
        assert len(point.orbit.mesh.events) == (2 if gap > 0 else 0)


@each_way
def test_grazings_of_a_rotor(start: float) -> None:
    """Assert where contact and gaps begin and end: there the rotor just reaches the stator's surface."""
    grazings = rotor(start).labelled(per.Label.GRAZING)
    expected = [0.89535324, 0.97103452, 1.17866921, 1.17958135, 1.18462761, 1.19334947]
    assert sorted(point.parameter for point in grazings) == pytest.approx(expected, abs=1e-7)
    for point in grazings:
        dense = SwitchPolynomials(sym.scene("jeffcott-rub"), point.orbit)
        depths = [abs(dense.value(e)) for side in (-1, 1) for e in dense.minima(0, side)]
        assert min(depths) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("way", [(4.9, 9.0), (9.0, 4.9)], ids=["closes", "opens"])
def test_preloaded_stop(way: tuple[float, float]) -> None:
    """Assert orbits and multipliers of a mass pressed against its stop, which lifts off near resonance."""
    found, exact = per.trace(stopped(20.0, -0.3), "Omega", way), exactly(20.0, -0.3)
    assert found.stop.reason is per.Reason.BOUND
    (grazing,) = found.labelled(per.Label.GRAZING)
    assert grazing.minimum["q"] == pytest.approx(-0.3, abs=1e-8)
    for point in found:
        if point is not grazing:
            gap, apart = errors(exact, point)
            assert gap < 1e-9
            assert apart < 1e-7
            assert len(point.orbit.mesh.events) == (0 if point.parameter > grazing.parameter else 2)


def test_extremes_are_none_of_the_mesh_points() -> None:
    """Assert that a switch has as many minima as the motion, wherever intervals meet."""
    (grazing,) = rotor(0.2).labelled(per.Label.GRAZING)[:1]
    dense = SwitchPolynomials(sym.scene("jeffcott-rub"), grazing.orbit)
    radius = np.hypot(
        *(grazing.orbit[name](np.linspace(0, grazing.orbit.period, 4001)[:-1]) for name in "xy")
    )
    peaks = (radius >= np.roll(radius, 1)) & (radius > np.roll(radius, -1))
    assert len(dense.minima(0, -1)) == peaks.sum()
