"""Predictors: the tangent from one solution, the cubic between two."""

from __future__ import annotations

from periodic.correction.newton import moved
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit


def tangent(problem: Problem, solution: Solution, distance: float) -> Orbit:
    """Return the orbit moved by a distance along the tangent of its branch."""
    return moved(problem.system, problem.free, solution.orbit, solution.tangent, distance)


def cubic(
    solver: Solver, a: Solution, b: Solution, distance: float, place: float, along: Solution | None = None
) -> Orbit:
    """Return the cubic through two solutions on one mesh and their tangents, at `place` from the first.

    `place`, and `distance` of the second, are measured along the tangent of the first or of `along`, a
    solution on this mesh.
    """
    origin = along or a
    constraint = solver.constraint(origin.orbit, origin.tangent, 0.0)
    theta, problem = place / distance, solver.problem
    chord = difference(problem, a.orbit, b.orbit).scaled(theta**2 * (3 - 2 * theta))
    begin = a.tangent.scaled(distance * theta * (1 - theta) ** 2 / constraint.rate(a.tangent))
    end = b.tangent.scaled(distance * theta**2 * (theta - 1) / constraint.rate(b.tangent))
    return moved(problem.system, problem.free, a.orbit, chord + begin + end)


def difference(problem: Problem, a: Orbit, b: Orbit) -> Increment:
    """Return the way from a to b, on one mesh."""
    free = list(problem.free)
    return Increment.of(
        a,
        b.nodes - a.nodes,
        b.stages - a.stages,
        b.algebraic - a.algebraic,
        b.phases - a.phases,
        b.parameter[free] - a.parameter[free],
    )
