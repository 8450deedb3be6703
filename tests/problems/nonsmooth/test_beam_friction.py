"""A beam with friction that sticks at its tip, condensed, against closed-form pieces of all its states."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import scipy
from reference.contact import Contact, Friction, Period, periodic
from support.kept import kept

import periodic as per
import symbolic as sym

ELEMENTS, RATIO, FORCE, FRICTION = 2, 0.02, 0.02, 0.002
BEAM = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=ELEMENTS)


@cache
def system() -> sym.CompiledSystem:
    """The beam's tip."""
    structure = sym.Structure(BEAM, damping=RATIO)
    tip = structure["tip"]
    return sym.compile(structure + sym.CoulombFriction(tip, FRICTION) + sym.HarmonicForce(tip, FORCE, 2.55))


@kept
def branch() -> per.Branch:
    """The branch past a frequency at which stops become passages."""
    return per.trace(system(), "Omega", (2.55, 2.7))


@cache
def exact() -> tuple[Contact, np.ndarray, np.ndarray]:
    """The beam by its modes, the shapes of these at the degrees of freedom, and M."""
    mass, stiffness = np.asarray(BEAM.M), np.asarray(BEAM.K)
    squares, shapes = scipy.linalg.eigh(stiffness, mass)
    n, at = len(squares), shapes[BEAM.at["tip"]]
    matrix, force = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
    matrix[:n, n:] = np.eye(n)
    matrix[n:] = np.hstack([-np.diag(squares), -np.diag(2 * RATIO * np.sqrt(squares))])
    force[n:] = FORCE * at
    row, column = np.zeros(2 * n + 3), np.zeros(2 * n + 3)
    row[n : 2 * n], column[n : 2 * n] = at, -FRICTION * at
    return Contact(matrix, np.zeros(2 * n), force, [Friction(row, column)]), shapes, mass


def followed(point: per.Point) -> tuple[Period, np.ndarray]:
    """The exact orbit from an orbit's state where it slips, and that state."""
    contact, shapes, mass = exact()
    orbit = point.orbit
    longest = int(np.argmax(lengths := orbit.mesh.segment_lengths(orbit.phases)))
    phase = float(orbit.phases[longest]) + 0.4 * float(lengths[longest])
    parts = per.motion(system(), orbit, None, [phase])
    state = np.concatenate([shapes.T @ mass @ part[0] for part in parts])
    return periodic(contact, point.parameter, state, phase), state


def test_orbits() -> None:
    """Assert states to 1e-7, events and the three leading multipliers to 1e-8, with stops and without."""
    counts = set()
    assert branch().stop.reason is per.Reason.BOUND
    for point in branch():
        found, state = followed(point)
        assert found.start == pytest.approx(state, abs=1e-7 * np.abs(state).max())
        assert len(found.events) == len(point.orbit.phases)
        own = point.multipliers[np.argsort(-np.abs(point.multipliers))][:3]
        assert all(np.abs(found.multipliers - value).min() < 1e-8 for value in own)
        counts.add(len(found.events))
    assert counts == {2, 4}
