"""Rates of a motion at a point and their derivatives, from the equations; before an event, from the orbit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from periodic.events.modes import linearise
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.system.precision import CONVERGED, MOST_ITERATIONS


def rates_at(
    system: System, parameter: Array, x: Array, rate: Array, algebraic: Array, phase: Array, side: Array
) -> Array:
    """Return x' (K, n) at states (K, n) and phases (K,) on given sides of jumps, from guesses of x' and z.

    Raises numpy.linalg.LinAlgError where the equations do not determine it.
    """
    n, found = x.shape[1], np.concatenate([rate, algebraic], axis=1)
    for _ in range(MOST_ITERATIONS):
        line = linearise(system, (found[:, :n], x, found[:, n:], phase, parameter), side)
        matrix = np.concatenate([line.d_rate, line.d_algebraic], axis=2)
        change = np.linalg.solve(matrix, line.residual[..., None])[..., 0]
        found = found - change
        if (np.abs(change).max(axis=1) <= CONVERGED * (1 + np.abs(found).max(axis=1))).all():
            break
    return found[:, :n]


def before(orbit: Orbit, index: int) -> tuple[int, Array, Array]:
    """The interval before an event node, the state x- at its end, shape (1, n), and the phase, shape (1,)."""
    interval = int(orbit.mesh.starts[index] - 1) % orbit.mesh.ntst
    return interval, orbit.mesh.scheme.end[None] @ orbit.knots[interval], orbit.phases[index : index + 1]


def all_before(orbit: Orbit, indices: Sequence[int]) -> tuple[NDArray[np.int_], Array, Array]:
    """The intervals before event nodes (K,), the states x- at their ends (K, n), and the phases (K,)."""
    interval = (orbit.mesh.starts[list(indices)].astype(np.int_) - 1) % orbit.mesh.ntst
    return interval, orbit.mesh.scheme.end @ orbit.knots[interval], orbit.phases[list(indices)]


def rate_before(orbit: Orbit, index: int) -> Array:
    """x' at the end of the interval before an event node, shape (n,)."""
    interval = before(orbit, index)[0]
    return orbit.mesh.scheme.end @ orbit.knot_rates[interval]
