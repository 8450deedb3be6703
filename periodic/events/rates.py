"""Rates of a motion at a point and their slopes, from the equations; before an event, from the orbit."""

from __future__ import annotations

import numpy as np

from periodic.events.modes import linearise
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System

ITERATIONS = 4
"""Newton steps; one is enough where the equations are linear in rates and unknowns."""

CLOSE = 1e-14
"""Relative change that is none."""


def rate_at(
    system: System, orbit: Orbit, x: Array, rate: Array, algebraic: Array, phase: Array, side: Array
) -> Array:
    """Return x' (n,) at a state (1, n) and a phase (1,) on given sides of jumps, from guesses of x' and z.

    Raises numpy.linalg.LinAlgError where the equations do not determine it.
    """
    n, found = x.shape[1], np.append(rate, algebraic)[None]
    for _ in range(ITERATIONS):
        line = linearise(system, found[:, :n], x, found[:, n:], phase, orbit.parameter, side[None])
        matrix = np.concatenate([line.d_rate, line.d_algebraic], axis=2)[0]
        change = np.linalg.solve(matrix, line.residual[0])
        found = found - change
        if np.abs(change).max() <= CLOSE * (1 + np.abs(found).max()):
            break
    return found[0, :n]


def before(orbit: Orbit, index: int) -> tuple[int, Array, Array]:
    """The interval before an event node, the state x- at its end, shape (1, n), and the phase, shape (1,)."""
    interval = int(orbit.mesh.starts[index] - 1) % orbit.mesh.ntst
    return interval, orbit.mesh.scheme.end[None] @ orbit.knots[interval], orbit.phases[index : index + 1]


def rate_before(orbit: Orbit, index: int) -> Array:
    """x' at the end of the interval before an event node, shape (n,)."""
    interval = before(orbit, index)[0]
    return orbit.mesh.scheme.end @ orbit.knot_rates[interval]
