"""States at which equations, or their mean over the excitation, are at rest."""

from __future__ import annotations

import numpy as np
import pytest
from support.oscillators import X, oscillator

import symbolic as sym
from periodic.orbit.orbit import FORCED
from periodic.phasespace.search.atrest import at_rest

pytestmark = pytest.mark.usefixtures("users_kernels")

PHASES = np.linspace(0, FORCED, 16, endpoint=False)


def test_three_rests_of_two_wells() -> None:
    """Assert the roots of k x + k3 x^3 = mean, which the force, whose mean is 0, does not move."""
    system = oscillator(sym.Spring(X, -2.0), sym.CubicSpring(X, 1.0), sym.ConstantForce(X, 0.1), force=0.5)
    starts = np.random.default_rng(0).uniform(-2, 2, (40, 2))
    found = at_rest(system, system.nominal, starts, np.full(2, 4.0), PHASES)
    roots = np.sort(np.roots([1.0, 0.0, -1.0, -0.1]).real)
    assert np.sort([state[0] for state, _ in found]) == pytest.approx(roots, abs=1e-8)
    assert all(abs(state[1]) < 1e-8 for state, _ in found)


def test_no_rest_and_no_starts() -> None:
    """Assert nothing where a mean force is held by nothing, and from no places."""
    q = sym.coordinate("q")
    free = sym.Mass(q, 1.0) + sym.Damper(q, 0.1) + sym.ConstantForce(q, 1.0) + sym.HarmonicForce(q, 1.0, 1.0)
    system = sym.compile(free)
    starts = np.random.default_rng(0).uniform(-2, 2, (8, 2))
    assert at_rest(system, system.nominal, starts, np.ones(2), PHASES) == []
    assert at_rest(system, system.nominal, starts[:0], np.ones(2), PHASES) == []


def test_films_do_not_warn() -> None:
    """Assert that a film's slopes, of hardly any size far from contact, lead to no warning."""
    disc = sym.scene("vitrea79-810N")
    starts = np.random.default_rng(0).uniform(-40, 40, (64, len(disc.states)))
    found = at_rest(disc, disc.nominal, starts, np.ones(len(disc.states)), PHASES)
    assert all(np.isfinite(state).all() and np.isfinite(unknowns).all() for state, unknowns in found)
