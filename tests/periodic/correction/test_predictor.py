"""Predictors along a branch: what they give at its ends, their slopes there, and their order."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.traces import duffing_system

import periodic as per
from periodic.correction import predictor
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver, Work
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array


def pair(length: float) -> tuple[Solver, Solution, Solution]:
    """Two solutions on one mesh, the second on the plane across the tangent of the first `length` along."""
    run = per.continuation(per.Problem(duffing_system(0.1, 1.0, 0.5), "Omega", (0.6, 1.0)), tol=1e-6)
    solver = Solver(run.solver.problem, run.solver.discretisation, run.solver.tolerance, Work())
    first = solver.at_parameter(next(run).orbit, 1.0)
    guess = predictor.tangent(solver.problem, first, length)
    return solver, first, solver.on(guess, solver.constraint(first.orbit, first.tangent, length))


def values(orbit: Orbit) -> Array:
    """All numbers of an orbit that is corrected."""
    return np.concatenate([orbit.nodes.ravel(), orbit.stages.ravel(), orbit.parameter])


def test_cubic_has_the_values_and_slopes_of_both_ends() -> None:
    """Assert the solutions themselves at the ends, to rounding, and their tangents by differences."""
    length, step = 0.02, 1e-5
    solver, a, b = pair(length)
    at = {place: values(predictor.cubic(solver, a, b, length, place)) for place in (0.0, length)}
    assert at[0.0] == pytest.approx(values(a.orbit), abs=1e-14)
    assert at[length] == pytest.approx(values(b.orbit), abs=1e-14)
    along = solver.constraint(a.orbit, a.tangent, 0.0)
    for place, end in ((0.0, a), (length, b)):
        sides = [values(predictor.cubic(solver, a, b, length, place + k * step)) for k in (1, -1)]
        ahead = predictor.tangent(solver.problem, end, step / along.rate(end.tangent))
        behind = predictor.tangent(solver.problem, end, -step / along.rate(end.tangent))
        slope = (values(ahead) - values(behind)) / (2 * step)
        assert (sides[0] - sides[1]) / (2 * step) == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())


def test_cubic_is_of_fourth_order() -> None:
    """Assert that halving a step brings the solution in its middle 16 times nearer, twice over."""
    off = []
    for length in (0.08, 0.04, 0.02):
        solver, a, b = pair(length)
        middle = predictor.cubic(solver, a, b, length, length / 2)
        exact = solver.on(middle, solver.constraint(a.orbit, a.tangent, length / 2))
        off.append(np.abs(values(middle) - values(exact.orbit)).max())
    assert np.log2(off[0] / off[1]) == pytest.approx(4, abs=0.3)
    assert np.log2(off[1] / off[2]) == pytest.approx(4, abs=0.3)


def test_tangent_is_of_second_order() -> None:
    """Assert the same of the tangent, 4 times."""
    off = []
    for length in (0.04, 0.02):
        solver, a, b = pair(length)
        ahead = predictor.tangent(solver.problem, a, length)
        off.append(np.abs(values(ahead) - values(b.orbit)).max())
    assert np.log2(off[0] / off[1]) == pytest.approx(2, abs=0.2)


def test_difference_leads_from_one_to_the_other() -> None:
    """Assert that the way between two orbits moves the first to the second."""
    solver, a, b = pair(0.05)
    way = predictor.difference(solver.problem, a.orbit, b.orbit)
    moved = predictor.tangent(solver.problem, replace(a, tangent=way), 1.0)
    assert values(moved) == pytest.approx(values(b.orbit), abs=1e-14)
