"""LP and BP on curves in two parameters of orbits at a level, or of peaks.

Both are where a multiplier is 1: there the branches in one parameter that the curve crosses turn (LP), or
another such curve crosses it (BP), as that of lopsided orbits crosses one of symmetric orbits. With K the
orbit's linearised equations, closed over the period, c the further conditions and t the curve's tangent,

    det [K K_y; c_u c_y; t]

changes sign at a BP alone: at an LP the curve itself goes on.
"""

from __future__ import annotations

import numpy as np

from periodic.bifurcations import stationary
from periodic.bifurcations.branchpoint import branching
from periodic.bifurcations.doubling import DOUBLING, known
from periodic.bifurcations.label import Label
from periodic.bifurcations.stationary import HOPF
from periodic.bifurcations.testfunction import TestFunction
from periodic.bifurcations.torus import TORUS
from periodic.conditions.variations import variations
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.solution import Solution
from periodic.equilibrium.linearise import crossing
from periodic.linear.unknowns import size_of
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Stability


def _matrix(solution: Solution) -> Array:
    """[K K_y; c_u c_y; t], parameters in ranges, each row over its length."""
    problem, orbit = solution.problem, solution.orbit.collocated()
    tangent = solution.tangent
    if orbit is not solution.orbit:
        tangent = tangent.restricted(solution.orbit, orbit)
    along = ArclengthConstraint(orbit, tangent, 0.0, problem.units(orbit), problem.index, size_of(orbit))
    closed = variations(problem.system, orbit, problem.free).repeating(1.0)
    closing = [*problem.side_conditions(orbit), along]
    rows = [condition.linearise(problem.system, orbit, problem.free) for condition in closing]
    matrix = np.concatenate([closed.matrix, *(closed.functional(row)[None] for row in rows)])
    matrix[:, -len(problem.free) :] *= problem.scale
    return np.asarray(matrix / np.linalg.norm(matrix, axis=1)[:, None])


def side(solution: Solution) -> float:
    """Return the sign of the determinant of the curve's equations and its tangent."""
    return float(np.linalg.slogdet(_matrix(solution))[0])


def crosses(solution: Solution) -> float:
    """|prod (mu - 1)| times the sign of the determinant: it changes sign at a BP alone."""
    return abs(solution.once(branching)) * solution.once(side)


def folds(solution: Solution) -> float:
    """prod (mu - 1) times the sign of the determinant: it changes sign at an LP alone."""
    return solution.once(branching) * solution.once(side)


def equilibrium_folds(solution: Solution) -> float:
    """prod lambda of an equilibrium times the sign of its determinant."""
    return stationary.product(solution) * float(np.sign(solution.once(stationary.branching)))


CONTOUR = {
    Stability.MULTIPLIERS: (
        DOUBLING,
        TORUS,
        TestFunction(label=Label.BRANCH, value=crosses, genuine=known, singular=True),
        TestFunction(label=Label.FOLD, value=folds, genuine=lambda found: not crossing(_matrix(found)[:-1])),
    ),
    Stability.EIGENVALUES: (
        HOPF,
        TestFunction(label=Label.BRANCH, value=stationary.branching, singular=True),
        TestFunction(
            label=Label.FOLD, value=equilibrium_folds, genuine=lambda found: not stationary.is_crossed(found)
        ),
    ),
}
"""Test functions of the special points of a curve, by what decides stability."""
