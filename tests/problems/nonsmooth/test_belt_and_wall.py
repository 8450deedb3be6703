"""A mass on a moving belt before a rigid wall: events of friction meet impacts that have speed.

x'' + c x' + x = cos(w t) - f sign(x' - v), x' becomes -e x' at the wall; judged by the closed form of
`reference.beltwall`, orbits and multipliers.
"""

from __future__ import annotations

import numpy as np
import pytest
from howto.test_joint import Belt
from reference.beltwall import BeltWall

import periodic as per
import symbolic as sym

RANGE = 0.5, 2.2

AFTER = BeltWall(c=0.1, v=0.95, f=0.16, gap=1.9, e=0.5, below=True)
"""Its rebound reaches the belt's speed: friction turns just after an impact, or at it."""

BEFORE = BeltWall(c=0.1, v=0.15, f=0.5, gap=0.4, e=0.7)
"""It arrives at the wall with the belt's speed, and is let go by it just before an impact, or at it."""

ALONE = BeltWall(c=0.145, v=0.834, f=0.238, gap=0.376, e=0.643, below=True)
"""Its friction turns just after an impact and nowhere else, and then not at all: it has no event nodes."""

CAUGHT = BeltWall(c=0.17, v=0.5, f=0.43, gap=0.56, e=0.43, below=True)
"""It rebounds with the belt's speed, and is caught from either side."""


def system(machine: BeltWall) -> sym.CompiledSystem:
    """The compiled machine."""
    x = sym.coordinate("x", unit="m")
    wall = sym.RigidStop(x, machine.gap, machine.e, machine.below)
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, machine.c)
    return sym.compile(model + Belt(x, machine.f, machine.v) + wall + sym.HarmonicForce(x, 1.0))


@pytest.fixture(scope="module", params=[0.5, 2.2])
def branch(request: pytest.FixtureRequest) -> per.Branch:
    """The branch over its whole range, from either end."""
    return per.trace(system(AFTER), "Omega", RANGE, start=request.param)


def test_whole_range(branch: per.Branch) -> None:
    """Assert that it gets through, and where it folds, grazes and passes corners, alike from both ends.

    To 1e-8. The corners are the third and the fourth GR.
    """
    assert branch.stop.reason is per.Reason.BOUND
    assert not branch.unaccounted
    grazings = sorted(p.parameter for p in branch.labelled(per.Label.GRAZING))
    expected = [0.605005828, 0.685163692, 0.997374247, 1.212027277, 1.370055530, 1.652876641]
    assert grazings == pytest.approx(expected, abs=1e-8)
    folds = sorted(p.parameter for p in branch.labelled(per.Label.FOLD))
    assert folds == pytest.approx([1.212027277, 1.382358578], abs=1e-8)


def test_orbits_and_multipliers(branch: per.Branch) -> None:
    """Assert every fourth orbit and its multipliers: to 1e-8 and 1e-6, or ten times what is claimed."""
    assert judged(branch, AFTER) > 10


@pytest.mark.parametrize(
    ("machine", "bounds", "words"),
    [
        (BEFORE, (0.8, 1.8), ["+-M", "+M", "+M+0-M", "+M+0M"]),
        (ALONE, (0.52, 0.75), ["P-M", "MM"]),
        (CAUGHT, (1.2, 1.8), ["M+-", "M0+-", "P0+-", "P0+0-"]),
    ],
)
def test_before_and_after(machine: BeltWall, bounds: tuple[float, float], words: list[str]) -> None:
    """Assert that branches pass what happens before impacts, and stops after them; orbits as above.

    Their words are those of their own motions: an impact takes over what friction did just before it, and a
    stop after it is reached from the other side of the belt's speed.
    """
    branch = per.trace(system(machine), "Omega", bounds, start=bounds[1])
    assert branch.stop.reason is per.Reason.BOUND
    assert not branch.unaccounted
    assert judged(branch, machine) > 3
    passed = [machine.after(*away(point, machine), point.parameter)[2] for point in branch]
    assert [word for word in dict.fromkeys(passed) if word in words] == words


def judged(branch: per.Branch, machine: BeltWall) -> int:
    """Assert orbits against the closed form, but those at a corner or grazing; return how many."""
    grazings = {point.parameter for point in branch.labelled(per.Label.GRAZING)}
    points = [point for point in branch[::4] if point.parameter not in grazings]
    for point in points:
        begin, state = away(point, machine)
        end, matrix, _ = machine.after(begin, state, point.parameter)
        growth = max(1.0, float(np.abs(matrix).max()))
        assert end == pytest.approx(state, abs=max(1e-8, 10 * point.error.orbit) * growth)
        own, claimed = point.multipliers, max(1e-6, 10 * point.error.multiplier)
        found = own.sum().real, np.prod(own).real
        size = max(1.0, float(np.abs(own).max())) ** 2
        assert found == pytest.approx((np.trace(matrix), np.linalg.det(matrix)), abs=claimed * size)
    return len(points)


def away(point: per.Point, machine: BeltWall) -> tuple[float, np.ndarray]:
    """A time of an orbit, and its state there, that is far from the wall and from the belt's speed."""
    times = point.orbit.grid.left / point.parameter
    x, v = point.orbit["x"](times), point.orbit["x'"](times)
    clear = machine.gap + x if machine.below else machine.gap - x
    k = int(np.minimum(np.abs(v - machine.v), clear).argmax())
    return float(times[k]), np.array([x[k], v[k]])
