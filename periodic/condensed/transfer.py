"""The equations of all intervals at once, joined by transfer matrices of modes and own states.

In an interval forces and own states u follow from what it begins with and from what moves it,

    D u = R (c, 1, dphi, dp),    c+ = T (c, 1, dphi, dp),

c the modes' real coordinates and the own states, dphi the phases of the two event nodes that bound its
segment. Newton's increment then needs neither the response of the whole period nor columns for event nodes
elsewhere (transfer matrices: Pestel & Leckie, Matrix Methods in Elastomechanics, 1963).
`periodic.condensed.recursion` follows the same equations column by column.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.carried import Carried
from periodic.condensed.coupled import Coupled
from periodic.condensed.memory import portions
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array


def pays(system: Coupled, coordinates: int) -> bool:
    """Return whether transfer matrices of so many coordinates take fewer operations than single columns.

    They join c by c blocks for the c + k columns of a period with k event nodes. A column needs two products
    with the m unknowns of an interval instead.
    """
    unknowns = system.ncol * (len(system.active) + len(system.others))
    columns = coordinates + len(system.columns)
    everywhere = len(system.others) > 0 or len(system.held) == system.intervals
    return everywhere and coordinates * (columns + unknowns) < 2 * unknowns * columns


class Transfer:
    """The equations of the intervals, and their motions as maps of (c_0, 1, dy).

    c_0 are the coordinates at the beginning of the period; dy phases of event nodes and free parameters.

    Parameters
    ----------
    system : Coupled
        The equations; how they are closed over the period is not read.
    kept : ndarray of int
        Coordinates among (Re z, Im z, s): without the imaginary parts of modes that do not oscillate.
    """

    def __init__(self, system: Coupled, kept: NDArray[np.int_]) -> None:
        given = system.given
        self.system, self.given, self.kept = system, given, kept
        self.orbit, self.ties = given.orbit, given.orbit.mesh.ties
        self.n, self.own, self.forces = system.n, len(system.others), system.ncol * len(system.active)
        self.size, self.modes = len(kept), len(kept) - self.own
        self.tied, self.k = self.ties.shape[1], len(given.orbit.phases)
        self.width = self.size + 1 + self.tied + len(given.changes)
        self.by_forces, self.by_given = self._states()
        self.unknowns = self._solved()

    def _states(self) -> tuple[Array, Array]:
        """States at the places and points by active forces, (N, a s, a k), and by the rest, (N, a s, w)."""
        given, system = self.given, self.system
        response, width = given.response, self.orbit.mesh.tie_gradients[1]
        count, points = self.orbit.stages.shape[:2]
        s, first = len(system.places), self.size + 1
        local = response.local
        whole = local.shape[4] == len(system.active)
        by_forces = local if whole else local[..., system.active]
        shown, (moved, _) = response.stage_outputs, given.within
        found = np.zeros((count, points, s, self.width))
        oscillating = self.kept[: self.modes] >= shown.shape[3]
        real = self.modes - int(oscillating.sum())
        found[..., :real] = shown.real
        np.negative(shown.imag[..., self.kept[real : self.modes] - real], out=found[..., real : self.modes])
        found[..., self.size] = given.missing
        found[..., first : first + self.tied] = moved[..., :1] * width[:, None, None, :]
        found[..., first + self.tied :] = moved[..., 1:]
        if system.passive.any():
            found[..., self.size :] += self._passive(local)
        return by_forces.reshape(count, points * s, -1), found.reshape(count, points * s, -1)

    def _driven(self) -> Array:
        """Forces that do not depend on the motion, as maps of (1, dphi, dp), (N, b k, w)."""
        system, rows = self.system, self.given.rows.forces
        columns = [0, *range(1 + 2 * self.n, rows.shape[2])]
        found = np.where(system.passive[:, :, None], rows[:, :, columns], 0.0)
        return np.asarray(found.reshape(system.intervals, -1, len(columns)))

    def _passive(self, local: Array) -> Array:
        """States at the points by these forces, (N, a, s, w)."""
        count, points, s = local.shape[:3]
        return np.asarray(
            (local.reshape(count, points * s, -1) @ self._driven()).reshape(count, points, s, -1)
        )

    def _solved(self) -> Array:
        """Active forces and own states of the intervals by (c, 1, dphi, dp), (N, m, w)."""
        count, points = self.orbit.stages.shape[:2]
        each = points * (len(self.system.active) + self.own)
        found = np.empty((count, each, self.width))
        for some in portions(count, each * (self.forces + self.width) * found.itemsize):
            found[some] = self._solved_on(some)
        if not np.isfinite(found).all():
            raise FloatingPointError("the equations of an interval are not finite")
        return found

    def _solved_on(self, some: slice) -> Array:
        """Those of some intervals."""
        system, given, n = self.system, self.given, self.n
        points, s, forces = self.orbit.stages.shape[1], len(system.places), len(system.active)
        here = slice(some.start * points, some.stop * points)
        rows = -given.rows.forces[here, system.active]
        if self.own:
            rows = np.concatenate([rows, given.rows.own[here]], axis=1)
        each = rows.shape[1]
        rows = rows.reshape(-1, points, each, rows.shape[2])
        count = len(rows)
        by_place = rows[..., [1 + n + k for k in system.places]]
        block = by_place @ self.by_forces[some].reshape(count, points, s, -1)
        right = by_place @ self.by_given[some].reshape(count, points, s, -1)
        right[..., self.size] += rows[..., 0]
        right[..., self.size + 1 :] += rows[..., 1 + 2 * n :]
        same, ones = np.arange(points), np.arange(forces)
        block[:, same[:, None], ones, same[:, None] * forces + ones] += 1.0
        width = self.orbit.grid.width[some]
        if self.own:
            self._begun(some, rows, right)
        carried = Carried.of(rows, system.others, n, forces) if self.own else None
        if carried is not None:
            rates = self.orbit.mesh.scheme.stage_rates[:, 1:]
            return carried.solved(block, right, rates, width).astype(float, copy=False)
        whole = np.concatenate([block, self._inside(rows, width)], axis=3) if self.own else block
        size = points * each
        found = np.linalg.solve(whole.reshape(count, size, size), -right.reshape(count, size, -1))
        return np.asarray(found.astype(float, copy=False))

    def _inside(self, rows: Array, width: Array) -> Array:
        """What own states at the points do there, (N, a, rows, a o)."""
        n, others = self.n, self.system.others
        count, points, each = rows.shape[:3]
        weights = self.orbit.mesh.scheme.stage_rates / width[:, None, None]
        inside = rows[..., 1 + others][:, :, :, None, :] * weights[:, :, None, 1:, None]
        same = np.arange(points)
        inside[:, same, :, same] += np.swapaxes(rows[..., 1 + n + others], 0, 1)
        return np.asarray(inside.reshape(count, points, each, -1))

    def _begun(self, some: slice, rows: Array, right: Array) -> None:
        """Add what own states do at the beginning, and where mesh points are no ends yet."""
        others, orbit = self.system.others, self.orbit
        weights = orbit.mesh.scheme.stage_rates / orbit.grid.width[some, None, None]
        begun = rows[..., 1 + others] * weights[:, :, None, :1]
        right[..., self.modes : self.size] += begun
        right[..., self.size] += np.einsum("nare,ne->nar", begun, self._gaps[some])

    @cached_property
    def _gaps(self) -> Array:
        """How far own states at the ends of intervals are from the mesh points, (N, o)."""
        stages, others = self.orbit.stages, self.system.others
        ends = np.concatenate([stages[-1:, -1], stages[:-1, -1]])
        return np.asarray((ends - self.orbit.nodes[:-1])[:, others])

    @cached_property
    def steps(self) -> Array:
        """Coordinates at the end of an interval by (c, 1, dphi, dp), (N, c, w)."""
        given, system = self.given, self.system
        response, (_, left) = given.response, given.within
        impulse, grown, modes = response.impulse, response.grown, self.kept[: self.modes]
        count, J = grown.shape
        found = np.zeros((count, self.size, self.width))
        by_force = impulse if impulse.shape[3] == len(system.active) else impulse[..., system.active]
        both = np.concatenate([by_force.real, by_force.imag], axis=1).reshape(count, 2 * J, -1)[:, modes]
        found[:, : self.modes] = both @ self.unknowns[:, : self.forces]
        turn = np.zeros((count, 2 * J, 2 * J))
        j = np.arange(J)
        turn[:, j, j], turn[:, j, J + j] = grown.real, -grown.imag
        turn[:, J + j, j], turn[:, J + j, J + j] = grown.imag, grown.real
        found[:, : self.modes, : self.modes] += turn[:, modes][:, :, modes]
        moved = np.concatenate([left.real, left.imag], axis=1)[:, modes]
        first, width = self.size + 1, self.orbit.mesh.tie_gradients[1]
        found[:, : self.modes, first : first + self.tied] += moved[..., :1] * width[:, None, :]
        found[:, : self.modes, first + self.tied :] += moved[..., 1:]
        if system.passive.any():
            whole = np.concatenate([impulse.real, impulse.imag], axis=1).reshape(count, 2 * J, -1)[:, modes]
            found[:, : self.modes, self.size :] += whole @ self._driven()
        if self.own:
            found[:, self.modes :] = self.unknowns[:, self.unknowns.shape[1] - self.own :]
        return found

    @cached_property
    def free(self) -> Array:
        """Coordinates at the end of an interval by those at its beginning, (N, c, c)."""
        return np.ascontiguousarray(self.steps[:, :, : self.size])

    @cached_property
    def motion(self) -> Array:
        """Coordinates at the mesh points by (c_0, 1, dy), (N+1, c, c + 1 + q)."""
        steps, first = self.steps, self.size + 1
        count = len(steps)
        found = np.zeros((count + 1, self.size, first + self.k + len(self.given.changes)))
        found[0, :, : self.size] = np.eye(self.size)
        each, last = np.arange(count)[:, None], first + self.tied
        found[1:, :, self.size] = steps[:, :, self.size]
        found[1 + each, :, first + self.ties] = np.swapaxes(steps[:, :, first:last], 1, 2)
        found[1:, :, first + self.k :] = steps[:, :, last:]
        for i, own in enumerate(self.free):
            found[i + 1] += own @ found[i]
        return found

    def rows(self, rows: Sequence[Row]) -> Array:
        """Return rows in the states as rows in (c_0, 1, dy), (r, c + 1 + q)."""
        return np.array([self._row(row) for row in rows]).reshape(len(rows), self.motion.shape[2])

    def _row(self, row: Row) -> Array:
        """A row in (c_0, 1, dy). The mesh points are ends of intervals, the first one that of the last."""
        orbit, first, points = self.orbit, self.size + 1, self.system.ncol
        ends = row.nodes[1:].copy()
        ends[-1] += row.nodes[0]
        held = ends.any(axis=1) if row.stages is None else ends.any(axis=1) | row.stages.any(axis=(1, 2))
        at = np.flatnonzero(held)
        if row.stages is None:
            weights, chosen = ends[at, None], slice(points - 1, points)
        else:
            weights, chosen = row.stages[at].copy(), slice(None)
            weights[:, -1] += ends[at]
        found = np.zeros(self.motion.shape[2])
        here = self._pulled(at, weights, chosen)
        found += np.tensordot(here[:, : self.size], self.motion[at], axes=2)
        gap = np.concatenate([orbit.stages[-1:, -1], orbit.stages[:, -1]]) - orbit.nodes
        found[self.size] += row.value + float(np.vdot(row.nodes, gap)) + here[:, self.size].sum()
        np.add.at(found, first + self.ties[at], here[:, first : first + self.tied])
        found[first + self.k :] += here[:, first + self.tied :].sum(axis=0)
        found[first:] += row.outer
        return found

    def _pulled(self, at: NDArray[np.int_], weights: Array, chosen: slice) -> Array:
        """Weights (R, b, n) of states at some points of some intervals as weights of (c, 1, dphi, dp)."""
        system, count = self.system, self.system.intervals
        s, own = len(system.places), self.own
        by_place = weights[:, :, system.places].reshape(len(at), 1, weights.shape[1] * s)
        maps = []
        for each in (self.by_forces, self.by_given):
            whole = each.reshape(count, system.ncol, s, -1)
            part = whole[:, chosen] if len(at) == count else whole[at, chosen]
            maps.append(part.reshape(len(at), weights.shape[1] * s, each.shape[2]))
        on = np.zeros((len(at), 1, self.unknowns.shape[1]))
        on[:, 0, : self.forces] = (by_place @ maps[0])[:, 0]
        if own:
            inside = on[:, 0, self.forces :].reshape(len(at), system.ncol, own)
            inside[:, chosen] = weights[:, :, system.others]
        solved = self.unknowns if len(at) == count else self.unknowns[at]
        return np.asarray((on @ solved + by_place @ maps[1])[:, 0])

    def states(self, begun: Array, constant: Array, outer: Array) -> Array:
        """Return the states at the points, (P, n, r), of c_0 (c, r), constants (r,) and dy (q, r)."""
        system, columns = self.system, len(constant)
        count, points, n = self.orbit.stages.shape
        moved = self.motion[:-1] @ np.concatenate([begun, constant[None], outer])
        given = np.empty((count, self.width, columns))
        given[:, : self.size], given[:, self.size] = moved, constant
        given[:, self.size + 1 : self.size + 1 + self.tied] = outer[self.ties]
        given[:, self.size + 1 + self.tied :] = outer[self.k :]
        solved = self.unknowns @ given
        found = np.empty((count, points, n, columns))
        places = self.by_forces @ solved[:, : self.forces] + self.by_given @ given
        found[:, :, system.places] = places.reshape(count, points, -1, columns)
        if self.own:
            found[:, :, system.others] = solved[:, self.forces :].reshape(count, points, -1, columns)
        return found.reshape(count * points, n, columns)
