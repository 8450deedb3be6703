"""Local solution of the intervals of a guess: each as one implicit Runge-Kutta step from its left mesh point.

An orbit carried to a new mesh is accurate to the tolerance, yet inside an interval at a kink its stages and
unknowns may be far from any solution of the equations there. Solving such intervals on their own leaves
small gaps at the mesh points, with which the global Newton iteration copes well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from periodic.collocation.elimination import solve_stages
from periodic.collocation.residual import Rows, eliminate, finite
from periodic.events.modes import linearise, sides
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System

LOCAL_ITERATIONS = 25
HARD = 1e-6
"""Intervals whose first local increment is larger than this are solved."""
LOCAL_INCREMENT = 1e-9
"""Local increments at which an interval is solved."""


@dataclass
class _Pieces:
    """Some intervals of an orbit: left ends, widths, stage phases, stages, unknowns, sides of jumps."""

    start: Array
    width: Array
    tau: Array
    stages: Array
    algebraic: Array
    side: Array

    def take(self, chosen: NDArray[np.bool_]) -> _Pieces:
        return _Pieces(*[a[chosen] for a in vars(self).values()])


def relax(system: System, orbit: Orbit) -> Orbit:
    """Return the orbit with its hard intervals solved locally, as far as they converge."""
    pieces = _Pieces(
        orbit.nodes[:-1],
        orbit.grid.width,
        orbit.stage_phases,
        orbit.stages,
        orbit.algebraic,
        sides(system, orbit),
    )
    stages, algebraic = orbit.stages.copy(), orbit.algebraic.copy()
    index = np.arange(orbit.mesh.ntst)
    for iteration in range(LOCAL_ITERATIONS):
        try:
            size = _iterate(system, orbit, pieces)
        except (FloatingPointError, np.linalg.LinAlgError):
            break
        done = size < (HARD if iteration == 0 else LOCAL_INCREMENT)
        if iteration:
            stages[index[done]], algebraic[index[done]] = pieces.stages[done], pieces.algebraic[done]
        going = ~done
        if not going.any():
            break
        index, pieces = index[going], pieces.take(going)
    return replace(orbit, stages=stages, algebraic=algebraic)


def _iterate(system: System, orbit: Orbit, pieces: _Pieces) -> Array:
    """Take one Newton step in every piece; return the size of each piece's increment."""
    scheme, (count, ncol, n) = orbit.mesh.scheme, pieces.stages.shape
    m = pieces.algebraic.shape[2]
    knots = np.concatenate([pieces.start[:, None, :], pieces.stages], axis=1)
    with np.errstate(all="ignore"):  # intervals without length: what is not finite is refused below
        weights = scheme.stage_rates / pieces.width[:, None, None]
        rates = (weights @ knots).reshape(-1, n)
    stages, unknowns = pieces.stages.reshape(-1, n), pieces.algebraic.reshape(count * ncol, m)
    at = rates, stages, unknowns, pieces.tau.ravel(), orbit.parameter
    line = linearise(system, at, np.repeat(pieces.side, ncol, axis=0))
    columns = np.concatenate([line.residual[:, :, None], line.d_rate, line.d_state], axis=2)
    reduced, map_z = eliminate(finite(Rows(columns, line.d_algebraic)), n)
    local = reduced.reshape(count, ncol, n, -1)
    change = solve_stages(local, local[..., :1], weights)[..., 0]
    along = weights[:, :, 1:] @ change
    inner = np.concatenate([np.ones((count, ncol, 1)), along, change], axis=2)
    dz = -np.einsum("plmw,plw->plm", map_z.reshape(count, ncol, m, 1 + 2 * n), inner)
    moved = pieces.algebraic
    if m:
        flat = (count * ncol, m)
        moved = system.move(pieces.algebraic.reshape(flat), dz.reshape(flat)).reshape(dz.shape)
    shift = np.abs(moved - pieces.algebraic) / (1 + np.abs(pieces.algebraic))
    pieces.stages = pieces.stages + change
    pieces.algebraic = moved
    return np.maximum(np.abs(change).max(axis=(1, 2)), (shift**2).max(axis=(1, 2), initial=0.0))
