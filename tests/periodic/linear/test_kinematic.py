"""Shortcuts of the linear algebra give what the plain elimination gives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import symbolic as sym
from periodic.collocation.elimination import eliminated
from periodic.linear import bordering as chaining
from periodic.linear import kinematic
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Family, Scheme


def chain(count: int) -> sym.CompiledSystem:
    """A driven chain of Duffing oscillators, the first of them coupled by a damper."""
    coordinates = [sym.coordinate(f"x{i}") for i in range(count)]
    parts: list[sym.Part] = [sym.HarmonicForce(coordinates[0], 0.5)]
    for i, x in enumerate(coordinates):
        parts += [sym.Mass(x, 1.0), sym.Damper(x, sym.parameter(f"c{i}", 0.1 + 0.01 * i))]
        parts += [sym.Spring(x, 1.0), sym.CubicSpring(x, 0.5)]
    return sym.compile(sym.combine(parts))


def orbit(system: sym.CompiledSystem, scheme: Scheme, ntst: int = 9) -> Orbit:
    """Random numbers in place of an orbit."""
    rng = np.random.default_rng(1)
    rest = at_rest(system, uniform(scheme, ntst), system.nominal)
    return replace(rest, nodes=rng.normal(size=rest.nodes.shape), stages=rng.normal(size=rest.stages.shape))


@pytest.mark.parametrize("scheme", [Scheme(Family.RADAU, 4), Scheme(Family.GAUSS, 3)])
def test_positions_follow_from_velocities(scheme: Scheme, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that eliminating kinematic rows first changes the condensed equations by rounding alone."""
    system = chain(6)
    guess = orbit(system, scheme)
    found = eliminated(system, guess, (0,))
    monkeypatch.setattr(kinematic, "PAYS_FROM", 10**6)
    plain = eliminated(system, guess, (0,))
    assert np.abs(found.stages - plain.stages).max() < 1e-12 * np.abs(plain.stages).max()
    assert np.abs(found.step - plain.step).max() < 1e-12 * np.abs(plain.step).max()


def test_kinematic_rows_are_found() -> None:
    """Assert that the rows q' = v of a chain are found, with their positions and velocities."""
    system = chain(5)
    count = len(system.states)
    line = system.linearise(
        np.zeros((1, count)), np.ones((1, count)), np.zeros((1, 0)), np.zeros(1), system.nominal
    )
    found = kinematic.kinematic(line.d_rate[:, None], line.d_state[:, None])
    assert found is not None
    names = [state.name for state in system.states]
    assert [names[k] for k in found.positions] == [f"x{i}" for i in range(5)]
    assert [names[k] for k in found.velocities] == [f"x{i}'" for i in range(5)]


@pytest.mark.parametrize("ntst", [1, 2, 3, 9, 16, 23])
def test_chain_in_pairs(ntst: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that maps multiplied in pairs are those multiplied one after the other."""
    system = chain(2)
    local = eliminated(system, orbit(system, Scheme(ncol=3), ntst), (0,))
    found = chaining.chain(local)
    monkeypatch.setattr(chaining, "PAIRED_UP_TO", 0)
    plain = chaining.chain(local)
    assert found.shape == plain.shape == (ntst + 1, 4, 6)
    assert np.abs(found - plain).max() < 1e-12 * np.abs(plain).max()
