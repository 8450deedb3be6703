"""LP: folds (limit points, saddle-nodes), where the branch turns: d parameter / d arclength = 0."""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import LEFT, TestFunction
from periodic.correction.predictor import difference
from periodic.correction.solution import Solution
from periodic.linear.unknowns import size_of

LEAST_SLOPE = 1e-10
"""Slopes smaller than this, in ranges of the parameter, are rounding."""


VERTICAL = 1e-5
"""Slopes smaller than this, in ranges of the parameter, are those of a turn or of a vertical stretch."""

REACH = 0.005
"""A turn in a vertical stretch is one if the parameter changes by more than its error in a step as long."""


def slope(solution: Solution) -> float:
    """d parameter / d arclength; 0 where the branch is vertical."""
    found = solution.tangent.parameter
    return found if abs(found) > LEAST_SLOPE * solution.problem.scale else 0.0


def turns_twice(base: Solution, new: Solution) -> bool:
    """Whether the parameter may turn and turn back within a step.

    Its slope is about a parabola of the way, of which the values at the ends and the mean are known.
    """
    way = difference(base.problem, base.orbit, new.orbit)
    mean = way.parameter / base.tangent.dot(
        way, base.orbit, base.problem.units(base.orbit), size_of(base.orbit)
    )
    ends = np.array([base.tangent.parameter, new.tangent.parameter])
    sign = np.sign(ends[0])
    return bool(sign * (1.5 * mean - ends.mean() / 2) < LEFT * np.abs(ends).min())


def moves(base: Solution, new: Solution) -> float:
    """Return what the parameter changes by between two solutions beyond what it is known to (SI).

    Where the branch is vertical, as in a canard explosion, that is its error across the branch.
    """
    return max(abs(new.value - base.value) - _blur(base, new), 0.0)


def turns(base: Solution, new: Solution, ds: float) -> bool:
    """Whether a slope that changes sign within a step is more than an error of the parameter along it.

    It is if the arc rises above its chord by more than that.
    """
    bend = abs(new.tangent.parameter - base.tangent.parameter) / ds
    return bend * max(ds, REACH) ** 2 / 8 > _blur(base, new)


def _blur(base: Solution, new: Solution) -> float:
    scale = base.problem.scale
    if max(abs(end.tangent.parameter) for end in (base, new)) > VERTICAL * scale:
        return LEAST_SLOPE * scale
    return max(end.error.blur(end.value, scale) for end in (base, new))


FOLD = TestFunction(label=Label.FOLD, value=slope, twice=turns_twice)
"""Its parameter is second order in its place; those of the others are first order."""
