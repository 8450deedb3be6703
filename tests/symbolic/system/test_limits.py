"""Traced orbits: a scene tends to the scene without a part as that part's parameter tends to its limit."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from support.models import AMPLITUDE, RPM, Array, Disc, duffing_parts

import periodic as per
import symbolic as sym

PHASES = np.linspace(0, 2 * np.pi, 64, endpoint=False)
LONG = per.ArclengthControl(ds=0.2)
BASE = Disc(zeta=0.05)
"""Enough damping beside the film that the amplitude feels any other damping to first order."""


def first(system: sym.CompiledSystem, parameter: str = "speed", at: float = 360 * RPM) -> per.Point:
    """The orbit at a value of the parameter, found by a trace over a thousandth of it."""
    branch = per.trace(system, parameter, (at, 1.001 * at), start=at, tol=per.Accuracy.FINE, control=LONG)
    assert branch.stop.reason is per.Reason.BOUND
    return branch[0]


def displacement(system: sym.CompiledSystem, point: per.Point) -> Array:
    """X along the orbit (SI): the state x, or x1 + x2."""
    states = point.orbit.state(PHASES)
    chosen = [i for i, v in enumerate(system.states) if v.name in ("x", "x1", "x2")]
    return sum((system.states[i].scale * states[:, i] for i in chosen), np.zeros(len(PHASES)))


def deviations(model: Callable[[float], sym.CompiledSystem], limit: sym.CompiledSystem, at: float) -> Array:
    """x peak to peak at a parameter and half of it, less that of the limit, as parts of that."""
    goal = first(limit).peak_to_peak("x")
    return np.array([first(model(value)).peak_to_peak("x") for value in (at, at / 2)]) / goal - 1


def assert_first_order(pair: Array, below: float) -> None:
    """Assert that the deviation is small, above the error of the orbits, and halves with the parameter."""
    assert 1e-6 < abs(pair[0]) < below
    assert pair[0] / pair[1] == pytest.approx(2, rel=0.03)


def test_film_tends_to_the_quasistatic_film_without_squeeze() -> None:
    """Assert that x p-p of the squeeze film tends to that of the quasi-static film, linearly in squeeze."""
    limit = replace(BASE, film="quasistatic").compile()
    assert_first_order(deviations(lambda s: replace(BASE, squeeze=s).compile(), limit, 6.0), 1e-4)


def test_quasistatic_film_tends_to_the_dry_contact() -> None:
    """Assert that x p-p of the quasi-static film tends to that of the dry contact, linearly in 1/beta."""
    film = replace(BASE, film="quasistatic")
    limit = replace(BASE, film=None).compile()
    assert_first_order(deviations(lambda e: replace(film, beta=1 / e).compile(), limit, 1e-3), 5e-3)


def test_damping_tends_to_none() -> None:
    """Assert that x p-p of the lubricated disc tends to that without ContactDamping, linearly in zeta."""
    limit = replace(BASE, zeta=None).compile()
    assert_first_order(deviations(lambda z: replace(BASE, zeta=z).compile(), limit, 2e-4), 1e-3)


def test_cubic_spring_tends_to_none() -> None:
    """Assert that x p-p of the Duffing oscillator tends to that of the linear one, linearly in k3."""

    def size(cubic: float | None) -> float:
        system = sym.compile(sym.combine(duffing_parts(cubic)))
        return first(system, "Omega", 2.0).peak_to_peak("x")

    sizes = np.array([size(1e-2), size(5e-3)]) / size(None) - 1
    assert_first_order(sizes, 5e-3)


def test_linear_oscillator_has_its_textbook_amplitude() -> None:
    """Assert that without a cubic spring x p-p is 2 F / |k - m Omega^2 + i c Omega|."""
    system = sym.compile(sym.combine(duffing_parts(cubic=None)))
    assert first(system, "Omega", 2.0).peak_to_peak("x") == pytest.approx(1 / abs(1 - 4 + 0.2j), rel=1e-11)


def test_waviness_tends_to_rest() -> None:
    """Assert that x p-p is proportional to the waviness as that vanishes, with an error of second order."""
    sizes = [
        first(replace(BASE, amplitude=AMPLITUDE * e).compile()).peak_to_peak("x") for e in (4e-2, 2e-2, 1e-2)
    ]
    gains = np.array(sizes) / [4, 2, 1]
    assert (gains[0] - gains[1]) / (gains[1] - gains[2]) == pytest.approx(4, rel=0.03)


@pytest.mark.parametrize("masses", [(20.4, 20.4), (20.4, 31.0)], ids=["equal", "unequal"])
@pytest.mark.parametrize("film", [None, "squeeze"])
def test_two_discs_move_as_their_reduced_mass(film: str | None, masses: tuple[float, float]) -> None:
    """Assert that x1 + x2 of two supported discs is the X of one coordinate with their reduced mass.

    The supports have one stiffness per unit of mass, so that the discs' other mode stays at rest; without
    them that mode is a free drift and no orbit is isolated.
    """
    one = Disc(film=film, zeta=0.02, masses=masses, support=1e5)
    two = replace(one, two=True)
    orbits = [displacement(s, first(s)) for s in (one.compile(), two.compile())]
    np.testing.assert_allclose(orbits[1], orbits[0], rtol=0, atol=1e-9 * np.ptp(orbits[0]))


def test_unequal_discs_move_in_inverse_ratio_of_their_masses() -> None:
    """Assert that m1 x1 = m2 x2 along the orbit of two unequal discs on supports in ratio of the masses."""
    masses = (20.4, 31.0)
    system = Disc(masses=masses, support=1e5, two=True).compile()
    names = [v.name for v in system.states]
    states = first(system).orbit.state(PHASES)
    x1, x2 = (m * states[:, names.index(q)] for m, q in zip(masses, ("x1", "x2"), strict=True))
    np.testing.assert_allclose(x1, x2, rtol=0, atol=1e-9 * np.ptp(x1))
