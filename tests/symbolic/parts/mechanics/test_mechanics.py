"""Each mechanical part against equations written by hand: its orbits return under SciPy's integration."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
import pytest
from numpy.typing import NDArray
from reference.integration import path

import periodic as per
import symbolic as sym
from symbolic.equations.assembly import Assembly

Array = NDArray[np.float64]
Force = Callable[[float, float, float], float]
M, C, K, F, W = 1.0, 0.2, 1.0, 0.6, 0.8
X, Y = sym.coordinate("x", start=0.5), sym.coordinate("y")
MEASURED = (0.0, 0.3, 0.55, 0.2, -0.1, -0.4, -0.35, -0.3)


def polynomial(values: tuple[float, ...], theta: float) -> float:
    """The trigonometric polynomial through an even number of values, without its highest cosine."""
    n = len(values)
    found = sum(values) / n
    for j in range(1, n // 2):
        for i, v in enumerate(values):
            found += 2 / n * v * math.cos(j * (theta - 2 * math.pi * i / n))
    return found


def backlash(x: float, b: float) -> float:
    """Deflection beyond a backlash."""
    return max(x - b, 0.0) + min(x + b, 0.0)


@dataclass(frozen=True)
class Case:
    """Parts beside mass and damper, and the force that they come to, of (theta, x, dx/dt)."""

    parts: tuple[sym.Part, ...]
    force: Force
    turns: int = 1


DRIVE = sym.HarmonicForce(X, F, W)
VARIATION = sym.FourierSeries(cosines=(0.2, 0.1), sines=(0.0, 0.05))


def varied(theta: float) -> float:
    """1 + s of VARIATION."""
    return 1 + 0.2 * math.cos(theta) + 0.1 * math.cos(2 * theta) + 0.05 * math.sin(2 * theta)


CASES = {
    "one-sided": Case(
        (DRIVE, sym.Spring(X, K), sym.OneSidedSpring(X, 4.0, 0.5)),
        lambda th, x, v: F * math.cos(th) - K * x - 4 * max(x - 0.5, 0),
    ),
    "one-sided from below": Case(
        (DRIVE, sym.Spring(X, K), sym.OneSidedSpring(X, 4.0, 0.5, below=True)),
        lambda th, x, v: F * math.cos(th) - K * x + 4 * max(-x - 0.5, 0),
    ),
    "gap": Case(
        (DRIVE, sym.Spring(X, K), sym.Gap(X, 3.0, -0.4, 0.6)),
        lambda th, x, v: F * math.cos(th) - K * x - 3 * (max(x - 0.6, 0) + min(x + 0.4, 0)),
    ),
    "backlash of varying stiffness under a static load": Case(
        (
            sym.ConstantForce(X, 0.3),
            sym.HarmonicForce(X, 0.2, W, phase=0.4),
            sym.Backlash(X, K, 0.1, variation=VARIATION, frequency=W),
        ),
        lambda th, x, v: 0.3 + 0.2 * math.cos(th + 0.4) - K * varied(th) * backlash(x, 0.1),
    ),
    "piecewise linear": Case(
        (DRIVE, sym.PiecewiseLinearSpring(X, (2.0, 0.8, 3.0), (-0.3, 0.5))),
        lambda th, x, v: F * math.cos(th) - 0.8 * x - 1.2 * min(x + 0.3, 0) - 2.2 * max(x - 0.5, 0),
    ),
    "two orders": Case(
        (DRIVE, sym.HarmonicForce(X, 0.3, W, order=3, phase=-0.5), sym.CubicSpring(X, 0.5), sym.Spring(X, K)),
        lambda th, x, v: F * math.cos(th) + 0.3 * math.cos(3 * th - 0.5) - K * x - 0.5 * x**3,
    ),
    "half an order": Case(
        (DRIVE, sym.HarmonicForce(X, 0.3, W, order="1/2"), sym.CubicSpring(X, 0.5), sym.Spring(X, K)),
        lambda th, x, v: F * math.cos(th) + 0.3 * math.cos(th / 2) - K * x - 0.5 * x**3,
        turns=2,
    ),
    "Fourier series of a force": Case(
        (
            sym.PeriodicForce(X, sym.FourierSeries((0.3, 0.0, 0.1), (0.2, 0.15), mean=0.1), W),
            sym.Spring(X, K),
        ),
        lambda th, x, v: (
            0.1
            + 0.3 * math.cos(th)
            + 0.1 * math.cos(3 * th)
            + 0.2 * math.sin(th)
            + 0.15 * math.sin(2 * th)
            - K * x
        ),
    ),
    "samples of a force": Case(
        (sym.PeriodicForce(X, sym.Samples(MEASURED, factor=2.0), W), sym.Spring(X, K)),
        lambda th, x, v: 2 * polynomial(MEASURED, th) - K * x,
    ),
    "moving base": Case(
        (sym.BaseMotion(X, sym.Harmonic(0.4, 2, 0.3), 1.5, 0.2, W),),
        lambda th, x, v: (
            -1.5 * (x - 0.4 * math.cos(2 * th + 0.3)) - 0.2 * (v + 0.8 * W * math.sin(2 * th + 0.3))
        ),
        turns=1,
    ),
    "varying stiffness": Case(
        (DRIVE, sym.VaryingSpring(X, K, VARIATION, frequency=W), sym.CubicSpring(X, 0.2)),
        lambda th, x, v: F * math.cos(th) - K * varied(th) * x - 0.2 * x**3,
    ),
}


def balance(system: sym.CompiledSystem, accelerations: Callable[..., tuple[float, ...]]) -> Array:
    """The residual at random places and speeds, with the accelerations (SI) that are given for them."""
    rng, omega = np.random.default_rng(1), float(system.omega(system.nominal))
    names, scale = [s.name for s in system.states], np.array([s.scale for s in system.states])
    places = [names.index(name) for name in names if not name.endswith("'")]
    rates = [names.index(f"{names[k]}'") for k in places]
    phase = rng.uniform(0, 2 * math.pi, 20)
    state = rng.uniform(-1.2, 1.2, (len(phase), len(names)))
    rate = np.zeros_like(state)
    rate[:, places] = state[:, rates]
    for k, (tau, x) in enumerate(zip(phase, state, strict=True)):
        motion = [value for i, j in zip(places, rates, strict=True) for value in (x[i], omega * x[j])]
        rate[k, rates] = np.array(accelerations(W * tau / omega, *motion)) / omega**2
    none = np.zeros((len(phase), 0))
    found: Array = system.residual(rate / scale, state / scale, none, phase, system.nominal)
    return found


@pytest.mark.parametrize("name", CASES)
def test_equation_of_motion(name: str) -> None:
    """Assert the acceleration under the force written by hand, at random places, speeds and phases."""
    case = CASES[name]
    system = sym.compile(sym.combine([sym.Mass(X, M), sym.Damper(X, C), *case.parts]))

    def by_hand(theta: float, x: float, v: float) -> tuple[float]:
        return ((case.force(theta, x, v) - C * v) / M,)

    assert np.abs(balance(system, by_hand)).max() < 1e-12
    assert np.abs(balance(system, lambda *at: (by_hand(*at)[0] + 1e-3,))).max() > 1e-4


def first(system: sym.CompiledSystem) -> per.Point:
    """The orbit at W to which the motion settles."""
    motion = sym.simulate(system, settle=80)
    guess = per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter)
    only = per.ArclengthControl(max_points=1)
    return per.trace(system, "Omega", (W, 1.1 * W), start=W, guess=guess, tol=1e-9, control=only)[0]


@pytest.mark.parametrize("name", CASES)
def test_part(name: str) -> None:
    """Assert that an orbit of the part returns under the equations written by hand, to 7 digits."""
    case = CASES[name]
    system = sym.compile(sym.combine([sym.Mass(X, M), sym.Damper(X, C), *case.parts]))
    point = first(system)
    begin = point.orbit.state(np.array([0.0]))[0] * [1.0, point.orbit.omega]

    def rates(t: float, y: Array) -> list[float]:
        return [y[1], (case.force(W * t, y[0], y[1]) - C * y[1]) / M]

    found = path(rates, begin, 2 * math.pi * case.turns / W, max_step=0.02)
    np.testing.assert_allclose(found[:, -1], begin, rtol=0, atol=1e-7)
    assert point.peak_to_peak("x") == pytest.approx(np.ptp(found[0]), rel=1e-4)


def pair(spring: sym.Part) -> sym.CompiledSystem:
    """Two masses on springs, the first forced, with one more spring between them."""
    parts = [
        sym.Mass(X, M),
        sym.Mass(Y, 2.0),
        sym.Spring(X, K),
        sym.Spring(Y, 1.5),
        sym.HarmonicForce(X, F, W),
    ]
    return sym.compile(sym.combine([*parts, sym.Damper(X, C), sym.Damper(Y, 0.3), spring]))


BETWEEN: dict[str, tuple[sym.Part, Callable[[float], float]]] = {
    "spring": (sym.Spring(X, 0.7, to=Y), lambda u: 0.7 * u),
    "cubic": (sym.CubicSpring(X, 0.7, to=Y), lambda u: 0.7 * u**3),
    "one-sided": (sym.OneSidedSpring(X, 3.0, 0.2, to=Y), lambda u: 3 * max(u - 0.2, 0)),
    "gap": (sym.Gap(X, 3.0, -0.3, 0.2, to=Y), lambda u: 3 * (max(u - 0.2, 0) + min(u + 0.3, 0))),
    "backlash": (sym.Backlash(X, 2.0, 0.2, to=Y), lambda u: 2 * backlash(u, 0.2)),
    "piecewise": (
        sym.PiecewiseLinearSpring(X, (0.2, 2.0), (0.1,), to=Y),
        lambda u: 0.2 * u + 1.8 * max(u - 0.1, 0),
    ),
}


@pytest.mark.parametrize("name", BETWEEN)
def test_part_between_coordinates(name: str) -> None:
    """Assert that a spring between two coordinates acts on both, to 7 digits."""
    spring, force = BETWEEN[name]
    system = pair(spring)
    orbit = first(system).orbit
    order = [[s.name for s in system.states].index(n) for n in ("x", "x'", "y", "y'")]
    begin = orbit.state(np.array([0.0]))[0][order] * [1, orbit.omega, 1, orbit.omega]

    def rates(t: float, s: Array) -> list[float]:
        x, v, y, w = s
        u = force(x - y)
        return [v, F * math.cos(W * t) - K * x - C * v - u, w, (u - 1.5 * y - 0.3 * w) / 2]

    found = path(rates, begin, 2 * math.pi / W, max_step=0.02)
    np.testing.assert_allclose(found[:, -1], begin, rtol=0, atol=1e-7)


@pytest.mark.parametrize("name", BETWEEN)
def test_equations_of_motion_of_two(name: str) -> None:
    """Assert the accelerations of both masses under forces written by hand, at random places and phases."""
    spring, force = BETWEEN[name]

    def by_hand(theta: float, x: float, v: float, y: float, w: float) -> tuple[float, float]:
        u = force(x - y)
        return (F * math.cos(theta) - K * x - C * v - u) / M, (u - 1.5 * y - 0.3 * w) / 2

    assert np.abs(balance(pair(spring), by_hand)).max() < 1e-12


def test_vector_of_coordinates() -> None:
    """Assert that a chain of masses has the frequencies of its stiffness matrix."""
    x = sym.coordinates("x", 4)
    springs = [sym.Spring(a, 2.0, to=b) for a, b in zip(x, x[1:], strict=False)]
    masses = [sym.Mass(q, 0.5) for q in x]
    system = sym.compile(sym.combine([*masses, sym.Spring(x[0], 2.0), *springs]))
    matrix = 2.0 * (2 * np.eye(4) - np.eye(4, k=1) - np.eye(4, k=-1))
    matrix[3, 3] = 2.0
    expected = np.sqrt(np.linalg.eigvalsh(matrix) / 0.5)
    np.testing.assert_allclose(sym.modes(system).frequencies, expected, rtol=1e-12)


def test_unexcited_system_has_the_mean_stiffness() -> None:
    """Assert that modes of a spring of varying stiffness are those of its mean."""
    system = sym.compile(sym.Mass(X, M) + sym.VaryingSpring(X, 2.0, VARIATION) + sym.ConstantForce(X, 1.0))
    modes = sym.modes(system)
    assert modes.frequencies[0] == pytest.approx(math.sqrt(2.0), rel=1e-13)
    assert modes.state[0] == pytest.approx(0.5, rel=1e-13)


REFUSED: list[tuple[Callable[[], object], str]] = [
    (lambda: sym.Mass(X, -1.0), "mass m is -1.0; it must be a number of at least 0"),
    (lambda: sym.OneSidedSpring(X, -2.0), "stiffness k is -2.0; it must be a number of at least 0"),
    (
        lambda: sym.Gap(X, 1.0, 0.5, 0.2),
        "upper stop of a Gap is 0.2; it must be above the lower stop 0.5, or the two overlap",
    ),
    (
        lambda: sym.Gap(X, 1.0, 0.5, 0.5),
        "upper stop of a Gap is 0.5; it must be above the lower stop 0.5, or the two overlap",
    ),
    (lambda: sym.Backlash(X, 1.0, -0.2), "half backlash b is -0.2; it must be a number of at least 0"),
    (
        lambda: sym.PiecewiseLinearSpring(X, (1.0, 2.0), (0.3, 0.1)),
        "corners of a PiecewiseLinearSpring is (0.3, 0.1); it must be at least one number, rising",
    ),
    (
        lambda: sym.PiecewiseLinearSpring(X, (1.0,), (0.3,)),
        "stiffnesses of a PiecewiseLinearSpring is (1.0,); it must be 2 numbers, one more than corners",
    ),
    (
        lambda: sym.Samples((1.0, 2.0, 3.0, 4.0), harmonics=2),
        "harmonics of Samples is 2; it must be a whole number from 1 to 1",
    ),
    (
        lambda: sym.Samples((1.0, 2.0, 3.0, 4.0, 5.0), harmonics=0),
        "harmonics of Samples is 0; it must be a whole number from 1 to 2",
    ),
    (
        lambda: sym.FourierSeries(),
        "cosines of a FourierSeries is (); it must be at least one number, or sines given",
    ),
    (lambda: sym.coordinates("x", 0), "count of coordinates is 0; it must be a whole number of at least 1"),
    (
        lambda: sym.coordinate("x", start=math.nan),
        "start of coordinate 'x' is nan; it must be a finite number",
    ),
]


@pytest.mark.parametrize(("make", "said"), REFUSED, ids=[said for _, said in REFUSED])
def test_refused_in_one_sentence(make: Callable[[], object], said: str) -> None:
    """Assert that what cannot be is refused with its name, its value and what is allowed."""
    with pytest.raises(ValueError) as caught:
        make()
    assert str(caught.value) == said


@pytest.mark.parametrize(
    ("profile", "value", "slope"),
    [
        (sym.Harmonic(0.5, 2, 0.3), lambda t: 0.5 * math.cos(2 * t + 0.3), lambda t: -math.sin(2 * t + 0.3)),
        (
            sym.FourierSeries((0.2, 0.0, -0.1), (0.0, 0.4), mean=0.7),
            lambda t: 0.7 + 0.2 * math.cos(t) - 0.1 * math.cos(3 * t) + 0.4 * math.sin(2 * t),
            lambda t: -0.2 * math.sin(t) + 0.3 * math.sin(3 * t) + 0.8 * math.cos(2 * t),
        ),
    ],
)
def test_profiles_and_their_slopes(
    profile: Any, value: Callable[[float], float], slope: Callable[[float], float]
) -> None:
    """Assert a periodic function and its derivative in the angle, by hand."""
    assembly = Assembly()
    terms = profile.terms(assembly)
    given = [symbol for _, symbols in assembly.numbers.named().values() for symbol in symbols]
    numbers = ca.vertcat(*given), ca.DM([0.5, 0.3] if len(given) == 2 else [0.2, 0.4, -0.1])
    for theta in (0.0, 0.4, 2.0):
        both = ca.vertcat(terms.value, terms.slope)
        for order, waves in assembly.excitation.waves.items():
            turned = float(order) * theta
            both = ca.substitute(both, ca.vertcat(*waves), ca.DM([math.sin(turned), math.cos(turned)]))
        both = ca.substitute(both, *numbers)
        assert np.array(ca.DM(both)).ravel() == pytest.approx([value(theta), slope(theta)], abs=1e-14)
