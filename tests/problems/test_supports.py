"""Bearings of finite stiffness behind the discs: against two coupled oscillators, both sides, and SciPy."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from reference.integration import path
from support.kept import kept
from support.traces import FINE, RPM

import periodic as per
import symbolic as sym
from symbolic.motion.linear import modes
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

MASS, PRELOAD, HERTZ, AMPLITUDE = 20.4, 810.0, 28e9, 1.27e-6
DELTA0 = (PRELOAD / HERTZ) ** (2 / 3)
CONTACT = 1.5 * PRELOAD / DELTA0
"""Stiffness of the dry contact under the preload, N/m."""

CASES = [(5e8, 0.3), (1e8, 0.7), (3e9, 0.05)]
"""Stiffness of each bearing (N/m) and share of the disc."""

each_case = pytest.mark.parametrize(("stiffness", "share"), CASES)


def dry(
    stiffness: float, share: float, damping: float = 0.0, leaf: float | None = None
) -> sym.CompiledSystem:
    """The supported scene without its film, and with other numbers."""
    changes = [("film", ""), ("support.stiffness", repr(stiffness)), ("support.disc_share", repr(share))]
    changes += [("support.damping", repr(damping))]
    changes += [("support.leaf", repr(leaf))] if leaf is not None else []
    return build(load("supports-810N", changes))


def matrices(stiffness: float, share: float, damping: float, leaf: float) -> np.ndarray:
    """First-order matrix of the two oscillators, from the equations of one side each (x1 = x2, y1 = y2).

    m_d x1'' = -2 k_c x1 - k (x1 - y1) - c (x1' - y1'), m_h y1'' = k (x1 - y1) + c (x1' - y1') - k_l y1.
    """
    disc, housing = share * MASS, (1 - share) * MASS
    k = np.array([[2 * CONTACT + stiffness, -stiffness], [-stiffness, stiffness + leaf]])
    c = damping * np.array([[1.0, -1.0], [-1.0, 1.0]])
    inverse = np.diag([1 / disc, 1 / housing])
    return np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ k, -inverse @ c]])


@each_case
@pytest.mark.parametrize("damping", [0.0, 5e3])
@pytest.mark.parametrize("leaf", [None, 1e6])
def test_two_coupled_oscillators(stiffness: float, share: float, damping: float, leaf: float | None) -> None:
    """Assert that the modes of small motion are those of two coupled linear oscillators, to rounding."""
    found = modes(dry(stiffness, share, damping, leaf)).oscillating
    exact = np.linalg.eigvals(matrices(stiffness, share, damping, leaf or 0.0))
    exact = exact[exact.imag > 0]
    np.testing.assert_allclose(found, exact[np.argsort(np.abs(exact))], rtol=1e-11)


@each_case
def test_stiffness_from_frequency(stiffness: float, share: float) -> None:
    """Assert that k/2 = k_c (1 - f) r (1 - f r)/(1 - r) at the first mode."""
    r = modes(dry(stiffness, share)).frequencies[0] ** 2 * (MASS / 2) / CONTACT
    assert stiffness / 2 == pytest.approx(CONTACT * (1 - share) * r * (1 - share * r) / (1 - r), rel=1e-11)


def test_light_disc_puts_contact_and_bearings_in_series() -> None:
    """Assert that mu omega^2 is s (1 + f (1 - s^2/k_c^2)), s = 1/(1/k_c + 2/k), to first order in f."""
    series = 1 / (1 / CONTACT + 2 / 5e8)
    slope = 1 - (series / CONTACT) ** 2
    for f, remainder in ((4e-3, 0.004), (2e-3, 0.002)):
        error = modes(dry(5e8, f)).frequencies[0] ** 2 * (MASS / 2) / series - 1
        assert error / f == pytest.approx(slope, rel=remainder)


def test_stiff_bearings_are_rigid() -> None:
    """Assert that the first mode tends to that of the rigid disc from below."""
    rigid = modes(build(load("vitrea79-810N", [("film", "")]))).frequencies[0]
    supported = modes(dry(1e14, 0.3)).frequencies[0]
    assert 0 < 1 - supported / rigid < 1e-5


def test_spring_beside_the_contact_raises_the_frequency() -> None:
    """Assert that a support straight from the discs to ground adds k/2 to the contact's stiffness."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    parts = [sym.ReducedMass(x, MASS, MASS), sym.Preload(pair, PRELOAD), sym.Hertz(pair, HERTZ)]
    supported = sym.compile(sym.combine([*parts, sym.Support(x, 1e8, in_series=2)]))
    exact = np.sqrt((CONTACT + 0.5e8) / (MASS / 2))
    assert modes(supported).frequencies[0] == pytest.approx(exact, rel=1e-12)


def test_support_has_spring_and_damper() -> None:
    """Assert that Support(k, c) is Spring(k) + Damper(c)."""
    x = sym.coordinate("x")
    one = sym.compile(sym.Mass(x, 2.0) + sym.Support(x, 50.0, 0.6))
    two = sym.compile(sym.Mass(x, 2.0) + sym.Spring(x, 50.0) + sym.Damper(x, 0.6))
    np.testing.assert_allclose(modes(one).eigenvalues, modes(two).eigenvalues, rtol=1e-13)


def first(system: sym.CompiledSystem, rpm: float) -> per.Point:
    """The orbit at a speed."""
    speed = rpm * RPM
    return per.trace(system, "speed", (0.9999 * speed, speed), start=speed, tol=FINE)[0]


def both_sides(stiffness: float, damping: float, share: float, leaf: float) -> sym.CompiledSystem:
    """The dry scene with four coordinates: each disc and each housing by itself."""
    speed = sym.parameter("speed", 300 * RPM, "rad/s")
    k, c = sym.parameter("k", stiffness), sym.parameter("c", damping)
    discs = [sym.coordinate(f"x{i}") for i in (1, 2)]
    housings = [sym.coordinate(f"y{i}", scale=DELTA0) for i in (1, 2)]
    pair = sym.ContactPair(*discs)
    parts: list[sym.Part] = [sym.Preload(pair, PRELOAD), sym.Hertz(pair, HERTZ)]
    parts.append(sym.Waviness(pair, AMPLITUDE, 120, speed))
    disc, housing = sym.parameter("disc", share * MASS), sym.parameter("housing", (1 - share) * MASS)
    for x, y in zip(discs, housings, strict=True):
        parts += [sym.Mass(x, disc), sym.Mass(y, housing), sym.Coupling(x, y, k, c), sym.Support(y, leaf)]
    return sym.compile(sym.combine(parts))


def test_sums_of_both_sides() -> None:
    """Assert that x and y of the scene are x1 + x2 and y1 + y2 of a model of both sides, along an orbit."""
    numbers = {"stiffness": 5e8, "damping": 5e4, "share": 0.3, "leaf": 1e6}
    tau = np.linspace(0, 2 * np.pi, 64)
    sums, sides = dry(**numbers), both_sides(**numbers)
    orbits = [first(system, 300.0).orbit.state(tau) for system in (sums, sides)]
    names = [[s.name for s in system.states] for system in (sums, sides)]
    for q in ("x", "y"):
        one = orbits[0][:, names[0].index(q)]
        two = sum(orbits[1][:, names[1].index(f"{q}{i}")] for i in (1, 2))
        assert np.abs(one - two).max() < 1e-8 * np.ptp(one)


def rates(tau: float, s: np.ndarray, omega: float, k: float, c: float, f: float) -> list[float]:
    """The dry scene in SI units and time: s = (x, x', y, y'), written without the package."""
    x, vx, y, vy = s
    load_ = HERTZ * max(DELTA0 + AMPLITUDE * np.sin(tau) - x, 0.0) ** 1.5
    bearing = (k * (x - y) + c * (vx - vy)) / 2
    return [
        vx / omega,
        (load_ - PRELOAD - bearing) / (f * MASS / 2) / omega,
        vy / omega,
        bearing / ((1 - f) * MASS / 2) / omega,
    ]


@kept
def through_resonance() -> per.Branch:
    """The dry scene from contact at 300 rev/min to the loss of it at 235."""
    bounds = (235 * RPM, 450 * RPM)
    system = dry(5.13e8, 0.3, 5e4)
    return per.trace(system, "speed", bounds, start=450 * RPM, at=(300 * RPM,), tol=FINE)


@pytest.mark.parametrize("rpm", [300.0, 235.0])
def test_orbit_by_integration(rpm: float) -> None:
    """Assert that SciPy's DOP853 comes back to the orbit after a period, in contact and out of it."""
    branch, omega = through_resonance(), 120 * rpm * RPM
    point = next(p for p in branch if p.parameter == rpm * RPM)
    start = point.orbit.state(np.zeros(1))[0] * DELTA0
    start[[1, 3]] *= omega
    assert [s.name for s in branch.layout.states] == ["x", "x'", "y", "y'"]
    assert (point.minimum["load"] == 0) == (rpm == 235.0)
    field = partial(rates, omega=omega, k=5.13e8, c=5e4, f=0.3)
    states = path(field, start, rtol=1e-11, atol=1e-15, max_step=0.01)
    scale = np.abs(states).max(axis=1)
    assert (np.abs(states[:, -1] - start) / scale).max() < 1e-7


def test_pairs_that_are_born() -> None:
    """Assert that a trace goes on where two real multipliers become a second oscillating pair."""
    system = build(load("supports-810N", (("support.damping", "1000"),)))
    branch = per.trace(system, "speed", (470 * RPM, 500 * RPM), start=500 * RPM)
    pairs = [int((point.multipliers.imag > 0).sum()) for point in branch]
    assert {1, 2} <= set(pairs)
    assert branch.stop.reason is per.Reason.BOUND
