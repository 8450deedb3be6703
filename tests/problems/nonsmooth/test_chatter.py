"""Impacts without number that end in rest on a wall: the bouncing mass on a shaken table, in closed form.

y'' + k y = F cos(tau) - g over the table, F = A Omega^2 of one that is shaken by A; the spring is weak and
makes the search for a rest possible.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from reference.chatter import Chatter
from support.kept import kept

import periodic as per
import symbolic as sym

STIFFNESS, LOAD, RESTITUTION = 0.05, 1.0, 0.5

TOLERANCE = 1e-8
"""Of simulations."""

ABOVE = LOAD / STIFFNESS + 0.5
"""From where it would hang without the table to above it."""


@cache
def system() -> sym.CompiledSystem:
    """The table."""
    y = sym.coordinate("y", unit="m", start=0.1)
    model = sym.Mass(y, 1.0) + sym.Spring(y, STIFFNESS) + sym.RigidStop(y, 0.0, RESTITUTION, below=True)
    return sym.compile(model + sym.ConstantForce(y, -LOAD) + sym.HarmonicForce(y, 1.2, 1.0))


@cache
def settled(force: float) -> sym.Simulation:
    """The motion on it."""
    return sym.simulate(system(), {"F": force}, knock={"y": ABOVE}, settle=3, tolerance=TOLERANCE)


@kept
def branch() -> per.Branch:
    """Orbits that rest, over the force."""
    motion = settled(1.2)
    guess = per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter, system=system())
    return per.trace(system(), "F", (1.05, 1.5), start=1.2, guess=guess)


def test_simulation_rests() -> None:
    """Assert that a motion chatters, rests and leaves, against closed form.

    Its impacts come to ten times the tolerance over their speeds: the integrator's error is one of height.
    """
    events, (exact, rest) = settled(1.2).events, judge(1.2).impacts()
    assert [event.after for event in events[-2:]] == [2, 1]
    found = np.array([event.phase for event in events])
    first = np.array(exact) - 2 * np.pi
    allowed = 10 * TOLERANCE / bounces(judge(1.2), exact)
    assert (np.abs(found[:8] - first[:8]) < allowed[:8]).all()
    assert found[-2] == pytest.approx(rest - 2 * np.pi, abs=1e-3)
    assert found[-1] == pytest.approx(judge(1.2).release, abs=1e-6)


def test_table_that_is_not_left() -> None:
    """Assert that the mass rests for good where the table's acceleration is less than the load."""
    motion = settled(0.9)
    assert not motion.events
    assert np.abs(motion["y"]).max() == 0.0


def test_orbits_rest() -> None:
    """Assert impacts, release and motion to 1e-9 against closed form, and multipliers of 0."""
    assert branch().stop.reason is per.Reason.BOUND
    for point in branch()[::3]:
        own, orbit = judge(point.parameter), point.orbit
        exact, rest = own.impacts()
        assert orbit.phases[-1] == pytest.approx(own.release, abs=1e-9)
        count = len(orbit.phases) - 1
        assert count > 8
        first = np.array(exact[: count - 1]) - 2 * np.pi
        assert orbit.phases[: count - 1] == pytest.approx(first, abs=1e-9)
        assert 0 < rest - 2 * np.pi - orbit.phases[count - 1] < 1e-3
        at = np.linspace(own.release + 0.01, exact[0] - 0.01, 50)
        y = own.flight(own.release, 0.0, at)[0]
        assert orbit["y"](at - 2 * np.pi * (at > 2 * np.pi)) == pytest.approx(y, abs=1e-9)
        assert np.abs(point.multipliers).max() < 1e-12
        assert point.stable


def test_error_of_what_is_left_out() -> None:
    """Assert that the error of an orbit is what its last impact leaves out, to 1 %.

    The root mean square of the speeds of the bounces that follow, straight lines, over peak to peak.
    """
    for point in branch()[::3]:
        own, count = judge(point.parameter), len(point.orbit.phases) - 1
        exact, _ = own.impacts()
        left = bounces(own, exact)[count - 1 : -1]
        square = float(np.sum(left**2 * np.diff(exact)[count - 1 :])) / (3 * 2 * np.pi)
        assert point.error.orbit == pytest.approx(np.sqrt(square) / point.orbit.span(), rel=0.01)


def bounces(own: Chatter, exact: list[float]) -> np.ndarray:
    """The speeds with which the mass leaves its impacts."""
    found, at, speed = list[float](), own.release, 0.0
    for _ in exact:
        at, arriving = own.landing(at, speed)
        speed = own.e * arriving
        found.append(speed)
    return np.array(found)


def judge(force: float) -> Chatter:
    """The closed form."""
    return Chatter(STIFFNESS, LOAD, force, RESTITUTION)


def test_pressed_oscillator() -> None:
    """Assert that a branch from rest finds orbits that chatter and rest on a stop, and where these leave it.

    x'' + .1 x' + x = cos(w t), x <= .3: it leaves where cos(w t) falls to .3, to 1e-9.
    """
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.1) + sym.RigidStop(x, 0.3, 0.5)
    pressed = sym.compile(model + sym.HarmonicForce(x, 1.0))
    found = per.trace(pressed, "Omega", (0.3, 0.4))
    assert found.stop.reason is per.Reason.BOUND
    for point in found:
        leaves = next(i for i, event in enumerate(point.orbit.mesh.events) if event.switch == 1)
        assert np.mod(point.orbit.phases[leaves], 2 * np.pi) == pytest.approx(np.arccos(0.3), abs=1e-9)
        assert np.abs(point.multipliers).max() < 1e-12
