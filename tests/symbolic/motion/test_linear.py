"""The linear system about rest: Jacobian, eigenvalues, resonance and response against closed forms."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache

import casadi as ca
import numpy as np
import pytest
from support.models import AMPLITUDE, HERTZ, MASS, PRELOAD, RPM, Disc
from support.traces import disc_system, duffing_system

import periodic as per
import symbolic as sym
from symbolic.equations.assembly import Assembly
from symbolic.motion.frequencyresponse import peak, response
from symbolic.motion.linear import NoRestError, modes, resonance

DELTA0 = (PRELOAD / HERTZ) ** (2 / 3)
CONTACT = 1.5 * PRELOAD / DELTA0
"""Linear stiffness of the Hertz contact, N/m."""

BETA, SQUEEZE, RADIUS, WAVES = 22.23, 2734.3, 0.051, 120
OMEGA = 360 * RPM * WAVES
DAMPING = (0.1, 0.0, 0.5)
"""Damping, cubic stiffness and force of x'' + 0.1 x' + x = 0.5 cos(Omega t)."""


def squeeze_stiffness(value: complex, film: float = 3.85e-6, rpm: float = 360.0) -> complex:
    """Dynamic stiffness in N/m of contact and squeeze film in series, at d/dt = value (1/s)."""
    flexible = PRELOAD * (BETA / film + SQUEEZE / (math.pi * 0.102 * rpm / 60) * value)
    return 1 / (1 / CONTACT + 1 / flexible)


@cache
def film_at(rpm: float) -> float:
    """Steady film of `vitrea79-810N` in m."""
    return 3.85e-6 * (math.pi * 0.102 * rpm / 60 / 1.92265) ** 0.625


def test_oscillator() -> None:
    """Assert the Jacobian, eigenvalues, frequencies and damping of a linear oscillator."""
    found = modes(duffing_system(*DAMPING), {"Omega": 0.8})
    assert found.omega == 0.8
    np.testing.assert_allclose(found.jacobian, [[0, 0.8], [-1 / 0.8, -0.1]], rtol=1e-14, atol=1e-15)
    np.testing.assert_allclose(found.frequencies, [1.0], rtol=1e-14)
    np.testing.assert_allclose(found.damping_ratios, [0.05], rtol=1e-13)
    np.testing.assert_allclose(found.damped_frequencies, [math.sqrt(1 - 0.05**2)], rtol=1e-14)


def test_squeeze_film_eigenvalues() -> None:
    """Assert that every eigenvalue solves m lambda^2 + 2 k(lambda) = 0, k contact and film in series."""
    found = modes(disc_system("vitrea79-810N"), {"speed": 360 * RPM})
    assert len(found.eigenvalues) == 3 and len(found.oscillating) == 1
    for value in found.eigenvalues:
        stiffness = 2 * squeeze_stiffness(value, film_at(360.0))
        # The stiffness is steep at the film's own eigenvalue: 1e-13 of that is 1e-9 of this.
        assert abs(MASS * value**2 + stiffness) < 1e-9 * abs(stiffness)


def test_quasistatic_film_and_dry_contact() -> None:
    """Assert natural frequency and damping ratio where the film has no state, and without film."""
    dry = modes(Disc(film=None, zeta=0.007).compile())
    omega0 = math.sqrt(2 * CONTACT / MASS)
    assert dry.frequencies[0] == pytest.approx(omega0, rel=1e-13)
    assert dry.damping_ratios[0] == pytest.approx(0.007, rel=1e-11)
    series = 1 / (1 / CONTACT + film_at(360.0) / (BETA * PRELOAD))
    soft = modes(Disc(film="quasistatic", zeta=0.007).compile())
    assert soft.frequencies[0] == pytest.approx(math.sqrt(2 * series / MASS), rel=1e-10)
    assert soft.damping_ratios[0] == pytest.approx(0.007 * omega0 / soft.frequencies[0], rel=1e-12)


def test_si_jacobian_has_the_eigenvalues() -> None:
    """Assert that the Jacobian in SI units is the same matrix in other units."""
    found = modes(disc_system("turbo33-810N"), {"speed": 300 * RPM})
    own = np.linalg.eigvals(found.jacobian)
    for value in found.eigenvalues:
        assert np.abs(own - value).min() < 1e-9 * np.abs(found.eigenvalues).max()


def test_two_coordinates() -> None:
    """Assert that two free discs have the mode of their approach, and the two zeros of moving together."""
    one, two = modes(Disc().compile()), modes(Disc(two=True).compile())
    assert two.oscillating[0] == pytest.approx(one.oscillating[0], rel=1e-12)
    assert len(two.eigenvalues) == 5 and len(two.oscillating) == 1
    # A double zero of the Jacobian is found to the root of the rounding error.
    assert np.abs(two.eigenvalues[:2]).max() < 1e-4 * two.frequencies[0]


def test_rest_without_stiffness() -> None:
    """Assert that a mass on a cubic spring rests, and moves there as if free."""
    x = sym.coordinate("x")
    parts = sym.Mass(x, 2.0) + sym.Damper(x, 0.5) + sym.CubicSpring(x, 1.0) + sym.HarmonicForce(x, 0.5)
    found = modes(sym.compile(parts))
    np.testing.assert_allclose(found.eigenvalues, [0.0, -0.25], atol=1e-15)
    assert len(found.frequencies) == 0


class Uphill(sym.Part):
    """A force 1 + x^2, which is nowhere zero."""

    def __init__(self, q: sym.Coordinate) -> None:
        self.q = q

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        motion = assembly.motion(self.q)
        motion.force += 1 + motion.position.symbol**2


def test_no_rest() -> None:
    """Assert that a model without an equilibrium is refused with its parameters named."""
    x = sym.coordinate("x")
    system = sym.compile(sym.Mass(x, 1.0) + Uphill(x) + sym.HarmonicForce(x, 0.5))
    with pytest.raises(NoRestError, match="no equilibrium was found at m = 1, F = 0.5, Omega = 3"):
        modes(system, {"Omega": 3.0})


def test_unknown_parameter() -> None:
    """Assert that a name that is no parameter is refused with those that are."""
    with pytest.raises(ValueError, match="parameter is 'omega'; it must be one of m, c, k, k3, F, Omega"):
        modes(duffing_system(*DAMPING), {"omega": 1.0})


@pytest.mark.parametrize("scene", ["vitrea79-810N", "vitrea79-2100N", "turbo33-810N", "dry-810N"])
def test_resonance_is_consistent(scene: str) -> None:
    """Assert that at the resonance speed the excitation has the natural frequency of that speed."""
    speed = resonance(disc_system(scene), "speed", (100 * RPM, 500 * RPM))
    assert speed is not None
    found = modes(disc_system(scene), {"speed": speed})
    assert found.omega == pytest.approx(found.frequencies[0], rel=1e-11)
    assert found.omega == pytest.approx(WAVES * speed, rel=1e-14)


def test_resonance_speeds() -> None:
    """Assert the resonance speeds of the paper's discs, in rev/min (physics.md: 281 and 330)."""
    speeds = {
        scene: resonance(disc_system(scene), "speed", (100 * RPM, 500 * RPM))
        for scene in ("vitrea79-810N", "vitrea79-2100N")
    }
    assert speeds["vitrea79-810N"] == pytest.approx(281.1815 * RPM, rel=1e-6)
    assert speeds["vitrea79-2100N"] == pytest.approx(330.5229 * RPM, rel=1e-6)


def test_no_resonance_in_range() -> None:
    """Assert that a range without resonance, and a system that does not oscillate, give none."""
    assert resonance(duffing_system(*DAMPING), "Omega", (2.0, 3.0)) is None
    assert resonance(duffing_system(2.5, 0.0, 0.5), "Omega", (0.3, 3.0)) is None


def pair(damping: float) -> sym.CompiledSystem:
    """x'' + c x' + x = 0.5 cos(Omega t) beside y'' + 0.1 y' + 9 y = 0."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    first = sym.Mass(x, 1.0) + sym.Damper(x, sym.parameter("c", damping, "N s/m")) + sym.Spring(x, 1.0)
    second = sym.Mass(y, sym.parameter("M", 1.0, "kg")) + sym.Damper(y, sym.parameter("d", 0.1, "N s/m"))
    second += sym.Spring(y, sym.parameter("K", 9.0, "N/m"))
    return sym.compile(first + second + sym.HarmonicForce(x, 0.5))


def test_jump_is_no_resonance() -> None:
    """Assert that the lowest frequency's jump from 1 to 3, where x is overdamped, is not met at Omega = 2."""
    system = pair(0.5)
    ends = [modes(system, {"c": c, "Omega": 2.0}).frequencies[0] for c in (1.0, 3.0)]
    assert ends[0] == pytest.approx(1.0) and ends[1] == pytest.approx(3.0)
    assert resonance(system, "c", (1.0, 3.0), {"Omega": 2.0}) is None


class Bump(sym.Part):
    """A damper that is overcritical in the middle of the range of Omega: 10 exp(-(Omega - 1)^2/0.01)."""

    def __init__(self, q: sym.Coordinate) -> None:
        self.q = q

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        damping = 10 * ca.exp(-((assembly.omega - 1) ** 2) / 0.01)
        assembly.motion(self.q).force -= damping * assembly.speed_of(self.q)


def test_nothing_oscillates_inside_the_range() -> None:
    """Assert that a root is not made up where the motion does not oscillate between the bounds."""
    x = sym.coordinate("x")
    system = sym.compile(sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + Bump(x) + sym.HarmonicForce(x, 0.5))
    assert [len(modes(system, {"Omega": w}).frequencies) for w in (0.5, 1.0, 1.6)] == [1, 0, 1]
    assert resonance(system, "Omega", (0.5, 1.6)) is None


def test_scale_of_a_part_is_no_resonance() -> None:
    """Assert that a part on a scale of its own, 2e-15 of the rest, does not make the response infinite."""
    small, omega = {"M": 2e-15, "K": 1.8e-14, "d": 2e-16}, np.array([2.0, 2.5])
    found = response(pair(0.1), "Omega", omega, small)
    exact = 0.5 / (1 - omega**2 + 0.1j * omega)
    np.testing.assert_allclose(found.complex_amplitude("x"), exact, rtol=1e-12)


def test_oscillator_response() -> None:
    """Assert the complex response F / (k - m Omega^2 + i c Omega) of a linear oscillator."""
    omegas = np.linspace(0.1, 3, 30)
    found = response(duffing_system(*DAMPING), "Omega", omegas)
    exact = 0.5 / (1 - omegas**2 + 0.1j * omegas)
    np.testing.assert_allclose(found.complex_amplitude("x"), exact, rtol=1e-13)
    np.testing.assert_allclose(found.peak_to_peak("x"), 2 * abs(exact), rtol=1e-13)
    np.testing.assert_allclose(found.phase("x"), np.angle(exact), rtol=1e-12)
    np.testing.assert_array_equal(found.at_rest("x"), 0)


def test_disc_response() -> None:
    """Assert all outputs of the lubricated disc: W = k (w - X), -m omega^2 X = 2 W, w = a sin(tau)."""
    rpm = 200.0
    found = response(disc_system("vitrea79-810N"), "speed", [rpm * RPM])
    omega, wave = WAVES * rpm * RPM, -1j * AMPLITUDE
    stiffness = squeeze_stiffness(1j * omega, film_at(rpm), rpm)
    x = 2 * stiffness * wave / (2 * stiffness - MASS * omega**2)
    load = stiffness * (wave - x)
    deflection = load / CONTACT
    expected = {"x": x, "load": load, "deflection": deflection, "film": deflection - wave + x}
    for name, amplitude in expected.items():
        assert found.complex_amplitude(name)[0] == pytest.approx(amplitude, rel=1e-12)
    assert found.at_rest("deflection")[0] == pytest.approx(DELTA0, rel=1e-12)
    assert found.at_rest("load")[0] == pytest.approx(PRELOAD, rel=1e-12)
    assert found.at_rest("film")[0] == pytest.approx(film_at(rpm), rel=1e-12)


def test_dry_response() -> None:
    """Assert the response of a dry contact, whose rows are not linear in the wave."""
    found = response(Disc(film=None, zeta=0.007).compile(), "speed", [360 * RPM])
    mu, omega0 = MASS / 2, math.sqrt(2 * CONTACT / MASS)
    x = CONTACT * -1j * AMPLITUDE / (CONTACT - mu * OMEGA**2 + 2j * 0.007 * omega0 * mu * OMEGA)
    assert found.complex_amplitude("x")[0] == pytest.approx(x, rel=1e-12)


def test_response_is_the_limit_of_orbits() -> None:
    """Assert that orbits at a thousandth of the waviness have the linear response, in every output."""
    system = disc_system("vitrea79-810N")
    small = Disc(amplitude=1e-3 * AMPLITUDE).compile()
    orbit = per.trace(small, "speed", (350 * RPM, 360 * RPM), start=360 * RPM)[0]
    linear = response(system, "speed", [360 * RPM], {"amplitude": 1e-3 * AMPLITUDE})
    for name in ("x", "film", "deflection", "load"):
        assert orbit.peak_to_peak(name) == pytest.approx(linear.peak_to_peak(name)[0], rel=1e-6)


def test_peak() -> None:
    """Assert peak and place of an oscillator's response: F/(2 zeta sqrt(1 - zeta^2)), sqrt(1 - 2 zeta^2)."""
    where, height = peak(duffing_system(*DAMPING), "x", "Omega", (0.8, 1.2))
    assert where == pytest.approx(math.sqrt(1 - 2 * 0.05**2), rel=1e-6)
    assert height == pytest.approx(2 * 0.5 / (2 * 0.05 * math.sqrt(1 - 0.05**2)), rel=1e-12)


def test_undamped_resonance() -> None:
    """Assert that the response is infinite where nothing limits it."""
    found = response(duffing_system(0.0, 0.0, 0.5), "Omega", [1.0, 2.0])
    assert math.isinf(found.peak_to_peak("x")[0])
    assert found.peak_to_peak("x")[1] == pytest.approx(2 * 0.5 / 3, rel=1e-13)


def test_waves() -> None:
    """Assert that residual and outputs in terms of the waves are those of the system at sin tau, cos tau."""
    e, tau = disc_system("dry-810N").expressions, 0.3
    known = ca.vertcat(e.rate, e.state, e.parameter)
    both = ca.Function("both", [known, e.phase, e.waves], [e.waved, ca.vertcat(e.residual, e.outputs)])
    values = np.linspace(0.3, 0.9, known.size1())
    waved, direct = both(values, tau, [math.sin(tau), math.cos(tau)])
    np.testing.assert_allclose(np.array(waved), np.array(direct), rtol=1e-15)


DUFFING = duffing_system(*DAMPING)
REFUSED: list[tuple[Callable[[], object], str]] = [
    (lambda: modes("a"), "system is 'a'; it must be a CompiledSystem, as symbolic.compile returns it"),  # type: ignore[arg-type]
    (lambda: modes(DUFFING, 3), "values is 3; it must be a mapping of names to numbers"),  # type: ignore[arg-type]
    (lambda: modes(DUFFING, {"k": math.nan}), "value of k is nan; it must be a finite number"),
    (
        lambda: modes(DUFFING, {"Omega": 0}),
        "the frequency of the excitation in rad/s is 0.0; it must be greater than 0",
    ),
    (lambda: response(DUFFING, "Omega", 1.0), "at is 1.0; it must be a sequence of finite numbers"),  # type: ignore[arg-type]
    (lambda: response(DUFFING, "Omega", [math.nan]), "at is nan; it must be a finite number"),
    (
        lambda: response(DUFFING, "Omega", [1.0], {"Omega": 3.0}),
        "parameter is 'Omega', which is also in values; it must be one or the other",
    ),
    (
        lambda: response(DUFFING, "Omega", [1.0]).at_rest("y"),
        "output is 'y'; it must be one of x",
    ),
    (
        lambda: resonance(DUFFING, "Omega", (1, 2, 3)),  # type: ignore[arg-type]
        "bounds of Omega is (1, 2, 3); it must be two finite numbers",
    ),
]


@pytest.mark.parametrize(("ask", "said"), REFUSED, ids=[said for _, said in REFUSED])
def test_refused_in_one_sentence(ask: Callable[[], object], said: str) -> None:
    """Assert that what cannot be is refused with its name, its value and what is allowed."""
    with pytest.raises(ValueError, match=f"^{re.escape(said)}$"):
        ask()
