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

VERTEX = 3e-4
"""Distance (rad) from each other of three phases whose parabola tells where an output is stationary,
to about its square, and to rounding over it."""


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
    where = orbit.locate(_stationary(solution, orbit, found))
    ahead, behind = (
        _values(solution, problem.expand(tangent(problem, solution, side * ARCLENGTH_STEP)), where)
        for side in (1, -1)
    )
    slopes = (ahead - behind) / (2 * ARCLENGTH_STEP)
    count = len(found.minimum)
    return Measured(found, slopes[:count], slopes[count:])


def _stationary(solution: Solution, orbit: Orbit, found: Extremes) -> Array:
    """The phases of the extremes, those of the minima first, to what slopes along the branch need.

    Values are right to second order where phases are to the first, slopes are not: each phase is that of the
    vertex of the parabola about it, but beside an event, where the extreme may be a corner.
    """
    phases = np.concatenate([found.minimum_phase, found.maximum_phase])
    if orbit.equilibrium:
        return phases
    count = len(found.minimum)
    at = phases[:, None] + VERTEX * np.array([-1.0, 0.0, 1.0])
    each = outputs(solution.problem.full, orbit, at.ravel()).reshape(2 * count, 3, count)
    low, middle, high = each[np.arange(2 * count), :, np.tile(np.arange(count), 2)].T
    bend = low - 2 * middle + high
    with np.errstate(invalid="ignore", divide="ignore"):
        later = np.where(bend != 0, (low - high) / (2 * bend), 0.0)
    half = orbit.mesh.period / 2
    away = np.abs((phases[:, None] - orbit.phases + half) % orbit.mesh.period - half)
    smooth = (np.abs(later) < 1) & (away > 2 * VERTEX).all(axis=1)
    return np.where(smooth, phases + VERTEX * later, phases)


def _values(solution: Solution, moved: Orbit, where: tuple[NDArray[np.int_], Array]) -> Array:
    """Each output at its own two places in the mesh of a moved orbit, those of the minima first."""
    index, theta = where
    phases = moved.grid.left[index] + theta * moved.grid.width[index]
    values = outputs(solution.problem.full, moved, phases)
    count = values.shape[1]
    return values[np.arange(2 * count), np.tile(np.arange(count), 2)]
