"""Elimination of the stages, interval by interval, in NumPy or in C (condensation of parameters).

With y the event nodes' phases and the free parameters, what is left of interval j is an affine map

    dx_{j+1} = step[j] (1, dx_j, dy).

An interval moves with the phases of the event nodes at the two ends of its own segment alone, so that local
matrices have columns for no other phases.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.collocation.native.elimination import Routines, routines
from periodic.collocation.residual import eliminate, evaluated, rows_of
from periodic.events.impacts import applied, perturbed
from periodic.events.impacts import jumps as jumps_of
from periodic.linear.bordering import Chain
from periodic.linear.kinematic import kinematic, solve
from periodic.orbit.jump import Jump
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import LinearisationLike, System


@dataclass(frozen=True)
class EliminatedStages:
    """Maps from (1, dx_j, dy), width w = 1+n+k+p: step (N, n, w), of k phases and p parameters.

    Inside an interval only the e phases of `Mesh.ties` have columns, not all k: stages
    (N, ncol, n, 1+n+e+p), and algebraic (N, ncol, m, 1+2n+e+p), which maps (1, d rate, d state, dy) to -dz.
    residual: the largest one. jumps: where the state or its rates jump; arriving (jumps, n, w): the steps of
    these intervals without their jumps. Fulfils `periodic.linear.bordering.Eliminated`.
    """

    orbit: Orbit
    step: Array
    stages: Array
    algebraic: Array
    residual: float
    compiled: Routines | None = None
    jumps: Sequence[Jump] = ()
    arriving: Array | None = None

    @cached_property
    def perturbed(self) -> Array | None:
        """Steps (N, n, n+p) of perturbations at fixed tau, with saltation; None where nothing jumps.

        Raises numpy.linalg.LinAlgError where a jump has no rates.
        """
        return None if self.arriving is None else perturbed(self.orbit, self.step, self.arriving, self.jumps)

    @property
    def origin(self) -> NDArray[np.int_]:
        """Index of the mesh point from which each interval steps: the one before."""
        return np.arange(len(self.step))

    def reduced(self, row: Row) -> Row:
        """Return a row in mesh-point states and y alone, its stages eliminated."""
        if row.stages is None:
            return row
        n, k, ties = row.nodes.shape[1], len(self.orbit.phases), self.orbit.mesh.ties
        held = np.flatnonzero(row.stages.any(axis=(1, 2)))
        each = np.einsum("jln,jlnw->jw", row.stages[held], self.stages[held])
        nodes, outer, first = row.nodes.copy(), row.outer.copy(), 1 + n + ties.shape[1]
        nodes[held] += each[:, 1 : 1 + n]
        np.add.at(outer, ties[held], each[:, 1 + n : first])
        outer[k:] += each[:, first:].sum(axis=0)
        return Row(row.value + float(each[:, 0].sum()), nodes, outer)

    def recover(self, nodes: Array, outer: Array, constant: float) -> tuple[Array, Array]:
        """Return the increments of stages and unknowns that go with node increments and dy = `outer`."""
        orbit, (count, ncol, n) = self.orbit, self.orbit.stages.shape
        if self.compiled is not None:
            return self.compiled.recover(orbit, self.stages, self.algebraic, nodes, outer, constant)
        width, ties = self.stages.shape[3], orbit.mesh.ties
        further = np.broadcast_to(outer[len(orbit.phases) :], (count, len(outer) - len(orbit.phases)))
        own = np.concatenate([outer[ties], further], axis=1)
        given = np.empty((count, width, 1))
        given[:, 0, 0], given[:, 1 : 1 + n, 0], given[:, 1 + n :, 0] = constant, nodes[:-1], own
        stages = (self.stages.reshape(count, ncol * n, width) @ given).reshape(count, ncol, n)
        if orbit.algebraic.shape[2] == 0:
            return stages, np.zeros_like(orbit.algebraic)
        inner = np.empty((count, ncol, 1 + 2 * n + own.shape[1], 1))
        knots = np.concatenate([nodes[:-1, None, :], stages], axis=1)
        inner[..., 0, 0], inner[..., 1 + 2 * n :, 0] = constant, own[:, None]
        inner[..., 1 : 1 + n, 0] = orbit.mesh.scheme.stage_rates @ knots / orbit.grid.width[:, None, None]
        inner[..., 1 + n : 1 + 2 * n, 0] = stages
        return stages, -(self.algebraic @ inner)[..., 0]


def eliminate_stages(
    system: System, orbit: Orbit, line: LinearisationLike, jumps: Sequence[Jump] = ()
) -> EliminatedStages:
    """Eliminate all that is local from equations evaluated at an orbit's collocation points, with its jumps.

    Raises FloatingPointError where the equations are not finite, numpy.linalg.LinAlgError where a local
    matrix is singular.
    """
    smooth = _eliminate(system, orbit, line)
    if not jumps:
        return smooth
    arriving = smooth.step[[jump.interval for jump in jumps]]
    return replace(smooth, step=applied(orbit, smooth.step, jumps), jumps=jumps, arriving=arriving)


def _eliminate(system: System, orbit: Orbit, line: LinearisationLike) -> EliminatedStages:
    compiled = routines(system, line)
    if compiled is not None:
        return EliminatedStages(orbit, *compiled.eliminate_stages(orbit, line), compiled)
    rows = rows_of(orbit, line, tied=True)
    count, ncol, n = orbit.stages.shape
    reduced, algebraic = eliminate(rows, n)
    width = reduced.shape[2]
    local = reduced.reshape(count, ncol, n, width)
    weights = orbit.mesh.scheme.stage_rates / orbit.grid.width[:, None, None]
    start = local[..., 1 : 1 + n] * weights[:, :, :1, None]
    right = np.concatenate([local[..., :1], start, local[..., 1 + 2 * n :]], axis=3)
    stages = solve_stages(local, right, weights)
    steps = _spread(orbit, _steps(orbit, stages))
    return EliminatedStages(orbit, steps, stages, algebraic.reshape(count, ncol, -1, width), rows.residual)


def eliminated(system: System, orbit: Orbit, free: tuple[int, ...]) -> EliminatedStages:
    """Return the collocation equations at an orbit, linearised, without their stages.

    Raises as `eliminate_stages`.
    """
    return eliminate_stages(system, orbit, evaluated(system, orbit, free), jumps_of(system, orbit, free))


def elimination(
    system: System, orbit: Orbit, line: LinearisationLike, own: Sequence[Row], jumps: Sequence[Jump]
) -> Chain:
    """The linear solver of `Collocation` by default: stages eliminated, intervals chained and bordered."""
    return Chain(eliminate_stages(system, orbit, line, jumps), own)


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


def _steps(orbit: Orbit, stages: Array) -> Array:
    end, n = orbit.mesh.scheme.end, orbit.nodes.shape[1]
    if end[-1] == 1.0 and not end[:-1].any():
        steps = stages[:, -1].copy()
    else:
        steps = np.einsum("l,jlnw->jnw", end[1:], stages)
    steps[:, np.arange(n), 1 + np.arange(n)] += end[0]
    begin = orbit.nodes[:-1]
    steps[:, :, 0] += end[1:] @ (orbit.stages - begin[:, None]) + (begin - orbit.nodes[1:])
    return steps


def _spread(orbit: Orbit, steps: Array) -> Array:
    """Steps (N, n, 1+n+e+p) with the columns of all phases, shape (N, n, 1+n+k+p)."""
    (count, n, width), k, ties = steps.shape, len(orbit.phases), orbit.mesh.ties
    e = ties.shape[1]
    found = np.zeros((count, n, width - e + k))
    found[:, :, : 1 + n], found[:, :, 1 + n + k :] = steps[:, :, : 1 + n], steps[:, :, 1 + n + e :]
    np.put_along_axis(found[:, :, 1 + n : 1 + n + k], ties[:, None], steps[:, :, 1 + n : 1 + n + e], axis=2)
    return found
