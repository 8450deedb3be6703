"""Rolling bearings: their period, waves on every surface, what is refused; the film in series."""

from __future__ import annotations

import math
from typing import Any

import casadi as ca
import numpy as np
import pytest
from scipy.optimize import brentq

import symbolic as sym

LAW = sym.HertzLaw(13.34e9)


def bearing(**given: Any) -> sym.CompiledSystem:
    """A shaft in a bearing whose balls pass 3.1 times a turn or nearly."""
    x, y = (sym.coordinate(name, scale=1e-6) for name in "xy")
    numbers = {"elements": 8, "law": LAW, "clearance": 6e-6, "speed": 1e3, "inner": 40.1e-3, "outer": 63.9e-3}
    parts = [sym.Mass(x, 20.0), sym.Mass(y, 20.0), sym.ConstantForce(x, 196.0)]
    return sym.compile(sym.combine([*parts, sym.RollingBearing(x, y, **{**numbers, **given})]))


WAVES = {
    "none": {},
    "outer": {"waves": (sym.RaceWave("outer", 9, 1e-6),)},
    "inner": {"waves": (sym.RaceWave("inner", 5, 1e-6, 0.3),), "passages": "31/10"},
    "ball": {"waves": (sym.RaceWave("ball", 4, 1e-6),), "passages": 3.1, "spin": "5/2"},
    "rollers": {"law": sym.HertzLaw(1e9, 10 / 9), "elements": 12, "clearance": -1e-6},
    "film": {"film": sym.films.SeriesFilm(sym.films.PowerFilm(0.3e-6, 100.0), contacts=2)},
}


@pytest.mark.parametrize("name", WAVES)
def test_period_is_two_pi(name: str) -> None:
    """Assert that equations and switches have the period of what is asked for, to rounding."""
    system = bearing(**WAVES[name])
    tau = np.linspace(0.1, 6.0, 7)
    state = np.tile([7.0, 0.0, 1.0, 0.0], (7, 1))
    none, p = np.zeros((7, 0)), system.nominal
    for f in (lambda t: system.residual(0 * state, state, none, t, p), lambda t: system.switch(state, t, p)):
        assert f(tau) == pytest.approx(f(tau + 2 * np.pi), rel=1e-9, abs=1e-9)


def test_passage_or_turn() -> None:
    """Assert the frequency of the phase: that of the passage, or of the common period with the shaft."""
    assert bearing().omega(bearing().nominal) == pytest.approx(8e3 * 40.1 / 104, rel=1e-14)
    turning = bearing(**WAVES["inner"])
    assert turning.omega(turning.nominal) == pytest.approx(1e3 / 10, rel=1e-14)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"elements": 0}, "elements is 0"),
        ({"outer": 30e-3}, "outer is 0.03"),
        ({"waves": 3}, "waves is 3; it must be a sequence of RaceWave"),
        ({"waves": ("inner",)}, "it must be a sequence of RaceWave"),
        ({"passages": 4}, "passages is 4; it must be about 3.08"),
        ({"passages": 3.0846153846}, "denominator"),
        ({"waves": WAVES["inner"]["waves"]}, "no common period"),
        ({"waves": WAVES["ball"]["waves"], "passages": 3.1}, "passages and spin"),
    ],
)
def test_refused(given: dict[str, Any], said: str) -> None:
    """Assert one sentence that names what is wrong."""
    with pytest.raises(ValueError, match=said):
        bearing(**given)


@pytest.mark.parametrize("approach", [-5e-5, -1e-6, -1e-9, 0.0, 1e-9, 1e-6, 4e-5])
def test_film_in_series(approach: float) -> None:
    """Assert the load of film and contact in series against a root finder, to 1e-11, and its slope."""
    assembly, d = sym.Assembly(), ca.SX.sym("d")
    load = sym.films.SeriesFilm(sym.films.PowerFilm(0.3e-6, 100.0, 13.7), contacts=2).load(assembly, LAW, d)
    numbers = [number.parameter for number in assembly.numbers.taken]
    arguments = [d, ca.vertcat(*[number.symbol for number in numbers])]
    function = ca.Function("load", arguments, [load, ca.jacobian(load, d)])
    found, slope = (float(v) for v in function(approach, [number.value for number in numbers]))

    def parts(y: float) -> tuple[float, float]:
        return np.exp((y - np.log(13.34e9)) / 1.5), 0.6e-6 * np.exp((np.log(100.0) - y) / 13.7)

    def excess(y: float) -> float:
        delta, film = parts(y)
        return float(np.log(delta + max(-approach, 0)) - np.log(film + max(approach, 0)))

    exact = brentq(excess, -200, 20, xtol=1e-14)
    delta, film = parts(exact)
    assert np.log(found) == pytest.approx(exact, abs=1e-11)
    assert slope * (delta / 1.5 + film / 13.7) == pytest.approx(found, rel=1e-10)


@pytest.mark.parametrize(
    ("surface", "spin", "order"), [("outer", None, "31/10"), ("inner", None, 5), ("ball", "5/2", 12.5)]
)
def test_order_of_waves(surface: Any, spin: Any, order: Any) -> None:
    """Assert the order of the shaft's angle in which the height that an element meets repeats."""
    assert sym.RaceWave(surface, 5, 1e-6).order("31/10", spin) == order


def test_rest_between_two_elements() -> None:
    """Assert the rest under a load midway between two elements, in a clearance that is wide.

    Each carries F = W/(2 cos(pi/8)) and is pressed by d = (F/K)^(2/3): the shaft is at (g + d)/cos(pi/8).
    """
    x, y = sym.coordinate("x", scale=1e-6), sym.coordinate("y", scale=1e-6)
    turn, load, stiffness, gap = math.pi / 8, 100.0, 1e10, 3e-5
    speed = sym.parameter("speed", 300.0, "rad/s")
    races = {"clearance": gap, "speed": speed, "inner": 0.03, "outer": 0.05}
    parts = [part for q in (x, y) for part in (sym.Mass(q, 5.0), sym.Damper(q, 100.0))]
    parts += [sym.ConstantForce(x, load * math.cos(turn)), sym.ConstantForce(y, load * math.sin(turn))]
    bearing = sym.RollingBearing(x, y, 8, sym.HertzLaw(stiffness), **races)  # type: ignore[arg-type]
    found = sym.modes(sym.compile(sym.combine([*parts, bearing])), {"speed": 300.0}).state
    at = (gap + (load / (2 * math.cos(turn) * stiffness)) ** (2 / 3)) / math.cos(turn)
    assert 1e-6 * found[::2] == pytest.approx([at * math.cos(turn), at * math.sin(turn)], rel=1e-9)


@pytest.mark.parametrize("phase", [0.0, math.pi])
def test_rest_on_a_wave(phase: float) -> None:
    """Assert the rest on a crest and in a trough of the outer race, both deeper than what is pressed."""
    x, y = sym.coordinate("x", scale=1e-6), sym.coordinate("y", scale=1e-6)
    load, stiffness, gap, height = 2.0, 1e10, 1e-6, 2e-6
    speed = sym.parameter("speed", 300.0, "rad/s")
    waves = [sym.RaceWave("outer", 8, height, phase)]
    races = {"clearance": gap, "speed": speed, "inner": 0.03, "outer": 0.05, "waves": waves, "passages": 3}
    parts = [part for q in (x, y) for part in (sym.Mass(q, 5.0), sym.Damper(q, 100.0), sym.Spring(q, 1.0))]
    bearing = sym.RollingBearing(x, y, 8, sym.HertzLaw(stiffness), **races)  # type: ignore[arg-type]
    system = sym.compile(sym.combine([*parts, sym.ConstantForce(x, load), bearing]))
    at, _, across, _ = 1e-6 * sym.modes(system, {"speed": 300.0}).state
    turn = 2 * math.pi * np.arange(8) / 8
    depth = at * np.cos(turn) + across * np.sin(turn) - gap + height * math.cos(phase)
    forces = stiffness * np.maximum(depth, 0.0) ** 1.5
    assert (forces > 0).sum() == (8 if phase == 0 else 1)
    assert forces @ np.cos(turn) + at == pytest.approx(load, rel=1e-6)  # beside the spring of 1 N/m
    assert forces @ np.sin(turn) + across == pytest.approx(0.0, abs=1e-6)


def test_an_element_that_is_just_touched_is_not_stiff() -> None:
    """Assert that rounding of a contact's depth makes no force, and so no stiffness, of rollers."""
    x, y = sym.coordinate("x", scale=1e-6), sym.coordinate("y", scale=1e-6)
    speed = sym.parameter("speed", 300.0, "rad/s")
    races = {"clearance": 1e-6, "speed": speed, "inner": 0.03, "outer": 0.05}
    law = sym.HertzLaw(5e8, 10 / 9)
    parts = [part for q in (x, y) for part in (sym.Mass(q, 5.0), sym.ConstantForce(q, 1.0))]
    system = sym.compile(sym.combine([*parts, sym.RollingBearing(x, y, 8, law, **races)]))  # type: ignore[arg-type]
    forces = []
    for depth in (0.0, 1e-13, 1e-9):  # in um
        state = np.array([[1.0 + depth, 0.0, 0.0, 0.0]])
        row = system.residual(0 * state, state, np.zeros((1, 0)), np.zeros(1), system.nominal)
        forces.append(row[0])
    assert (forces[0] == forces[1]).all()
    assert not (forces[0] == forces[2]).all()
