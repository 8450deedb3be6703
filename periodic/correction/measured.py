"""The extremes of the outputs of a solution, and how they change along the branch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.correction.predictor import tangent
from periodic.correction.solution import Solution
from periodic.orbit.extrema import Extremes, extrema, outputs
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array

ARCLENGTH_STEP = 1e-4
"""Arclength of the central difference that stands for a derivative along the branch."""


@dataclass(frozen=True)
class Measured:
    """Extremes of each output, and their derivatives in arclength.

    Parameters
    ----------
    extremes : Extremes
        Values and phases.
    minimum_slope, maximum_slope : Array
        d minimum / d arclength and d maximum / d arclength (SI), shape (outputs,).
    """

    extremes: Extremes
    minimum_slope: Array
    maximum_slope: Array

    @property
    def peak_to_peak(self) -> Array:
        """Maximum minus minimum (SI), shape (outputs,)."""
        return self.extremes.maximum - self.extremes.minimum

    @property
    def peak_to_peak_slope(self) -> Array:
        """d peak to peak / d arclength (SI), shape (outputs,)."""
        return self.maximum_slope - self.minimum_slope


def measured(solution: Solution) -> Measured:
    """Return the extremes of a solution, computed once, and how they change along the branch.

    An extreme changes as the output does at its place in the mesh: where it lies at an event it moves so.

    Parameters
    ----------
    solution : Solution
        A solution, with its tangent.

    Returns
    -------
    Measured
        Of all outputs of the whole system.
    """
    return solution.once(_measured)


def _measured(solution: Solution) -> Measured:
    problem, orbit = solution.problem, solution.problem.expand(solution.orbit)
    found = extrema(problem.full, orbit)
    phases = np.concatenate([found.minimum_phase, found.maximum_phase])
    where = orbit.locate(phases)
    ahead, behind = (
        _values(solution, problem.expand(tangent(problem, solution, side * ARCLENGTH_STEP)), where)
        for side in (1, -1)
    )
    slopes = (ahead - behind) / (2 * ARCLENGTH_STEP)
    count = len(found.minimum)
    return Measured(found, slopes[:count], slopes[count:])


def _values(solution: Solution, moved: Orbit, where: tuple[NDArray[np.int_], Array]) -> Array:
    """Each output at its own two places in the mesh of a moved orbit, those of the minima first."""
    index, theta = where
    phases = moved.grid.left[index] + theta * moved.grid.width[index]
    values = outputs(solution.problem.full, moved, phases)
    count = values.shape[1]
    return values[np.arange(2 * count), np.tile(np.arange(count), 2)]
