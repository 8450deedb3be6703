"""Tori with contact: a rotor that rubs now and then, known in rotating coordinates as a cycle."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import scipy
from support.kept import kept
from support.oscillators import X

import periodic as per
import symbolic as sym
from periodic.phasespace.following.crowd import Crowd
from periodic.tori import settled, trace
from periodic.tori.grid import TURN, Grid

pytestmark = pytest.mark.usefixtures("users_kernels")

STIFF, GAP, FRICTION, DAMPING = 25.0, 1.05, 0.1, 0.1


def rotor() -> sym.CompiledSystem:
    """Jeffcott's rotor with an unbalance in a stiff ring with friction, without weight."""
    x, y, speed = sym.coordinate("x"), sym.coordinate("y"), sym.parameter("speed", 0.8)
    model: sym.Model | sym.Part = sym.Mass(x, 1.0) + sym.Mass(y, 1.0)
    for q in (x, y):
        model = model + sym.Damper(q, DAMPING) + sym.Spring(q, 1.0)
    return sym.compile(model + sym.Unbalance(x, y, 1.0, 1.0, speed) + sym.Rub(x, y, STIFF, GAP, FRICTION))


@kept
def rubbing() -> per.Torus:
    """The torus at a speed of 0.8."""
    return per.settled_torus(rotor(), start={"x": 0.5})


def cycle(speed: float) -> tuple[float, float]:
    """Rotation number and mean r^2 of the rub, integrated by SciPy in coordinates that turn with the shaft.

    There the rotor is not excited, and the rub is a cycle between contacts: its period over the shaft's.
    """

    def rate(t: float, z: np.ndarray) -> list[float]:
        x, y, u, v, _ = z
        r = math.hypot(x, y)
        push = STIFF * max(r - GAP, 0.0) / r
        ax = -DAMPING * (u - speed * y) - x - push * (x - FRICTION * y) + speed**2
        ay = -DAMPING * (v + speed * x) - y - push * (y + FRICTION * x)
        return [u, v, ax + 2 * speed * v + speed**2 * x, ay - 2 * speed * u + speed**2 * y, r * r]

    def contact(t: float, z: np.ndarray) -> float:
        return math.hypot(z[0], z[1]) - GAP

    contact.direction = 1.0  # type: ignore[attr-defined]
    given = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.05}
    begin = scipy.integrate.solve_ivp(rate, (0, 2000), [0.5, 0.0, 0.0, 0.0, 0.0], **given).y[:, -1]
    found = scipy.integrate.solve_ivp(rate, (0, 400), begin, events=contact, **given)
    times, states = found.t_events[0], found.y_events[0]
    period = (times[-1] - times[0]) / (len(times) - 1)
    mean = (states[-1, 4] - states[0, 4]) / (times[-1] - times[0])
    return TURN / speed / period, float(mean)


def test_rub_is_a_cycle_in_rotating_coordinates() -> None:
    """Assert rotation number to 1e-8 and mean square to 1e-6 against another integrator."""
    torus = rubbing()
    turns, mean = cycle(0.8)
    assert len(torus.breaks) == 2 and torus.tail < 1e-8
    own = torus.rotation_number
    whole = [(own * side - turns * times) % 1.0 for side in (1, -1) for times in (1, -1)]
    assert min(min(each, 1 - each) for each in whole) < 1e-8
    found = per.tori.average(rotor(), torus, lambda s: s["x"] ** 2 + s["y"] ** 2, samples=512)
    assert found == pytest.approx(mean, rel=1e-6)


def test_lines_of_a_rub() -> None:
    """Assert Parseval's sum over all lines, and the strongest against a long motion's Fourier sum."""
    system, torus = rotor(), rubbing()
    lines = per.tori.combinations(system, torus, "x", lines=4000)
    mean = lines.amplitudes[(lines.orders == 0).all(axis=1)]
    power = (lines.amplitudes**2).sum() / 2 + (mean**2).sum() / 2
    square = per.tori.average(system, torus, lambda s: s["x"] ** 2, samples=512)
    assert power == pytest.approx(square, rel=1e-8)
    time, states = per.tori.in_time(system, torus, periods=1000, samples=32)
    window = np.exp(-1 / np.maximum(1 - np.linspace(-1, 1, len(time)) ** 2, 1e-12))
    for at, size in zip(lines.frequencies[:4], lines.amplitudes[:4], strict=True):
        one = 2 * abs(window @ (states["x"] * np.exp(-1j * at * time))) / window.sum()
        assert one == pytest.approx(size, rel=1e-7)


def test_multiplier_along_the_torus() -> None:
    """Assert that the multiplier along the section is 1, and others the exponents of a long motion."""
    sizes = np.abs(per.tori.torus_multipliers(rotor(), rubbing()))
    assert sizes[0] == pytest.approx(1.0, abs=1e-6)
    exponents = per.lyapunov(rotor(), start={"x": 0.5}, periods=2000)
    assert np.sort(sizes[1:])[::-1] == pytest.approx(np.exp(exponents.values[1:] * TURN / 0.8), abs=5e-3)


def test_family_over_speed() -> None:
    """Assert the branch of the rub over the speed: stable, smooth in pieces, as another integrator has it."""
    system = rotor()
    family = per.trace(system, "speed", (0.78, 0.86), guess=rubbing(), at=[0.85])
    assert family.stops == ("end of the range at 0.78", "end of the range at 0.86")
    assert all(point.stable and point.torus.tail < 1e-5 for point in family)
    assert {point.label for point in family} == {"", "EP", "UZ"}
    (asked,) = family.labelled("UZ")
    turns, _ = cycle(0.85)
    own = asked.torus.rotation_number
    whole = [(own * side - turns * times) % 1.0 for side in (1, -1) for times in (1, -1)]
    assert min(min(each, 1 - each) for each in whole) < 1e-7


def test_values_that_are_not_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert a refusal of a range, and the end of a curve whose released parameter may not go on."""
    system, torus = rotor(), rubbing()
    with pytest.raises(ValueError, match="parameter 'mu' is -1.0; it must be a number of at least 0"):
        per.trace(system, "mu", (-1.0, 0.2), guess=torus)
    kept = torus.traced(system, "speed", (0.79, 0.82), released="mu")
    assert kept.stops == ("end of the range at 0.79", "end of the range at 0.82")
    assert kept.rotation_numbers == pytest.approx(torus.rotation_number, rel=1e-14)
    assert kept[-1].torus.parameters["mu"] < 0.097

    def check(parameter: Any, value: float) -> None:
        if parameter.name == "mu" and value < 0.097:
            raise ValueError("mu is too small")

    monkeypatch.setattr(trace, "check_value", check)
    less = torus.traced(system, "speed", (0.79, 0.82), released="mu")
    assert less.stops[1] == "the rotation number would ask for what is not allowed: mu is too small"
    assert 0.097 <= less[-1].torus.parameters["mu"] < 0.1


@pytest.mark.parametrize("tolerance", [1e-9, 1e-11])
def test_tangents_through_contacts_are_exact(tolerance: float) -> None:
    """Assert tangents over contacts against differences of motions, far nearer than a wrong side would be."""
    system = rotor()
    begin = np.array([[0.5, 0.2, 0.1, 0.9]])
    fine = Crowd(system, system.nominal, 1e-12)
    crowd = Crowd(system, system.nominal, tolerance)
    y = crowd.begin(begin)
    found = crowd.run(y, 1, TURN, tangents=crowd.tangents(y), raw=True)
    assert found.changes.sum() >= 4
    beside = [
        (fine.run(fine.begin(begin + step), 1, TURN).ends - fine.run(fine.begin(begin - step), 1, TURN).ends)[
            0
        ]
        / 2e-5
        for step in 1e-5 * np.eye(4)
    ]
    assert np.abs(found.tangents[0] - np.array(beside)).max() < 1e-6


def test_grids() -> None:
    """Assert values, slopes and averages of a smooth curve in pieces, and of one with a kink at a break."""
    grid = Grid(48, np.array([0.4, 2.1, 5.0]))
    at = np.linspace(-1.0, 8.0, 60)
    value, slope = grid.interpolation(at)
    curve = np.exp(np.sin(grid.angles))
    assert value @ curve == pytest.approx(np.exp(np.sin(at)), abs=1e-8)
    assert slope @ curve == pytest.approx(np.cos(at) * np.exp(np.sin(at)), abs=1e-6)
    assert grid.weights @ curve == pytest.approx(scipy.special.iv(0, 1), rel=1e-12)
    assert grid.weights.sum() == pytest.approx(1.0)
    kinked = np.abs(np.mod(grid.angles - 2.1, TURN) - (5.0 - 2.1))
    assert value @ kinked == pytest.approx(np.abs(np.mod(at - 2.1, TURN) - (5.0 - 2.1)), abs=1e-10)
    assert grid.tail(kinked[:, None]) < 1e-12


def with_two_forces(part: sym.Part) -> sym.CompiledSystem:
    """A mass with forces of frequencies 1 to sqrt(2), and more: the second turns as two states."""

    def turning(s: Any, p: Any, wave: Any) -> dict[str, Any]:
        left, turns = 1 - s.p**2 - s.q**2, math.sqrt(2) * p.Omega
        return {"p": left * s.p - turns * s.q, "q": left * s.q + turns * s.p, "x": 0.6 * s.p}

    second = sym.Equations(
        turning, states={"p": 1.0, "q": 0.0}, coordinates=[X], parameters={"Omega": 0.7}, frequency="Omega"
    )
    model = sym.Mass(X, 1.0) + sym.Damper(X, 0.1) + sym.Spring(X, 1.0)
    return sym.compile(model + sym.HarmonicForce(X, 1.0, sym.parameter("Omega", 0.7)) + part + second)


def test_friction_beside_two_forces() -> None:
    """Assert thirty periods on a torus with friction against a motion that was integrated event by event."""
    system = with_two_forces(sym.CoulombFriction(X, 0.2))
    torus = per.settled_torus(system, settle=2000)
    assert len(torus.breaks) == 6 and torus.tail < 1e-7
    assert torus.rotation_number == pytest.approx(math.sqrt(2) - 1, rel=1e-7)
    _, states = per.tori.in_time(system, torus, periods=30, samples=8)
    begin, phase = torus.states_at(np.zeros(1))[0], TURN / 8 * np.arange(240)
    path = system.motion(begin, np.zeros(0), torus.parameter, phase, 1e-11)
    assert states["x"] == pytest.approx(torus.units["x"] * path.state[:, 0], abs=3e-7)


def test_what_just_touches_now_and_then_is_rough(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the tail is the error where not all beats reach a stop; rougher ones are refused."""
    system = with_two_forces(sym.OneSidedSpring(X, 5.0, 0.8))
    torus = per.settled_torus(system, settle=2000)
    assert len(torus.states) == 641 and 1e-5 < torus.tail < 1e-3
    _, states = per.tori.in_time(system, torus, periods=30, samples=8)
    begin, phase = torus.states_at(np.zeros(1))[0], TURN / 8 * np.arange(240)
    path = system.motion(begin, np.zeros(0), torus.parameter, phase, 1e-11)
    off = np.abs(states["x"] - torus.units["x"] * path.state[:, 0]).max() / np.abs(path.state[:, 0]).max()
    assert 1e-6 < off < 5 * torus.tail
    monkeypatch.setattr(settled, "ROUGHEST", 1e-5)
    with pytest.raises(per.TorusError, match=r"loses its smoothness.*motions that just touch something"):
        per.settled_torus(system, settle=2000)
