"""Equations that jump: dry friction by `sign`, a square wave, a force that sets in at once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from reference.hybrid import Hybrid, Signs, Surface, periodic_orbit
from reference.shooting import in_order
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym

F = sym.functions
C, MU = 0.1, 0.1
VALUES = {"F": 0.5, "w": 1.0, "mu": MU}


def friction(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """x'' + c x' + x + mu sign(x') = F cos w t."""
    return {"x": x.v, "v": p.F * wave.cos - C * x.v - x.x - p.mu * F.sign(x.v)}


def latch(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """A force 2 mu that sets in where x passes 0.2: a condition, nested in a product."""
    return {"x": x.v, "v": p.F * wave.cos - C * x.v - x.x - 2 * p.mu * F.if_else(x.x > 0.2, 1 + x.v, 0)}


def square(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """A square wave as the force."""
    return {"x": x.v, "v": p.F * F.sign(wave.cos) - C * x.v - x.x}


def compiled(function: Any) -> sym.CompiledSystem:
    """The equations of an oscillator."""
    return sym.compile(sym.Equations(function, {"x": 0.0, "v": 0.0}, VALUES, frequency="w"))


def exact(name: str, force: float, w: float) -> Hybrid:
    """The same in tau, y = (x, v), mode by mode."""

    def rates(t: float, y: Any, signs: Signs) -> list[float]:
        (s,), passive = signs, -C * y[1] - y[0]
        jumping = {
            "friction": force * np.cos(t) - MU * s,
            "latch": force * np.cos(t) - 2 * MU * (1 + y[1]) * (s > 0),
            "square": force * s,
        }[name]
        return [y[1] / w, (passive + jumping) / w]

    def jacobian(t: float, y: Any, signs: Signs) -> list[list[float]]:
        return [[0, 1 / w], [-1 / w, (-C - 2 * MU * (name == "latch" and signs[0] > 0)) / w]]

    surface = {
        "friction": Surface(lambda t, y: y[1], lambda t, y: (0.0, np.array([0.0, 1.0]))),
        "latch": Surface(lambda t, y: y[0] - 0.2, lambda t, y: (0.0, np.array([1.0, 0.0]))),
        "square": Surface(lambda t, y: np.cos(t), lambda t, y: (-np.sin(t), np.zeros(2))),
    }[name]
    return Hybrid(rates, jacobian, [surface])


@pytest.mark.parametrize("function", [friction, latch, square], ids=lambda f: f.__name__)
def test_orbits_and_multipliers_of_equations_that_jump(function: Any) -> None:
    """Assert orbits and multipliers to 1e-9 against event-exact shooting with saltation, over frequencies."""
    system = compiled(function)
    assert system.jumps == (0,)
    branch = per.trace(system, "w", (1.2, 1.3), tol=1e-9, at=1.25)
    for point in branch.special_points:
        found = periodic_orbit(
            exact(function.__name__, 0.5, point.parameter), point.orbit.state(np.zeros(1))[0]
        )
        phase = np.linspace(0.05, 6.2, 30)
        np.testing.assert_allclose(point.orbit.state(phase), found.state(phase), atol=1e-9)
        np.testing.assert_allclose(in_order(point.multipliers), found.multipliers, atol=1e-9)
    assert len(branch.special_points) == 3


def test_what_is_continuous_does_not_jump() -> None:
    """Assert that a sign or condition between branches that meet is a kink and no jump."""
    for kinked in (lambda x: F.sign(x.v) * x.v, lambda x: F.if_else(x.x > 0.3, x.x - 0.3, 0)):
        system = compiled(lambda x, p, w, kinked=kinked: {"x": x.v, "v": w.cos - x.x - kinked(x)})
        assert len(system.switches) == 1
        assert system.jumps == ()


def test_sides_of_a_jump() -> None:
    """Assert the equations beyond the zero of their switch on a given side, and the state's own with 0."""
    system = compiled(friction)
    state, side = np.array([[0.0, 0.7], [0.0, 0.7], [0.0, 0.7]]), np.array([[1.0], [0.0], [-1.0]])
    zero = np.zeros((3, 2))
    line = system.linearise_beside(zero, state, np.zeros((3, 0)), np.zeros(3), system.nominal, side)
    np.testing.assert_allclose(line.residual[:, 1], -0.5 + 0.07 + MU * np.array([1.0, 1.0, -1.0]))


class Stuck:
    """Den Hartog's oscillator with stops, event by event: the map of the place x where it sticks.

    It leaves where |F cos w t - x| reaches mu, slips until its speed vanishes, and sticks again.
    """

    def __init__(self, force: float, w: float) -> None:
        self.force, self.w = force, w

    def half(self, x: float, way: float, after: float) -> tuple[float, float, float]:
        """Release after a phase, and next stop: phases of both, and the place of the stop."""
        place = (x + way * MU) / self.force
        release = np.arccos(place) if way < 0 else -np.arccos(place)
        release += 2 * np.pi * np.ceil((after - release) / (2 * np.pi))

        def rates(t: float, y: Any) -> list[float]:
            return [y[1] / self.w, (self.force * np.cos(t) - C * y[1] - y[0] - MU * way) / self.w]

        def stopped(t: float, y: Any) -> float:
            return y[1] if t > release + 0.1 else way

        stopped.terminal = True  # type: ignore[attr-defined]
        tight = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}
        found = solve_ivp(rates, (release, release + 7), [x, 0.0], events=stopped, **tight)
        end, place = float(found.t[-1]), float(found.y[0, -1])
        assert abs(self.force * np.cos(end) - place) < MU  # it sticks
        return release, end, place

    def period(self, x: float, after: float) -> float:
        """From the place of one stop, at its end on the side of positive x, to that a period later."""
        _, end, other = self.half(x, -1.0, after)
        return self.half(other, 1.0, end)[2]


def test_stick_and_slip() -> None:
    """Assert orbits that stop twice in a period, and their multipliers, to 1e-7, both ways through the onset.

    A stop leaves one multiplier 0; the other is the slope of the map of the place where it sticks.
    """
    system = compiled(friction)
    down = per.trace(system, "F", (0.2, 0.5), start=0.5, values={"w": 0.5}, at=0.3, tol=1e-8)
    assert "lower end" in str(down.stop)
    assert len(down[-1].orbit.mesh.events) == 4
    up = per.trace(system, "F", (0.2, 0.5), guess=down[-1].orbit, at=0.3, tol=1e-8)
    assert "upper end" in str(up.stop)
    for point in (*down.labelled(per.Label.USER), *up.labelled(per.Label.USER), down[-1]):
        force = point.parameter
        stuck = Stuck(force, 0.5)
        begin = float(point.orbit.phases[0])  # stops where x is largest
        place = float(point.orbit.state(np.array([begin]))[0, 0])
        np.testing.assert_allclose(stuck.period(place, begin), place, atol=1e-8)
        step = 1e-4
        slope = (stuck.period(place + step, begin) - stuck.period(place - step, begin)) / (2 * step)
        np.testing.assert_allclose(in_order(point.multipliers), [slope, 0.0], atol=1e-7)
    np.testing.assert_allclose(up[-1].multipliers, down[0].multipliers, atol=1e-7)


def test_coulomb_friction_is_the_sign_of_the_speed() -> None:
    """Assert that the part gives the orbit of the equations while it sticks and slips, and between bodies."""
    x, y = sym.coordinate("x", scale=0.5), sym.coordinate("y")
    one = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, C), sym.HarmonicForce(x, 0.5, 0.5)]
    alone = sym.compile(sym.combine([*one, sym.CoulombFriction(x, MU)]))
    assert [s.name for s in alone.switches] == [
        "dx/dt = 0",
        "dx/dt = 0: slips up",
        "dx/dt = 0: slips down",
    ]
    part = per.trace(alone, "F", (0.3, 0.5), start=0.5)[-1]
    plain = per.trace(compiled(friction), "F", (0.3, 0.5), start=0.5, values={"w": 0.5})[-1]
    np.testing.assert_allclose(part.peak_to_peak("x"), plain.peak_to_peak("x"), rtol=1e-6)
    np.testing.assert_allclose(part.multipliers, plain.multipliers, atol=1e-6)
    both = [*one, sym.Mass(y, 1.0), sym.Spring(y, 2.0), sym.CoulombFriction(x, MU, to=y)]
    assert sym.compile(sym.combine(both)).slides == {0: (1, 2)}


def test_friction_that_vanishes() -> None:
    """Assert that without a force there is no friction: the multipliers of a linear oscillator are left."""
    branch = per.trace(compiled(friction), "F", (0.4, 0.5), values={"mu": 0.0})
    assert "upper end" in str(branch.stop)
    np.testing.assert_allclose(np.prod(branch[-1].multipliers), np.exp(-2 * np.pi * C), rtol=1e-9)


def test_sliding_that_is_not_followed() -> None:
    """Assert that a branch ends before its orbits should slide where unknowns hide how."""
    hidden = sym.Equations(
        lambda x, p, w: friction(x, p, w) | {"z": x.z - x.x},
        {"x": 0.0, "v": 0.0},
        VALUES,
        frequency="w",
        unknowns={"z": 0.0},
    )
    system = sym.compile(hidden)
    assert system.jumps == (0,)
    assert system.slides == {}
    branch = per.trace(system, "F", (0.2, 0.5), start=0.5, values={"w": 0.5})
    assert 0.347 < branch[-1].parameter < 0.36  # the onset of stops
    assert "would slide" in str(branch.stop)


def test_curve_of_peaks() -> None:
    """Assert that along a curve of peaks over the force the amplitude does not change with the frequency."""
    system, aim = compiled(friction), per.PeakToPeak("x")
    branch = per.trace(system, "w", (0.7, 1.3))
    guess = max(branch, key=lambda point: point.peak_to_peak("x")).orbit
    curve = per.trace(system, "F", (0.4, 0.5), guess=guess, determined={"w": per.Peak(aim)}, tol=1e-8)
    assert {curve[0].parameter, curve[-1].parameter} == {0.4, 0.5}
    for point in (curve[0], curve[-1]):
        assert len(point.orbit.phases) > 1
        slopes = per.sensitivities(system, point.orbit, {"x": aim})["x"]
        assert abs(slopes["w"]) < 1e-6 * abs(slopes["F"])
