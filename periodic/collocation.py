"""Collocation equations, linearised and condensed interval by interval.

At each collocation point R(x', x, z, tau, p) = 0 with x' the polynomial's derivative. The unknowns z are
eliminated point by point through the algebraic rows, the stages interval by interval. With y the anchor
phases and free parameters, what is left of interval j is an affine map

    dx_{j+1} = step[j] (1, dx_j, dy).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.system import System


@dataclass(frozen=True)
class Condensed:
    """Maps from (1, dx_j, dy), width w = 1+n+q: step (N, n, w), stages (N, ncol, n, w).

    algebraic (N, ncol, m, 1+2n+q) maps (1, d rate, d state, dy) to -dz. residual is the largest one.
    """

    step: Array
    stages: Array
    algebraic: Array
    residual: float


def condense(system: System, orbit: Orbit, free: tuple[int, ...]) -> Condensed:
    """Linearise the collocation equations at an orbit and eliminate all that is local.

    Raises FloatingPointError where the equations are not finite, numpy.linalg.LinAlgError where a local
    matrix is singular.
    """
    columns, residual = _reduced_rows(system, orbit, free)
    reduced, algebraic = columns
    count, ncol, n = orbit.stages.shape
    rate, state = reduced[..., 1 : 1 + n], reduced[..., 1 + n : 1 + 2 * n]
    weights = orbit.mesh.scheme.stage_rates / orbit.grid.width[:, None, None]
    matrix = rate[:, :, :, None, :] * weights[:, :, None, 1:, None]
    each = np.arange(ncol)
    matrix[:, each, :, each, :] += np.moveaxis(state, 1, 0)
    right = -np.concatenate(
        [reduced[..., :1], rate * weights[:, :, :1, None], reduced[..., 1 + 2 * n :]], axis=3
    )
    size = ncol * n
    solution = np.linalg.solve(matrix.reshape(count, size, size), right.reshape(count, size, -1))
    stages = solution.reshape(count, ncol, n, -1)
    return Condensed(_steps(orbit, stages), stages, algebraic, residual)


def _reduced_rows(system: System, orbit: Orbit, free: tuple[int, ...]) -> tuple[tuple[Array, Array], float]:
    """Columns (residual, d rate, d state, dy) of the differential rows once z is eliminated."""
    count, ncol, n = orbit.stages.shape
    tau, rate = orbit.stage_phases, orbit.knot_rates[:, 1:]
    shape = (count * ncol, -1)
    line = system.linearise(
        rate.reshape(shape),
        orbit.stages.reshape(shape),
        orbit.algebraic.reshape(count * ncol, orbit.algebraic.shape[2]),
        tau.ravel(),
        orbit.parameter,
        free,
    )
    residual = float(np.abs(line.residual).max())
    if not np.isfinite(residual):
        raise FloatingPointError("the residual is not finite")
    columns = np.concatenate(
        [line.residual[:, :, None], line.d_rate, line.d_state, _phase_columns(orbit, line.d_rate, line.d_phase),
         line.d_parameter],
        axis=2,
    )  # fmt: skip
    if not np.isfinite(columns).all():
        raise FloatingPointError("a derivative of the residual is not finite")
    algebraic = np.linalg.solve(line.d_algebraic[:, n:], columns[:, n:])
    reduced = columns[:, :n] - line.d_algebraic[:, :n] @ algebraic
    m, width = algebraic.shape[1:]
    return (reduced.reshape(count, ncol, n, width), algebraic.reshape(count, ncol, m, width)), residual


def _phase_columns(orbit: Orbit, d_rate: Array, d_phase: Array) -> Array:
    """Derivatives of the rows in the anchor phases, which move and stretch the intervals."""
    grid, points = orbit.grid, orbit.mesh.scheme.points
    k = len(orbit.phases)
    shift = grid.left_gradient[:, None, :] + grid.width_gradient[:, None, :] * points[:, None]
    stretch = np.repeat(grid.width_gradient / grid.width[:, None], len(points), axis=0)
    rate = orbit.knot_rates[:, 1:].reshape(len(d_phase), -1, 1)
    return d_phase[:, :, None] * shift.reshape(len(d_phase), 1, k) - (d_rate @ rate) * stretch[:, None, :]


def _steps(orbit: Orbit, stages: Array) -> Array:
    end, n = orbit.mesh.scheme.end, orbit.nodes.shape[1]
    steps = np.einsum("l,jlnw->jnw", end[1:], stages)
    steps[:, np.arange(n), 1 + np.arange(n)] += end[0]
    steps[:, :, 0] += end @ orbit.knots - orbit.nodes[1:]
    return steps


def recover(
    orbit: Orbit, condensed: Condensed, nodes: Array, outer: Array, constant: float
) -> tuple[Array, Array]:
    """Return the increments of stages and unknowns that go with node increments and dy = `outer`.

    constant is 1 for a Newton step, 0 for a direction along the solution set.
    """
    count, ncol, n = orbit.stages.shape
    head = np.concatenate(
        [np.full((count, 1), constant), nodes[:-1], np.broadcast_to(outer, (count, len(outer)))], axis=1
    )
    stages = np.einsum("jlnw,jw->jln", condensed.stages, head)
    knots = np.concatenate([nodes[:-1, None, :], stages], axis=1)
    rates = orbit.mesh.scheme.stage_rates @ knots / orbit.grid.width[:, None, None]
    inner = np.concatenate(
        [
            np.full((count, ncol, 1), constant),
            rates,
            stages,
            np.broadcast_to(outer, (count, ncol, len(outer))),
        ],
        axis=2,
    )
    return stages, -np.einsum("jlmw,jlw->jlm", condensed.algebraic, inner)
