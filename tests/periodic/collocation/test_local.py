"""Intervals that are solved on their own from their left ends: which are, and how far."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.numpy_systems import AlgebraicOscillator, BrokenOscillator, LinearOscillator
from support.surfaces import along

from periodic.collocation.local import HARD, LOCAL_INCREMENT, relax
from periodic.orbit.orbit import Orbit

SYSTEM = LinearOscillator()


def exact(unknowns: int = 0) -> Orbit:
    """The oscillator's orbit at 24 intervals, where polynomials have it to 7 digits."""
    orbit = along(SYSTEM.exact_state, intervals=24)
    algebraic = np.zeros((*orbit.stages.shape[:2], unknowns))
    if unknowns:
        algebraic[:, :, 0] = np.arcsinh(orbit.stages[:, :, 0])
    return replace(orbit, parameter=SYSTEM.nominal, algebraic=algebraic)


def solved(orbit: Orbit) -> Orbit:
    """The same, with every interval solved from its left end."""
    rough = replace(orbit, stages=orbit.stages + 1e-3)
    return relax(SYSTEM, rough)


def test_hard_intervals_alone_are_solved() -> None:
    """Assert that one far off is led back, and that one off by less than that is left as it is."""
    orbit = solved(exact())
    assert np.abs(orbit.stages - exact().stages).max() < 1e-5
    off = orbit.stages.copy()
    off[3] += 0.1
    off[7, :, 0] += 0.1 * HARD
    found = relax(SYSTEM, replace(orbit, stages=off))
    assert found.stages[3] == pytest.approx(orbit.stages[3], abs=10 * LOCAL_INCREMENT)
    assert found.stages[7].tolist() == off[7].tolist()
    others = [k for k in range(24) if k not in (3, 7)]
    assert found.stages[others].tolist() == orbit.stages[others].tolist()
    assert found.nodes is orbit.nodes


def test_each_interval_begins_at_its_own_left_end() -> None:
    """Assert that a mesh point that is off shifts what follows it alone."""
    orbit = solved(exact())
    nodes = orbit.nodes.copy()
    nodes[5] += 0.1
    found = relax(SYSTEM, replace(orbit, nodes=nodes))
    moved = np.abs(found.stages - orbit.stages).max(axis=(1, 2))
    assert np.flatnonzero(moved > 1e-9).tolist() == [5]
    assert 0.05 < moved[5] < 0.2


def test_unknowns_are_solved_too() -> None:
    """Assert those of an oscillator whose stages and unknowns are both off."""
    system, orbit = AlgebraicOscillator(), exact(1)
    off = replace(orbit, stages=orbit.stages + 0.1, algebraic=orbit.algebraic - 0.3)
    found = relax(system, off)
    assert np.abs(found.stages - orbit.stages).max() < 1e-5
    assert np.abs(found.algebraic - orbit.algebraic).max() < 1e-4
    right = relax(system, replace(orbit, algebraic=orbit.algebraic - 0.3))
    assert np.abs(right.algebraic - orbit.algebraic).max() < 1e-4


def test_orbit_is_left_where_equations_fail() -> None:
    """Assert stages as they were where the equations are no numbers."""
    orbit = replace(exact(), stages=exact().stages + 10.0)
    found = relax(BrokenOscillator(), replace(orbit, parameter=BrokenOscillator().nominal))
    assert found.stages.tolist() == orbit.stages.tolist()
