"""LP: folds (limit points, saddle-nodes), where the branch turns: d parameter / d arclength = 0."""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import LEFT, TestFunction
from periodic.correction.predictor import difference
from periodic.correction.solution import Solution
from periodic.linear.unknowns import size_of

VERTICAL = 1e-10
"""Slopes smaller than this, in ranges of the parameter, are rounding."""


def slope(solution: Solution) -> float:
    """d parameter / d arclength; 0 where the branch is vertical."""
    found = solution.tangent.parameter
    return found if abs(found) > VERTICAL * solution.problem.scale else 0.0


def turns_twice(base: Solution, new: Solution) -> bool:
    """Whether the parameter may turn and turn back within a step.

    Its slope is about a parabola of the way, of which the values at the ends and the mean are known.
    """
    way = difference(base.problem, base.orbit, new.orbit)
    mean = way.parameter / base.tangent.dot(way, base.orbit, base.problem.scale, size_of(base.orbit))
    ends = np.array([base.tangent.parameter, new.tangent.parameter])
    sign = np.sign(ends[0])
    return bool(sign * (1.5 * mean - ends.mean() / 2) < LEFT * np.abs(ends).min())


FOLD = TestFunction(label=Label.FOLD, value=slope, twice=turns_twice)
"""Its parameter is second order in its place; those of the others are first order."""
