"""Compiled scenes against the equations of the paper, written out by hand, and linearised at rest."""

import math

import numpy as np
import pytest
from support.models import RADIUS, REGIMES, RPM, Array, Disc, Points, draw, scene

import symbolic as sym


def values(system: sym.CompiledSystem, points: Points) -> dict[str, float]:
    """Parameters by name, with what follows from them."""
    p = dict(zip([v.name for v in system.parameters], points.parameter, strict=True))
    p["omega"] = p["waves"] * p["speed"]
    p["delta0"] = (p["preload"] / p["stiffness"]) ** (1 / p["exponent"])
    p["mu"] = p["m1"] * p["m2"] / (p["m1"] + p["m2"])
    if "beta" in p:
        u = p["radius"] * p["speed"]
        p["h0"] = 3.85e-6 * (u / 1.92265 * p["viscosity"] / 0.890) ** 0.625
        p["h0"] *= (p["piezoviscosity"] / 25.9e-9) ** 0.46 * (p["preload"] / 810) ** (-1 / p["beta"])
    if "squeeze" in p:
        p["gamma"] = p["squeeze"] / u
    return p


def in_si(system: sym.CompiledSystem, points: Points) -> tuple[dict[str, Array], dict[str, Array]]:
    """States and their tau-derivatives in SI units, by name."""
    pairs = list(enumerate(system.states))
    states = {v.name: v.scale * points.state[:, i] for i, v in pairs}
    return states, {v.name: v.scale * points.rate[:, i] for i, v in pairs}


def outputs(system: sym.CompiledSystem, points: Points) -> dict[str, Array]:
    """Outputs by name."""
    table = system.output(*points.arguments)
    return {v.name: table[:, i] for i, v in enumerate(system.outputs)}


def assert_row(row: Array, expected: Array) -> None:
    """Compare a row with an equation of arbitrary scale: one factor must fit all points."""
    factor = row @ expected / (expected @ expected)
    assert factor != 0
    np.testing.assert_allclose(row, factor * expected, rtol=1e-9, atol=1e-9 * np.abs(row).max())


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("name", ["dry", "quasistatic", "squeeze"])
def test_disc_moves_under_its_load(name: str, regime: str) -> None:
    """Assert that mu X'' = W - Q - 2 zeta omega0 mu X' (eqs. 11 and 12) with the load that is put out."""
    system = scene(name)
    points = draw(system, regime)
    p, (x, rate) = values(system, points), in_si(system, points)
    excess = outputs(system, points)["load"] - p["preload"]
    omega0 = math.sqrt(p["exponent"] * p["preload"] / p["delta0"] / p["mu"])
    damping = 2 * p.get("damping_ratio", 0) * omega0 * p["mu"] * p["omega"] * x["x'"]
    residual = system.residual(*points.arguments)
    assert_row(residual[:, 0], rate["x"] - x["x'"])
    assert_row(residual[:, 1], p["mu"] * p["omega"] ** 2 * rate["x'"] - excess + damping)


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("name", ["quasistatic", "squeeze"])
def test_load_is_hertz_load_of_the_deflection(name: str, regime: str) -> None:
    """Assert that W = K delta^n (eq. 1) between the outputs of a lubricated contact."""
    system = scene(name)
    points = draw(system, regime)
    p, out = values(system, points), outputs(system, points)
    np.testing.assert_allclose(out["load"], p["stiffness"] * out["deflection"] ** p["exponent"], rtol=1e-11)


@pytest.mark.parametrize("regime", REGIMES)
def test_dry_load_is_hertz_load_of_the_geometry(regime: str) -> None:
    """Assert that W = K max(delta0 + a sin tau - X, 0)^n without a film."""
    system = scene("dry")
    points = draw(system, regime)
    p, (x, _) = values(system, points), in_si(system, points)
    deflection = p["delta0"] + p["amplitude"] * np.sin(points.phase) - x["x"]
    expected = p["stiffness"] * np.maximum(deflection, 0) ** p["exponent"]
    np.testing.assert_allclose(outputs(system, points)["load"], expected, rtol=1e-11)


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("name", ["quasistatic", "squeeze"])
def test_geometry_is_shared_by_deflection_and_film(name: str, regime: str) -> None:
    """Assert that delta = delta0 + (h - h0) + a sin tau - X (eq. 2)."""
    system = scene(name)
    points = draw(system, regime)
    p, (x, _), out = values(system, points), in_si(system, points), outputs(system, points)
    geometry = p["delta0"] + out["film"] - p["h0"] + p["amplitude"] * np.sin(points.phase) - x["x"]
    assert_row(system.residual(*points.arguments)[:, 2], out["deflection"] - geometry)


@pytest.mark.parametrize("regime", REGIMES)
def test_film_follows_the_law_with_squeeze(regime: str) -> None:
    """Assert that ln(W/Q) = -beta ln(h/h0) - gamma dh/dt (eq. 3)."""
    system = scene("squeeze")
    points = draw(system, regime)
    p, (x, rate), out = values(system, points), in_si(system, points), outputs(system, points)
    squeeze = p["gamma"] * p["omega"] * rate["h"]
    law = np.log(out["load"] / p["preload"]) + p["beta"] * np.log(x["h"] / p["h0"]) + squeeze
    assert_row(system.residual(*points.arguments)[:, 3], law)


@pytest.mark.parametrize("regime", REGIMES)
def test_film_without_squeeze_follows_the_load(regime: str) -> None:
    """Assert that h = h0 (W/Q)^(-1/beta)."""
    system = scene("quasistatic")
    points = draw(system, regime)
    p, out = values(system, points), outputs(system, points)
    expected = p["h0"] * (out["load"] / p["preload"]) ** (-1 / p["beta"])
    np.testing.assert_allclose(out["film"], expected, rtol=1e-12)


def test_unequal_discs_share_the_load_of_their_summed_displacement() -> None:
    """Assert that each of two discs obeys m x'' = W - Q - (its support), W taken at x1 + x2."""
    system = scene("two discs, squeeze")
    points = draw(system)
    p, (x, rate), out = values(system, points), in_si(system, points), outputs(system, points)
    residual = system.residual(*points.arguments)
    for i, q in enumerate(("x1", "x2")):
        force = out["load"] - p["preload"] - p[f"k{i + 1}"] * x[q]
        assert_row(residual[:, 2 * i + 1], p[f"m{i + 1}"] * p["omega"] ** 2 * rate[f"{q}'"] - force)
    geometry = p["delta0"] + x["h"] - p["h0"] + p["amplitude"] * np.sin(points.phase) - x["x1"] - x["x2"]
    assert_row(residual[:, 4], out["deflection"] - geometry)


def test_duffing_oscillator_is_problem_a() -> None:
    """Assert that m x'' + c x' + k x + k3 x^3 = F cos tau."""
    system = scene("duffing")
    points = draw(system)
    p = dict(zip([v.name for v in system.parameters], points.parameter, strict=True))
    x, rate = in_si(system, points)
    omega, q, v = p["Omega"], x["x"], x["x'"]
    motion = p["m"] * omega**2 * rate["x'"] + p["c"] * omega * v + p["k"] * q + p["k3"] * q**3
    assert_row(system.residual(*points.arguments)[:, 1], motion - p["F"] * np.cos(points.phase))


def slowest_pair(system: sym.CompiledSystem, rpm: float) -> complex:
    """Eigenvalue (rad/s) of the motion about rest that oscillates."""
    parameter = system.nominal
    parameter[[v.name for v in system.parameters].index("speed")] = rpm * RPM
    state, xi = system.rest(parameter)
    lines = system.linearise(np.zeros((1, len(state))), state[None], xi[None], np.zeros(1), parameter)
    d_rate, d_state, d_xi = lines.d_rate[0], lines.d_state[0], lines.d_algebraic[0]
    n = len(state)
    by_state = -np.linalg.solve(d_xi[n:], d_state[n:])
    by_rate = -np.linalg.solve(d_xi[n:], d_rate[n:])
    flow = np.linalg.solve(d_rate[:n] + d_xi[:n] @ by_rate, -d_state[:n] - d_xi[:n] @ by_state)
    values = np.linalg.eigvals(flow)
    return complex(values[np.argmax(values.imag)]) * 120 * rpm * RPM


@pytest.mark.parametrize(
    ("rpm", "ratio", "resonance"), [(280, 0.005846, 281.19), (360, 0.006763, 280.71)], ids=["280", "360"]
)
def test_linear_damping_and_resonance_of_the_lubricated_disc(
    rpm: float, ratio: float, resonance: float
) -> None:
    """Assert that vitrea79-810N at rest has the damping ratio and the undamped resonance of the reference."""
    pair = slowest_pair(scene("squeeze"), rpm)
    assert -pair.real / abs(pair) == pytest.approx(ratio, abs=1e-6)
    assert abs(pair) / (120 * RPM) == pytest.approx(resonance, abs=6e-3)


def test_linear_damping_of_the_dry_disc_is_its_damping_ratio() -> None:
    """Assert that zeta is the damping ratio of the dry contact, at omega0 = sqrt(n Q / (delta0 mu))."""
    system = Disc(film=None, zeta=0.05).compile()
    parameter = system.nominal
    state = system.rest(parameter)[0]
    nothing = np.zeros((1, 0))
    lines = system.linearise(np.zeros((1, 2)), state[None], nothing, np.zeros(1), parameter)
    values = np.linalg.eigvals(np.linalg.solve(lines.d_rate[0], -lines.d_state[0])) * 120 * 360 * RPM
    delta0 = (810 / 28e9) ** (2 / 3)
    np.testing.assert_allclose(np.abs(values), math.sqrt(1.5 * 810 / delta0 / 10.2), rtol=1e-12)
    np.testing.assert_allclose(-values.real / np.abs(values), 0.05, rtol=1e-12)


def test_rest_is_at_rest() -> None:
    """Assert that every equation holds at the rest values, the waviness passing zero."""
    for name in ("dry", "quasistatic", "squeeze", "two discs, squeeze"):
        system = scene(name)
        state, xi = system.rest(system.nominal)
        residual = system.residual(
            np.zeros((1, len(state))), state[None], xi[None], np.zeros(1), system.nominal
        )
        np.testing.assert_allclose(residual, 0, atol=1e-13)


def test_static_deflection_at_810_newtons() -> None:
    """Assert that delta0 = (Q/K)^(2/3) is 9.4236 um, as the scale of x and as output at rest."""
    system = scene("squeeze")
    state, xi = system.rest(system.nominal)
    resting = Points(np.zeros((1, 3)), state[None], xi[None], np.zeros(1), system.nominal)
    assert system.states[0].scale == pytest.approx(9.4236e-6, abs=5e-11)
    assert outputs(system, resting)["deflection"][0] == pytest.approx(9.4236e-6, abs=5e-11)


@pytest.mark.parametrize("rpm", [100, 360, 500])
def test_squeeze_coefficient(rpm: float) -> None:
    """Assert that dh/dt enters the logarithm of the load with gamma = 2734.3/u, u = 0.102 pi N/60."""
    system = scene("squeeze")
    parameter = system.nominal
    parameter[[v.name for v in system.parameters].index("speed")] = rpm * RPM
    state, xi = system.rest(parameter)
    lines = system.linearise(np.zeros((1, 3)), state[None], xi[None], np.zeros(1), parameter)
    gamma = lines.d_rate[0, 3, 2] / (4 * math.pi * rpm * system.states[2].scale)
    assert gamma == pytest.approx(2734.3 / (0.102 * math.pi * rpm / 60), rel=1e-13)
    assert 2 * RADIUS == 0.102
