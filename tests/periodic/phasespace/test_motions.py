"""All motions at given parameters: those known otherwise, in number and by their multipliers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.kept import kept
from support.oscillators import X, oscillator

import periodic as per
import symbolic as sym
from periodic.phasespace.orbits.recurrence import period, return_time
from periodic.phasespace.search.aperiodic import Attractor
from periodic.phasespace.search.birkhoff import digits, rotation_number
from reports.studies.motions import known
from reports.studies.motions.judge import Oscillator

pytestmark = pytest.mark.usefixtures("users_kernels")


def test_three_branches_of_an_oscillator() -> None:
    """Assert two stable motions and a saddle, on one branch, of an oscillator with nonlinear damping."""
    damper = sym.Equations(lambda s, p: {"x": -0.1 * s.x**2 * s.x_dot}, states={}, coordinates=[X])
    system = oscillator(sym.CubicSpring(X, 1.0), damper, force=0.01, omega=1.05, c=0.0)
    found = per.motions(system, box={"x": (-1, 1), "x'": (-1, 1)}, periods=2, seed=1)
    assert [motion.stable for motion in found] == [True, True, False]
    assert [motion.periods for motion in found] == [1, 1, 1]
    assert sum(motion.starts for motion in found) == found.starts == 256
    largest = found[0].orbit
    branch = per.trace(system, "Omega", (0.9, 1.2), start=1.05, guess=largest)
    sheets = sorted(point.multipliers[0].real for point in branch.at(Omega=1.05))
    assert sheets == pytest.approx(sorted(m.point.multipliers[0].real for m in found), rel=1e-4)
    assert found.missed(0.01) == pytest.approx(0.99**256)


def test_gears_where_two_motions_are_stable() -> None:
    """Assert both stable motions and the saddle between them, as the branch has them."""
    gears = sym.scene("gear-pair")
    found = per.motions(gears, {"Omega": 0.7}, box={"x": (-2, 2), "x'": (-2, 2)}, periods=3)
    branch = per.trace(gears, "Omega", (0.4, 1.2), start=1.2)
    sheets = sorted(np.abs(point.multipliers).max() for point in branch.at(Omega=0.7))
    assert sorted(np.abs(m.point.multipliers).max() for m in found) == pytest.approx(sheets, rel=1e-4)
    assert [motion.stable for motion in found] == [True, True, False]
    assert "by Newton's method on the map" in str(found)


def test_two_periods_beside_an_unstable_motion() -> None:
    """Assert that from a saddle of two periods its stable partner is found, which no start leads to."""
    found = per.motions(sym.scene("dry-810N"), starts=64, periods=3)
    assert [(motion.stable, motion.periods) for motion in found] == [(True, 1), (True, 2), (False, 2)]


def test_torus_by_its_rotation_number() -> None:
    """Assert the whirl of a rotor: 1 - 0.50120598859 turns, to eight digits, and the orbit inside."""
    found = per.motions(sym.scene("jeffcott-internal-damping"), {"n": 2.0}, starts=16, periods=2, places=16)
    torus, inside = found
    assert torus.sort == per.phasespace.Sort.TORUS and torus.starts == 16
    assert torus.rotation == pytest.approx(1 - 0.50120598859, rel=1e-7)
    assert not inside.stable and inside.periods == 1


def test_chaos_by_its_exponent() -> None:
    """Assert Ueda's attractor, and two and two of its unstable motions alike, as the equations are."""
    system = known.oscillator(k=0.0, c=0.05, force=7.5)
    found = per.motions(system, box={"x": (-4, 4), "x'": (-6, 6)}, starts=32, periods=2)
    chaos = found[0]
    assert chaos.sort == per.phasespace.Sort.CHAOTIC and chaos.starts == 32
    other = per.lyapunov(system, start={"x": 2.0}, periods=4000)
    assert chaos.exponent == pytest.approx(other.values[0], abs=8 * other.errors[0])
    assert other.errors[0] < 0.005
    assert all(not motion.stable for motion in found.motions[1:])
    once = [abs(m.point.multipliers[0]) for m in found.unstable if m.periods == 1]
    assert sorted(once) == pytest.approx([1.489, 1.489, 13.0], rel=1e-2)


def test_cycle_beside_chaos() -> None:
    """Assert the cycle of period 4.6542037389 with multiplier -0.87709132 beside a chaotic attractor."""
    found = per.motions(known.kinked(), box=dict.fromkeys("xyz", (-4, 4)), starts=48, settle=400, places=16)
    cycle = next(motion for motion in found.stable if motion.sort == per.phasespace.Sort.PERIODIC)
    assert 2 * math.pi / cycle.orbit.parameters["omega"] == pytest.approx(4.6542037389, rel=1e-7)
    assert cycle.point.nontrivial[0].real == pytest.approx(-0.87709132, abs=1e-5)
    assert any(motion.sort == per.phasespace.Sort.CHAOTIC for motion in found.stable)
    assert sum(motion.sort == per.phasespace.Sort.EQUILIBRIUM for motion in found.unstable) == 2


def test_family_that_friction_holds() -> None:
    """Assert that motions with a slider held wherever it is are told as one family."""
    found = per.motions(sym.scene("jenkins-damper"), starts=24, periods=2)
    assert len(found) == 1 and found[0].starts == 24
    assert "held all along, wherever it is" in found[0].why


def test_along_a_parameter() -> None:
    """Assert that the branch of the one motion found brings the others at its value."""
    gears = sym.scene("gear-pair")
    given = {"box": {"x": (1.0, 1.2), "x'": (-0.05, 0.05)}, "starts": 2, "places": 0}
    alone = per.motions(gears, {"Omega": 0.7}, **given)
    found = per.motions(gears, {"Omega": 0.7}, along={"Omega": (0.4, 1.2)}, **given)
    assert len(alone) == 1 and len(found) == 3
    assert found.tried[-1] == "the branches of all orbits over Omega from 0.4 to 1.2: 2 more orbits"


def test_walls_and_divergence() -> None:
    """Assert that no motion starts behind a wall, and that those that grow are counted."""
    wall = oscillator(sym.RigidStop(X, gap=0.2, restitution=0.5))
    found = per.motions(wall, box={"x": (-1, 1), "x'": (-1, 1)}, starts=40, places=0, periods=3)
    assert sum(motion.starts for motion in found) + found.undecided == 40
    runaway = oscillator(sym.CubicSpring(X, -1.0), force=0.01, omega=0.3)
    grown = per.motions(runaway, box={"x": (-3, 3), "x'": (-3, 3)}, starts=40, places=0, periods=1)
    assert grown.diverged > 10 and grown.diverged + grown[0].starts == 40
    assert f"{grown.diverged} diverged" in repr(grown)


@kept
def linear() -> per.phasespace.Motions:
    """The one motion of a linear oscillator."""
    return per.motions(oscillator(), starts=8, periods=1, places=4)


def test_result_reads_well() -> None:
    """Assert the table, and what one motion says."""
    found = linear()
    assert repr(found[0]) == "Motion(stable, periodic, largest multiplier 0.7304, by 8 of the starts)"
    assert str(found).splitlines()[0].split() == [
        "motion",
        "share",
        "of",
        "the",
        "box",
        "95",
        "%",
        "tells",
        "found",
    ]
    assert "8 starts, a basin of 1 % is missed with a probability of 0.92" in str(found)
    assert "<table" in found._repr_html_()
    assert found[0].interval == pytest.approx((0.6305833, 1.0))
    with pytest.raises(ValueError, match="share is 2; it must lie between 0 and 1"):
        found.missed(2)


def test_refusals() -> None:
    """Assert the sentences for boxes, numbers and systems that are not allowed."""
    system = oscillator()
    for box, told in (
        ({"y": (0, 1)}, "box has 'y'; it must be one of x, x'"),
        ({"x": (1, 1)}, r"box\['x'\] is \(1, 1\); it must be two finite numbers, the first the smaller"),
        ({"x": (0, math.inf)}, r"box\['x'\] is \(0, inf\); it must be two finite numbers"),
        ({"x": 3}, r"box\['x'\] is 3; it must be two finite numbers"),
        ([1], r"box is \[1\]; it must give ranges of states by their names"),
    ):
        with pytest.raises(ValueError, match=told):
            per.motions(system, box=box)
    for name in ("periods", "starts", "settle"):
        with pytest.raises(ValueError, match=f"{name} is 0; it must be a whole number of at least 1"):
            per.motions(system, **{name: 0})
    with pytest.raises(ValueError, match="it must have the value, 1, inside"):
        per.motions(system, starts=4, places=0, along={"Omega": (2.0, 3.0)})
    with pytest.raises(ValueError, match=r"parameter is 'G'; it must be one of"):
        per.motions(system, {"G": 1.0})
    behind = oscillator(sym.RigidStop(X, gap=0.2, restitution=0.5))
    with pytest.raises(ValueError, match="less than one in 100 of its states is before all walls"):
        per.motions(behind, box={"x": (1, 2), "x'": (-1, 1)})


def test_recurrence() -> None:
    """Assert periods of made-up motions: the least one, and none of what never comes back."""
    unit = np.ones(2)
    steps = np.arange(40)
    three = np.column_stack([np.cos(2 * np.pi * steps / 3), np.sin(2 * np.pi * steps / 3)])
    assert period(three, 6, unit, 1e-3) == 3
    assert period(three + 0.5 * np.exp(-steps)[:, None], 6, unit, 1e-3) == 3
    assert period(np.column_stack([np.cos(2 * steps), np.sin(2 * steps)]), 6, unit, 1e-3) == 0
    t = np.arange(2048)
    turns = np.column_stack([np.sin(2 * np.pi * t / 57.3), np.cos(2 * np.pi * t / 57.3)])
    assert return_time(turns, 2 * unit, 0.05) == pytest.approx(57.3, abs=1e-2)
    assert math.isnan(return_time(np.random.default_rng(1).normal(size=(2048, 2)), unit, 0.05))


def test_averages_tell_tori_from_chaos() -> None:
    """Assert the digits of averages over a circle and over the logistic map, and the circle's rotation."""
    turn = (math.sqrt(5) - 1) / 2
    angle = 2 * np.pi * turn * np.arange(4000)
    circle = np.column_stack([np.cos(angle), np.sin(angle) + 0.2 * np.cos(3 * angle)])
    assert digits(circle, np.ptp(circle, axis=0)) > 8
    assert rotation_number(circle, np.ones(2)) == pytest.approx(1 - turn, abs=1e-9)
    chaos = np.empty((4000, 1))
    chaos[0] = 0.3
    for k in range(3999):
        chaos[k + 1] = 4 * chaos[k] * (1 - chaos[k])
    assert digits(chaos, np.ones(1)) < 3.5


def test_chaos_in_bands_is_no_torus() -> None:
    """Assert chaos of three bands visited in turn, whose averages converge like a torus'."""
    oscillator = Oscillator(38)
    box = {"x": (-3, 3), "x'": (-3, 3)}
    found = per.motions(oscillator.system(), box=box, starts=48, periods=4, places=0)
    sorts = {motion.sort: motion.periods for motion in found.stable}
    assert sorts == {per.phasespace.Sort.PERIODIC: 4, per.phasespace.Sort.CHAOTIC: 0}


def test_attractor_that_was_lost_has_no_motion() -> None:
    """Assert that others are not said to be on one of which nothing is known."""
    lost = Attractor(np.zeros((0, 2)), per.phasespace.Sort.OPEN, math.nan, math.nan, "lost")
    assert not lost.has(np.ones((500, 2)), np.ones(2))
