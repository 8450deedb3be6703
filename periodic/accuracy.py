"""The error estimate of an orbit: one Newton step on the mesh with every interval halved.

The step solves the linearised equations on a discretisation that is 2^(ncol+1) times more accurate between
mesh points, so its increment is the error of the orbit to first order (deferred correction).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from periodic import collocation
from periodic.closure import Condition, Plane, closures
from periodic.newton import Condense, Outcome, at_fixed_phase, linear_step
from periodic.orbit import Orbit, bisect
from periodic.resolution import lost
from periodic.scheme import Array
from periodic.system import System

LEAST_SPAN = 1e-6
"""Peak to peak (scaled) that errors are compared with at the least: an orbit may shrink to a rest."""

SAFETY = 3.0
"""How much smaller than a tolerance error estimates are to be, which beside kinks are not just right."""

SMALL = 0.1
"""Values of a parameter, in parts of its range, with which its error is compared at the least."""


@dataclass(frozen=True)
class ErrorEstimate:
    """orbit: largest error of the states over their largest peak to peak.

    parameter: error of the continuation parameter across the branch, so that of an LP its place, relative.
    multiplier: error of the sums of the Floquet multipliers and of their squares, relative to the largest one
    where that exceeds 1; it is the multipliers' own error unless two of them all but coincide.
    """

    orbit: float
    multiplier: float
    parameter: float = 0.0

    @property
    def motion(self) -> float:
        """What is held against the tolerance but for the multipliers."""
        return SAFETY * max(self.orbit, self.parameter)

    @property
    def worst(self) -> float:
        """What is held against the tolerance."""
        return max(self.motion, SAFETY * self.multiplier)


UNKNOWN = ErrorEstimate(np.inf, np.inf, np.inf)


def estimate(
    system: System,
    orbit: Orbit,
    monodromy: Array,
    plane: Plane | None,
    free: tuple[int, ...] = (),
    conditions: Sequence[Condition] = (),
    condense: Condense = collocation.condense,
) -> ErrorEstimate:
    """Estimate the errors of a converged orbit: of fixed parameters, or of `free` ones on a plane.

    `condense` are the equations that it is held against on the halved mesh.
    """
    fine = bisect(orbit)
    closing = [] if plane is None else [*closures(conditions, free[1:], fine), _moved(plane, fine)]
    step = linear_step(system, fine, free, closing, condense)
    if isinstance(step, Outcome):
        return UNKNOWN
    moved = step.outer[: len(fine.phases)]
    nodes = step.orbit.nodes - fine.nodes + step.nodes
    stages = step.orbit.stages - fine.stages + step.stages
    change = np.abs(at_fixed_phase(fine, nodes, moved)).max()
    change = max(change, np.abs(stages - fine.knot_rates[:, 1:] * _stage_shift(fine, moved)).max())
    multiplier = _spectral_distance(step.fundamental[-1], monodromy)
    if condense is collocation.condense:
        multiplier = max(multiplier, lost(system, orbit))
    return ErrorEstimate(
        orbit=float(change) / max(orbit.span(), LEAST_SPAN),
        multiplier=multiplier,
        parameter=0.0 if plane is None else _relative(step.outer[len(fine.phases)], orbit, free[0], plane),
    )


def _relative(change: float, orbit: Orbit, index: int, plane: Plane) -> float:
    """A change of the continuation parameter relative to it, or near 0 to its range."""
    return float(abs(change) / max(abs(orbit.parameter[index]), SMALL * plane.metric.scale))


def _stage_shift(orbit: Orbit, moved: Array) -> Array:
    """How far the collocation points move in tau with the anchors, shape (N, ncol, 1)."""
    grid, points = orbit.grid, orbit.mesh.scheme.points
    left, stretch = grid.left_gradient @ moved, grid.width_gradient @ moved
    return (left[:, None] + stretch[:, None] * points)[:, :, None]


def _spectral_distance(a: Array, b: Array) -> float:
    """Distance of two spectra in the sums of their first and second powers, over the largest multiplier.

    Unlike the multipliers themselves these stay smooth where two of them meet.
    """
    scale = max(1.0, float(np.abs(np.linalg.eigvals(a)).max()))
    first = abs(np.trace(a) - np.trace(b)) / scale
    second = abs(np.trace(a @ a) - np.trace(b @ b)) / (2 * scale**2)
    return float(max(first, second))


def _moved(plane: Plane, fine: Orbit) -> Plane:
    """The same plane through an orbit on the halved mesh."""
    coarse = plane.direction.profile
    profile = np.empty_like(fine.nodes)
    profile[::2] = coarse
    profile[1::2] = (coarse[1:] + coarse[:-1]) / 2
    return Plane(fine, plane.direction.with_profile(profile), 0.0, plane.metric, plane.index)
