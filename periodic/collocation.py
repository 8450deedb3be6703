"""Collocation equations, linearised and condensed interval by interval.

At each collocation point R(x', x, z, tau, p) = 0 with x' the polynomial's derivative. The unknowns z are
eliminated point by point through the algebraic rows, the stages interval by interval. With y the anchor
phases and free parameters, what is left of interval j is an affine map

    dx_{j+1} = step[j] (1, dx_j, dy).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.closure import Row
from periodic.kinematic import kinematic, solve
from periodic.native import Routines, routines
from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.system import LinearisationLike, System

BEFORE = 1e-9
"""How far before a kink (rad) the equations are evaluated where a collocation point falls on it."""


@dataclass(frozen=True)
class Condensed:
    """Maps from (1, dx_j, dy), width w = 1+n+q: step (N, n, w), stages (N, ncol, n, w).

    algebraic (N, ncol, m, 1+2n+q) maps (1, d rate, d state, dy) to -dz. residual is the largest one.
    Fulfils `periodic.bordered.Condensed`.
    """

    orbit: Orbit
    step: Array
    stages: Array
    algebraic: Array
    residual: float
    compiled: Routines | None = None

    @property
    def origin(self) -> NDArray[np.int_]:
        """Each mesh point follows from the one before it."""
        return np.arange(len(self.step))

    def reduced(self, row: Row) -> Row:
        """Return a closure in mesh-point states and y alone, its stages eliminated."""
        if row.stages is None:
            return row
        n = row.nodes.shape[1]
        each = np.einsum("jln,jlnw->jw", row.stages, self.stages)
        nodes = row.nodes.copy()
        nodes[:-1] += each[:, 1 : 1 + n]
        return Row(row.value + float(each[:, 0].sum()), nodes, row.outer + each[:, 1 + n :].sum(axis=0))

    def recover(self, nodes: Array, outer: Array, constant: float) -> tuple[Array, Array]:
        """Return the increments of stages and unknowns that go with node increments and dy = `outer`."""
        if self.compiled is not None:
            return self.compiled.recover(self, nodes, outer, constant)
        orbit, (count, ncol, n) = self.orbit, self.orbit.stages.shape
        width, q = self.stages.shape[3], len(outer)
        given = np.empty((count, width, 1))
        given[:, 0, 0], given[:, 1 : 1 + n, 0], given[:, 1 + n :, 0] = constant, nodes[:-1], outer
        stages = (self.stages.reshape(count, ncol * n, width) @ given).reshape(count, ncol, n)
        if orbit.algebraic.shape[2] == 0:
            return stages, np.zeros_like(orbit.algebraic)
        inner = np.empty((count, ncol, 1 + 2 * n + q, 1))
        knots = np.concatenate([nodes[:-1, None, :], stages], axis=1)
        inner[..., 0, 0], inner[..., 1 + 2 * n :, 0] = constant, outer
        inner[..., 1 : 1 + n, 0] = orbit.mesh.scheme.stage_rates @ knots / orbit.grid.width[:, None, None]
        inner[..., 1 + n : 1 + 2 * n, 0] = stages
        return stages, -(self.algebraic @ inner)[..., 0]


def condense(system: System, orbit: Orbit, free: tuple[int, ...]) -> Condensed:
    """Linearise the collocation equations at an orbit and eliminate all that is local.

    Raises FloatingPointError where the equations are not finite, numpy.linalg.LinAlgError where a local
    matrix is singular.
    """
    compiled = routines(system)
    if compiled is not None:
        return Condensed(orbit, *compiled.condense(orbit, _evaluated(system, orbit, free)), compiled)
    rows, residual = linearised(system, orbit, free)
    count, ncol, n = orbit.stages.shape
    reduced, algebraic = eliminate(rows, n)
    width = reduced.shape[2]
    local = reduced.reshape(count, ncol, n, width)
    weights = orbit.mesh.scheme.stage_rates / orbit.grid.width[:, None, None]
    start = local[..., 1 : 1 + n] * weights[:, :, :1, None]
    right = np.concatenate([local[..., :1], start, local[..., 1 + 2 * n :]], axis=3)
    stages = solve_stages(local, right, weights)
    steps = _steps(orbit, stages)
    return Condensed(orbit, steps, stages, algebraic.reshape(count, ncol, -1, width), residual)


def eliminate(rows: Rows, n: int) -> tuple[Array, Array]:
    """Eliminate the unknowns z point by point through the algebraic rows.

    Returns the differential rows without z, (points, n, w), and -dz as a map of the columns, (points, m, w).
    """
    unknown, columns = rows.d_algebraic, rows.columns
    if unknown.shape[2] == 0:
        return columns, columns[:, n:]
    if unknown.shape[2] == 1:
        if not unknown[:, n].all():
            raise np.linalg.LinAlgError("an algebraic row does not depend on its unknown")
        algebraic = columns[:, n:] / unknown[:, n:]
        return columns[:, :n] - unknown[:, :n] * algebraic, algebraic
    algebraic = np.linalg.solve(unknown[:, n:], columns[:, n:]).astype(float, copy=False)
    return columns[:, :n] - unknown[:, :n] @ algebraic, algebraic


def solve_stages(local: Array, right: Array, weights: Array) -> Array:
    """Solve each interval's rows for its stages: -right (N, ncol, n, w) over the stage matrix."""
    count, ncol, n, _ = local.shape
    by_rate, by_state = local[..., 1 : 1 + n], local[..., 1 + n : 1 + 2 * n]
    found = kinematic(by_rate, by_state)
    if found is not None:
        return solve(found, by_rate, by_state, right, weights[:, :, 1:])
    matrix = by_rate[:, :, :, None] * weights[:, :, None, 1:, None]
    each = np.arange(ncol)
    matrix[:, each, :, each, :] += np.moveaxis(by_state, 1, 0)
    size = ncol * n
    solution = np.linalg.solve(matrix.reshape(count, size, size), -right.reshape(count, size, -1))
    return solution.reshape(count, ncol, n, -1).astype(float, copy=False)


@dataclass(frozen=True)
class Rows:
    """The linearised equations at all points.

    columns (points, n+m, 1+2n+q): residual, d rate, d state, dy; d_algebraic (points, n+m, m).
    """

    columns: Array
    d_algebraic: Array


def linearised(system: System, orbit: Orbit, free: tuple[int, ...]) -> tuple[Rows, float]:
    """Linearise at the collocation points of an orbit; also the largest residual."""
    line = _evaluated(system, orbit, free)
    moving = _phase_columns(orbit, line.d_rate, line.d_phase)
    columns = [line.residual[:, :, None], line.d_rate, line.d_state, moving, line.d_parameter]
    return finite_rows(np.concatenate(columns, axis=2), line.d_algebraic)


def _evaluated(system: System, orbit: Orbit, free: tuple[int, ...]) -> LinearisationLike:
    """Residual and derivatives at the collocation points."""
    count, ncol, n = orbit.stages.shape
    rate = orbit.knot_rates[:, 1:]
    tau, stages = _before_kinks(orbit, rate)
    return system.linearise(
        rate.reshape(-1, n),
        stages.reshape(-1, n),
        orbit.algebraic.reshape(count * ncol, orbit.algebraic.shape[2]),
        tau.ravel(),
        orbit.parameter,
        free,
    )


def _before_kinks(orbit: Orbit, rate: Array) -> tuple[Array, Array]:
    """Phases and stages at which the equations are evaluated: the collocation points, BEFORE a kink.

    A collocation point on a kink (Radau, at the end of a segment) would otherwise take its derivatives from
    either side, as rounding has it.
    """
    tau, stages, ends = orbit.stage_phases, orbit.stages, orbit.mesh.exact_ends
    if len(ends) and orbit.mesh.scheme.points[-1] == 1.0:
        stages = stages.copy()
        tau[ends, -1] -= BEFORE
        stages[ends, -1] -= BEFORE * rate[ends, -1]
    return tau, stages


def finite_rows(columns: Array, d_algebraic: Array) -> tuple[Rows, float]:
    """Return rows and their largest residual. Raises FloatingPointError where they are not finite."""
    if not (np.isfinite(columns).all() and np.isfinite(d_algebraic).all()):
        raise FloatingPointError("the residual or a derivative is not finite")
    return Rows(columns, d_algebraic), float(np.abs(columns[:, :, 0]).max())


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
    if end[-1] == 1.0 and not end[:-1].any():
        steps = stages[:, -1].copy()
    else:
        steps = np.einsum("l,jlnw->jnw", end[1:], stages)
    steps[:, np.arange(n), 1 + np.arange(n)] += end[0]
    steps[:, :, 0] += end @ orbit.knots - orbit.nodes[1:]
    return steps
