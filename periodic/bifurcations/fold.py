"""LP: folds (limit points, saddle-nodes), where the parameter reverses: d parameter / d arclength = 0."""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import PARABOLA_LEFT, TestFunction
from periodic.correction.predictor import difference
from periodic.correction.solution import Solution
from periodic.linear.unknowns import size_of

LEAST_SLOPE = 1e-10
"""Slopes smaller than this times the length of the parameter's range are rounding."""


VERTICAL = 1e-5
"""Slopes smaller than this times the length of the parameter's range are at a fold or a vertical branch."""

FOLD_ARCLENGTH = 0.005
"""Least arclength over which the bend at a fold is measured against the error of the parameter."""


def slope(solution: Solution) -> float:
    """d parameter / d arclength; 0 where the branch is vertical."""
    found = solution.tangent.parameter
    return found if abs(found) > LEAST_SLOPE * solution.problem.scale else 0.0


def has_two_folds(base: Solution, new: Solution) -> bool:
    """Whether the parameter may reverse twice within a step.

    Its slope is about a parabola in the arclength, of which the end values and the mean are known.
    """
    way = difference(base.problem, base.orbit, new.orbit)
    mean = way.parameter / base.tangent.dot(
        way, base.orbit, base.problem.units(base.orbit), size_of(base.orbit)
    )
    ends = np.array([base.tangent.parameter, new.tangent.parameter])
    sign = np.sign(ends[0])
    return bool(sign * (1.5 * mean - ends.mean() / 2) < PARABOLA_LEFT * np.abs(ends).min())


def moves(base: Solution, new: Solution) -> float:
    """Return by how much the parameter changes between two solutions, less its error (SI).

    On a vertical branch, as in a canard explosion, the error is the estimated one; elsewhere rounding alone.
    """
    return max(abs(new.value - base.value) - _blur(base, new), 0.0)


def has_fold(base: Solution, new: Solution, ds: float) -> bool:
    """Whether a change of sign of the slope within a step is a fold, or error of the parameter.

    It is a fold if the arc rises above its chord by more than that error, over at least FOLD_ARCLENGTH.
    """
    bend = abs(new.tangent.parameter - base.tangent.parameter) / ds
    return bend * max(ds, FOLD_ARCLENGTH) ** 2 / 8 > _blur(base, new)


def _blur(base: Solution, new: Solution) -> float:
    scale = base.problem.scale
    if max(abs(end.tangent.parameter) for end in (base, new)) > VERTICAL * scale:
        return LEAST_SLOPE * scale
    return max(end.error.blur(end.value, scale) for end in (base, new))


FOLD = TestFunction(label=Label.FOLD, value=slope, twice=has_two_folds)
"""An error in the place along the branch changes the parameter to second order; at other points to first."""
