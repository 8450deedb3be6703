"""Motions that settle late: slowly, after chaos for a while, on orbits of more periods than asked for."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
import scipy

import periodic as per
import symbolic as sym
from periodic.phasespace.following.crowd import Crowd
from reports.studies.motions.rub import BOX as RUB_BOX
from reports.studies.motions.rub import rotor

pytestmark = pytest.mark.usefixtures("users_kernels")

BOX = {"x": (-1.2, 1.2), "y": (-1.2, 1.2), "x'": (-1, 1), "y'": (-1, 1)}

RING, GAP, FRICTION, DAMPING, UNBALANCE = 30.0, 1.05, 0.05, 0.1, 0.4


@cache
def rubbing(weight: float, other: float = 1.0, unbalance: float = UNBALANCE) -> sym.CompiledSystem:
    """A rotor in a ring, under its weight or in unlike bearings, at its critical speed."""
    x, y, speed = sym.coordinate("x"), sym.coordinate("y"), sym.parameter("speed", 1.0)
    model = sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.Damper(x, DAMPING) + sym.Damper(y, DAMPING)
    model = model + sym.Spring(x, 1.0) + sym.Spring(y, other) + sym.ConstantForce(y, -weight)
    model = model + sym.Unbalance(x, y, 1.0, unbalance, speed)
    return sym.compile(model + sym.Rub(x, y, RING if weight else 25.0, GAP, FRICTION))


def rates(t: float, state: Any, weight: float) -> list[float]:
    """The same by hand, at speed 1."""
    x, y, vx, vy = state
    r = math.hypot(x, y)
    push = RING * max(r - GAP, 0.0)
    fx, fy = -push * (x - FRICTION * y) / r, -push * (y + FRICTION * x) / r
    ax = UNBALANCE * math.cos(t) - DAMPING * vx - x + fx
    ay = UNBALANCE * math.sin(t) - DAMPING * vy - y + fy - weight
    return [vx, vy, ax, ay]


def test_eight_periods_after_chaos_for_a_while() -> None:
    """Assert both motions of a rotor, one of eight periods, that are reached after hundreds of them."""
    found = per.motions(rubbing(0.2), box=BOX, starts=16, places=0, settle=600)
    stable = [motion for motion in found if motion.stable]
    assert sorted(motion.periods for motion in stable) == [2, 8]
    assert sum(motion.starts for motion in stable) == 16 and found.undecided == 0
    (eight,) = [motion for motion in stable if motion.periods == 8]
    assert eight.point is None and "no orbit was found beside it" in eight.why
    start, turn = found.state_of(eight), 2 * math.pi
    at = turn * np.arange(9)
    given: dict[str, Any] = {"t_eval": at, "rtol": 1e-10, "atol": 1e-12, "method": "DOP853", "max_step": 0.02}
    states = [start[name] for name in ("x", "y", "x'", "y'")]
    path = scipy.integrate.solve_ivp(rates, (0, at[-1]), states, args=(0.2,), **given).y.T
    assert np.abs(path[8] - path[0]).max() < 1e-6
    assert np.abs(path[4] - path[0]).max() > 1e-3


def test_slow_motions_are_waited_for() -> None:
    """Assert that all motions end at an orbit to which they come nearer by 0.7 % in three periods."""
    found = per.motions(rubbing(0.0, 1.2, 0.5), {"speed": 1.6}, box=BOX, starts=16, places=0, settle=300)
    (motion,) = found
    assert (motion.periods, motion.starts, motion.stable) == (3, 16, True)
    assert abs(motion.point.multipliers[0]) == pytest.approx(0.9933, abs=1e-4)


def test_orbit_where_a_first_mesh_leads_elsewhere() -> None:
    """Assert the orbit of a rub at the speed asked for, with the multipliers of the motion's own tangents."""
    found = per.motions(rotor(), {"speed": 1.25}, box=RUB_BOX, starts=8, places=0, periods=2)
    (cycle,) = [motion for motion in found.stable if motion.periods == 1 and motion.starts]
    names = [p.name for p in cycle.orbit.layout.parameters]
    assert cycle.orbit.parameter[names.index("speed")] == 1.25 and cycle.why == ""
    assert cycle.orbit.parameter.tolist() == list(found.values.values())
    crowd = Crowd(rotor(), cycle.orbit.parameter, 1e-11)
    y = crowd.begin(cycle.sections)
    after = crowd.run(y, 1, 2 * math.pi, tangents=crowd.tangents(y), raw=True)
    assert after.ends[0] == pytest.approx(y[0], abs=1e-7)
    own = np.sort(np.abs(np.linalg.eigvals(after.tangents[0][:, :4])))
    assert own == pytest.approx(np.sort(np.abs(cycle.point.multipliers)), abs=1e-6)


def test_torus_near_a_resonance_is_one() -> None:
    """Assert one torus, 1.2e-6 from 25/84, whose motions show 84 points each, as Newton's method has it."""
    found = per.motions(rotor(), {"speed": 1.7}, box=RUB_BOX, starts=32, places=0, periods=2, settle=1000)
    tori = [motion for motion in found if motion.sort == per.phasespace.Sort.TORUS]
    torus = per.settled_torus(rotor(), {"speed": 1.7}, start={"x": 0.9})
    turns = min(torus.rotation_number, 1 - torus.rotation_number)
    assert len(tori) == 1 and tori[0].rotation == pytest.approx(turns, abs=1e-7)
    assert abs(turns - 25 / 84) < 2e-6
