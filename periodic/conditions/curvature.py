"""Second derivatives of the equations along a tangent: exact, or by differences where the equations jump.

Differences of the first derivatives, on the side that each interval has, are good to nine digits; they are
gradients of what Newton holds to be zero, which itself is exact in either case.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.events.modes import linearise, sides
from periodic.orbit.gradients import Points, Slopes
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import LinearisationLike, System, differentiable, jumps_of
from periodic.system.precision import difference_step

TANGENT_STEP = difference_step(order=2)
"""Step along a tangent, as a part of the tangent's size."""


def beside(system: System, orbit: Orbit, points: Points, free: tuple[int, ...]) -> LinearisationLike:
    """Linearise the equations at points of an orbit, on the sides of jumps that their intervals have."""
    return linearise(system, points.arguments(orbit), sides(system, orbit)[points.index], free)


def curvature(
    system: System,
    orbit: Orbit,
    points: Points,
    weights: Array,
    along: Points,
    parameter: Array,
    free: tuple[int, ...],
) -> Slopes:
    """Return the derivatives of weights . dR v at collocation points.

    weights (points, n+m); `along` has rate, state and unknowns of the tangent v, `parameter` (p,) its last
    part. Raises ValueError for a system that does not have what this needs.
    """
    exact = differentiable(system)
    if not jumps_of(system):
        v = along.rate, along.state, along.algebraic, parameter
        return Slopes.of(exact.curvature(*points.arguments(orbit), weights, *v), free)
    relative = parameter / np.maximum(np.abs(orbit.parameter), TANGENT_STEP)
    size = max(float(np.abs(part).max(initial=0.0)) for part in (along.state, relative))

    def pulled(step: float) -> Slopes:
        moved = replace(
            points,
            rate=points.rate + step * along.rate,
            state=points.state + step * along.state,
            algebraic=points.algebraic + step * along.algebraic,
        )
        at = replace(orbit, parameter=orbit.parameter + step * parameter)
        return _weighted(beside(system, at, moved, free), weights)

    both = zip(*(vars(pulled(step / size)).values() for step in (TANGENT_STEP, -TANGENT_STEP)), strict=True)
    return Slopes(*((ahead - back) * size / (2 * TANGENT_STEP) for ahead, back in both))


def _weighted(line: LinearisationLike, weights: Array) -> Slopes:
    """The derivatives of weights . R."""
    return Slopes(
        np.einsum("pr,prn->pn", weights, line.d_rate),
        np.einsum("pr,prn->pn", weights, line.d_state),
        np.einsum("pr,prm->pm", weights, line.d_algebraic),
        np.einsum("pr,pr->p", weights, line.d_phase),
        np.einsum("pr,prq->q", weights, line.d_parameter),
    )
