"""Laws of the steady film thickness, and the film that cavitates."""

from __future__ import annotations

import math
from functools import partial

import casadi as ca
import numpy as np
import pytest
from reference.integration import path
from support.traces import FINE, RPM

import periodic as per
import symbolic as sym
from symbolic.scenes.building import build, disc_model
from symbolic.scenes.errors import InputError
from symbolic.scenes.reading import load
from symbolic.scenes.schema import DiscScene

SPEED, RADIUS, CROWN, VISCOSITY, PIEZO = 360 * RPM, 0.051, 0.102, 0.890, 25.9e-9
PRELOAD, HERTZ, MASS, AMPLITUDE, BETA, SQUEEZE = 810.0, 28e9, 20.4, 1.27e-6, 22.23, 2734.3
DELTA0 = (PRELOAD / HERTZ) ** (2 / 3)
MODULUS, POISSON = 207e9, 0.3
LAWS = ("calibrated", "equation-5", "constant-one-body", "constant-two-body", "hamrock-dowson")


def film_at_rest(law: str, *changes: tuple[str, str]) -> float:
    """h0 in um at the paper's point, with some keys of the scene changed."""
    system = build(load("vitrea79-810N", [("film.thickness", law), ("from_rpm", "360"), *changes]))
    return float(system.rest(system.nominal)[0][2] * system.states[2].scale) * 1e6


def groups(compliance: float) -> tuple[float, float, float, float]:
    """U*, G*, W* of eq. (6) and e_p* of eq. (2)."""
    r_x, u = RADIUS / 2, SPEED * RADIUS
    ratio = 1.03 * (CROWN / r_x) ** 0.64
    return VISCOSITY * u * compliance / r_x, PIEZO / compliance, PRELOAD * compliance / r_x**2, ratio


def test_equation_5() -> None:
    """Assert that eq. (5) is 0.112 U^0.625 G^0.46 W^-0.045 exp(0.076 e) with the one-body modulus."""
    U, G, W, e = groups((1 - POISSON**2) / (math.pi * MODULUS))
    h = RADIUS / 2 * 0.112 * U**0.625 * G**0.46 * W**-0.045 * math.exp(0.076 * e)
    assert film_at_rest("equation-5") == pytest.approx(h * 1e6, rel=1e-11)
    assert film_at_rest("equation-5") == pytest.approx(0.31, abs=0.005)


@pytest.mark.parametrize(("law", "bodies"), [("constant-one-body", 1), ("constant-two-body", 2)])
def test_printed_constant(law: str, bodies: int) -> None:
    """Assert that h0 solves Q = K h^-beta with K as printed; powers in longdouble, K being 1e-109."""
    compliance = bodies * (1 - POISSON**2) / (math.pi * MODULUS)
    U, G, _, e = groups(compliance)
    one = np.longdouble(1)
    K = (0.112 * one) ** BETA * (U * one) ** 13.9 * (G * one) ** 10.2 * (RADIUS / 2 * one) ** (BETA + 2)
    K *= np.exp(54.85 + 1.6 * e * one) / compliance
    assert film_at_rest(law) == pytest.approx(float((K / PRELOAD) ** (one / BETA)) * 1e6, rel=1e-11)


def test_printed_constant_in_numbers() -> None:
    """Assert that K gives 3.57 um with one body's modulus and 3.88 um with two."""
    assert film_at_rest("constant-one-body") == pytest.approx(3.57, abs=0.005)
    assert film_at_rest("constant-two-body") == pytest.approx(3.88, abs=0.005)


def test_hamrock_dowson() -> None:
    """Assert that the minimum film is 3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k)), about 4.26 um."""
    U, G, W, k = groups((1 - POISSON**2) / MODULUS)
    h = RADIUS / 2 * 3.63 * U**0.68 * G**0.49 * W**-0.073 * (1 - math.exp(-0.68 * k))
    assert film_at_rest("hamrock-dowson") == pytest.approx(h * 1e6, rel=1e-11)
    assert film_at_rest("hamrock-dowson") == pytest.approx(4.26, abs=0.01)


@pytest.mark.parametrize("law", LAWS[1:])
def test_steel_and_crown_are_parameters(law: str) -> None:
    """Assert that steel and crown change the printed laws, and that the calibrated one refuses them."""
    for change in (("modulus", "250e9"), ("poisson", "0.25"), ("crown", "0.2")):
        assert film_at_rest(law, change) != pytest.approx(film_at_rest(law), rel=1e-4)
        with pytest.raises(InputError, match=f"^discs.{change[0]} is .*; only a film whose thickness"):
            film_at_rest("calibrated", change)


def disc(law: sym.films.ThicknessLaw, speed: sym.Parameter) -> sym.CompiledSystem:
    """The squeeze-film scene with a law."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    parts = [sym.ReducedMass(x, MASS, MASS), sym.Preload(pair, PRELOAD), sym.Hertz(pair, HERTZ)]
    parts.append(sym.Waviness(pair, AMPLITUDE, 120, speed))
    return sym.compile(sym.combine([*parts, sym.SqueezeFilm(pair, law, speed, RADIUS)]))


def test_equations_with_a_law_are_those_with_its_thickness_put_in() -> None:
    """Assert that the residual with any law is that with h0 for a parameter, the formula in its place."""
    speed = sym.parameter("speed", SPEED, "rad/s")
    given = disc(sym.films.GivenThickness(1e-6), speed)
    rolling = sym.films.Rolling(speed, RADIUS, VISCOSITY, PIEZO)
    laws: list[sym.films.ThicknessLaw] = [
        sym.films.CalibratedThickness(speed, RADIUS, VISCOSITY, PIEZO),
        sym.films.RegressionThickness(rolling),
        sym.films.ConstantThickness(rolling, sym.films.Compliance.TWO_BODY),
        sym.films.HamrockDowsonThickness(rolling),
    ]
    g = given.expressions
    for law in laws:
        system = disc(law, speed)
        e, names = system.expressions, [p.name for p in system.parameters]
        h0 = e.rest_state[2] * system.states[2].scale
        shared = [h0 if p.name == "h0" else e.parameter[names.index(p.name)] for p in given.parameters]
        old = ca.vertcat(g.rate, g.state, g.algebraic, g.phase, g.parameter)
        new = ca.vertcat(e.rate, e.state, e.algebraic, e.phase, *shared)
        put_in = ca.substitute(g.residual, old, new)
        arguments = [e.rate, e.state, e.algebraic, e.phase, e.parameter]
        function = ca.Function("difference", arguments, [put_in, e.residual])
        rng, rest = np.random.default_rng(3), system.rest(system.nominal)
        for _ in range(20):
            point = rest[0] + 0.1 * rng.standard_normal(3), rest[1] + rng.standard_normal(1)
            values = function(rng.standard_normal(3), *point, rng.uniform(0, 6), system.nominal)
            np.testing.assert_allclose(values[0], values[1], rtol=1e-12, atol=1e-13)


def without_unknown(part: sym.Part) -> sym.Part:
    """The same part; a squeeze film with its rate in place of its equation."""
    if isinstance(part, sym.SqueezeFilm):
        return sym.films.ExplicitSqueezeFilm(
            part.pair, part.law, part.speed, part.radius, part.beta, part.squeeze
        )
    return part


def test_film_without_unknown() -> None:
    """Assert that the orbit at 360 rev/min is that of the film whose load is an unknown, to 1e-8."""
    scene = load("vitrea79-810N")
    assert isinstance(scene, DiscScene)
    explicit = sym.compile(sym.combine(without_unknown(part) for part in disc_model(scene).parts))
    assert not explicit.algebraics
    points = [
        per.trace(system, "speed", (0.9999 * SPEED, SPEED), start=SPEED, tol=FINE)[0]
        for system in (explicit, build(scene))
    ]
    for output in ("x", "film", "deflection", "load"):
        assert points[0].peak_to_peak(output) == pytest.approx(points[1].peak_to_peak(output), rel=1e-8)


def cavitating(*changes: tuple[str, str]) -> sym.CompiledSystem:
    """The scene with a floor."""
    return build(load("cavitating-film-810N", list(changes)))


def test_floor_does_not_matter_in_contact() -> None:
    """Assert that the orbit at 360 rev/min, where the load stays above the floor, is the squeeze film's."""
    points = [
        per.trace(system, "speed", (0.9999 * SPEED, SPEED), start=SPEED, tol=FINE)[0]
        for system in (cavitating(), build(load("vitrea79-810N")))
    ]
    assert points[1].minimum["load"] > 1e-4 * PRELOAD
    for output in ("x", "film", "deflection", "load"):
        assert points[0].peak_to_peak(output) == pytest.approx(points[1].peak_to_peak(output), rel=1e-8)


def rates(tau: float, s: np.ndarray, omega: float, floor: float) -> list[float]:
    """The scene with a floor in SI units: s = (x, dx/dt, h), written without the package."""
    x, v, h = s
    u = omega / 120 * RADIUS
    h0 = 3.85e-6 * (u / 1.92265) ** 0.625
    ratio = (DELTA0 + h - h0 + AMPLITUDE * np.sin(tau) - x) / DELTA0
    carried = max(ratio, 0.0) ** 1.5
    film = -(math.log(max(carried, floor)) + BETA * math.log(h / h0)) * u / SQUEEZE
    return [v / omega, 2 * PRELOAD * (carried - 1) / MASS / omega, film / omega]


@pytest.mark.parametrize("floor", [1e-2, 1e-4])
def test_leaping_orbit_by_integration(floor: float) -> None:
    """Assert that SciPy's DOP853 comes back to the orbit at 200 rev/min, where a cavity opens."""
    speed = 200 * RPM
    system = cavitating(("floor", repr(floor)))
    point = per.trace(system, "speed", (speed, 400 * RPM), start=400 * RPM)[-1]
    assert point.parameter == pytest.approx(speed) and point.stable
    assert point.minimum["load"] == 0 and point.maximum["cavity"] > 10e-6
    start = point.orbit.state(np.zeros(1))[0] * DELTA0
    start[1] *= 120 * speed
    field = partial(rates, omega=120 * speed, floor=floor)
    states = path(field, start, rtol=1e-10, atol=1e-16, max_step=0.005)
    scale = np.ptp(states, axis=1)
    assert (np.abs(states[:, -1] - start) / scale).max() < 1e-6


@pytest.mark.parametrize("floor", [0.0, 1.0, -1e-4])
def test_floor_out_of_range(floor: float) -> None:
    """Assert that a floor that is not between 0 and 1 is refused."""
    x, speed = sym.coordinate("x"), sym.parameter("speed", SPEED, "rad/s")
    pair = sym.ContactPair(x)
    film = sym.films.CavitatingFilm(pair, sym.films.GivenThickness(3.85e-6), speed, RADIUS, floor=floor)
    parts = [sym.ReducedMass(x, MASS, MASS), sym.Preload(pair, PRELOAD), sym.Hertz(pair, HERTZ), film]
    with pytest.raises(ValueError, match="it must lie between 0 and 1"):
        sym.compile(sym.combine(parts))
