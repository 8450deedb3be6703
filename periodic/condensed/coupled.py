"""The equations of forces that depend on the motion and of own states, the linear part eliminated.

At each collocation point the system's rows give the forces, and the rates of its own states, in terms of all
states there; the states of the linear part follow from the forces of the whole period,

    x_L = L f + dL,    f = F(x_L, s, tau, p),    s' = S(x_L, s, tau, p).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.modal.flexibility import Flexibility
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array


class Coupled:
    """Equations matrix u = right (1, dy) of the forces that depend on the motion and the own states.

    u holds the active forces at the points of the intervals where they are (C a ka), then the own states at
    all points (P o). Where no force depends on the motion, as outside a contact, forces are no unknowns.

    Parameters
    ----------
    given : SplitLinearisation
        The system about its orbit.
    flexibility : Flexibility
        The map from forces to the states of the linear part.
    wraps : complex
        Own states at the beginning of the period over those at its end: 1 in periodic motion, 0 where they
        begin at 0.
    """

    def __init__(self, given: SplitLinearisation, flexibility: Flexibility, *, wraps: complex) -> None:
        orbit, local = given.orbit, given.rows
        self.given, self.flexibility, self.wraps = given, flexibility, wraps
        self.kind = np.result_type(float if flexibility.real else complex, wraps)
        self.n = n = orbit.nodes.shape[1]
        self.places, self.others = list(given.part.states), given.others
        self.intervals, self.ncol = orbit.stages.shape[:2]
        self.points, self.k = len(local.forces), local.forces.shape[1]
        by_motion = np.abs(local.forces[:, :, 1 : 1 + 2 * n]).max(axis=2, initial=0.0)
        self.active = np.flatnonzero(by_motion.max(axis=0, initial=0.0))
        self.held = np.flatnonzero(by_motion.reshape(self.intervals, -1).max(axis=1, initial=0.0))
        self.at = (self.held[:, None] * self.ncol + np.arange(self.ncol)).ravel()
        self.count = len(self.at) * len(self.active)
        self.size = self.count + self.points * len(self.others)
        phases = orbit.mesh.ties.shape[1] if local.tied else len(orbit.phases)
        more = local.forces.shape[2] - phases + len(orbit.phases)
        self.columns = [0, *range(1 + 2 * n, more)]

    @cached_property
    def _own(self) -> bool:
        """Whether there are own states: their rows are everywhere."""
        return len(self.others) > 0

    @cached_property
    def coupled_states(self) -> NDArray[np.int_]:
        """Which of the linear part's states forces depend on; all of them where there are own states."""
        if self._own:
            return np.arange(len(self.places))
        by_place = self.given.local.forces[:, :, [1 + self.n + place for place in self.places]]
        return np.flatnonzero(by_place.any(axis=(0, 1)))

    def _by_active(self) -> Array:
        """Flexibility from active forces to coupled states at points with equations: (R, s, C a ka)."""
        if self.count == 0:
            return np.zeros((self.points, len(self.coupled_states), 0))
        found = self.flexibility.part(self.coupled_states, self.active, self.held, everywhere=self._own)
        return np.asarray(found.reshape(-1, len(self.coupled_states), self.count))

    @cached_property
    def _rows_of_forces(self) -> Array:
        """Rows of the active forces, (C a, ka, w)."""
        return self.given.local.forces[self.at[:, None], self.active]

    @cached_property
    def passive(self) -> NDArray[np.bool_]:
        """Whether a force at a point is none of the unknowns, (P, k)."""
        found = np.ones((self.points, self.k), dtype=bool)
        found[self.at[:, None], self.active] = False
        return found

    @cached_property
    def affine(self) -> Array:
        """States of the linear part as a map of (1, dy), passive forces included: (P, s, 1+q)."""
        if not self.passive.any():
            return self.given.affine
        driven = np.where(self.passive[:, :, None], self.given.local.forces[:, :, self.columns], 0.0)
        if not driven.any():
            return self.given.affine
        shape = (self.intervals, self.ncol, self.k, len(self.columns))
        states = self.flexibility.applied(driven.reshape(shape))
        return np.asarray(self.given.affine + states.reshape(self.given.affine.shape))

    def forces(self, u: Array) -> Array:
        """Return the forces at the points, (N, a, k, r), of unknowns (size, r)."""
        found = np.zeros((self.points, self.k, u.shape[1]), dtype=np.result_type(self.kind, u))
        found[self.at[:, None], self.active] = u[: self.count].reshape(
            len(self.at), len(self.active), u.shape[1]
        )
        return found.reshape(self.intervals, self.ncol, self.k, u.shape[1])

    def asked(self, states: Array) -> Array:
        """Return the active forces (C a ka, r) due to states (C a, s, r) at the places."""
        by_place = self._rows_of_forces[:, :, [1 + self.n + place for place in self.places]]
        return np.asarray((by_place @ states).reshape(self.count, states.shape[2]))

    def _rate_blocks(self, rates: Array, at: NDArray[np.int_]) -> Array:
        """Rows (R, r, o) that multiply the own states' rates, as rows in the own states, (R, r, P, o)."""
        orbit = self.given.orbit
        weights = (orbit.mesh.scheme.stage_rates / orbit.grid.width[:, None, None]).reshape(self.points, -1)
        found = np.zeros((*rates.shape[:2], self.intervals, self.ncol, len(self.others)), dtype=self.kind)
        each, interval = np.arange(len(at)), at // self.ncol
        found[each, :, interval] += np.einsum("pro,pb->prbo", rates, weights[at, 1:])
        begun = np.einsum("pro,p->pro", rates, weights[at, 0])
        first = interval == 0
        found[each[~first], :, interval[~first] - 1, -1] += begun[~first]
        found[each[first], :, -1, -1] += self.wraps * begun[first]
        return found.reshape(*rates.shape[:2], self.points, -1)

    def _inner(self, rows: Array, at: NDArray[np.int_], response: Array) -> Array:
        """Rows at some points, (R, r, w) of (1, d rate, d state, dy), as rows in u, (R r, size).

        response: states that are coupled there to the active forces, (R, s, C a ka).
        """
        n, others = self.n, self.others
        by_place = rows[:, :, [1 + n + self.places[k] for k in self.coupled_states]]
        inner = by_place @ response
        if len(others):
            own = self._rate_blocks(rows[:, :, 1 + others], at)
            own[np.arange(len(at)), :, at] += rows[:, :, 1 + n + others]
            inner = np.concatenate([inner, own.reshape(*inner.shape[:2], -1)], axis=2)
        return np.asarray(inner.reshape(inner.shape[0] * inner.shape[1], self.size))

    def _outer(self, rows: Array, at: NDArray[np.int_]) -> Array:
        """Rows as in `_inner`, as rows in (1, dy), (R r, 1+q)."""
        by_place = rows[:, :, [1 + self.n + k for k in self.places]]
        outer = rows[:, :, self.columns] + by_place @ self.affine[at]
        if len(self.others):
            outer[:, :, 0] += self._gap(rows[:, :, 1 + self.others], at)
        return np.asarray(outer.reshape(outer.shape[0] * outer.shape[1], outer.shape[2]))

    def _gap(self, rates: Array, at: NDArray[np.int_]) -> Array:
        """Constants of rows in rates (R, r, o), as mesh points are not yet ends of intervals, (R, r)."""
        orbit = self.given.orbit
        gap = np.concatenate([orbit.stages[-1:, -1], orbit.stages[:-1, -1]]) - orbit.nodes[:-1]
        weights = orbit.mesh.scheme.stage_rates[:, 0] / orbit.grid.width[:, None]
        along = (weights[:, :, None] * gap[:, None, self.others]).reshape(self.points, -1)
        return np.asarray(np.einsum("pro,po->pr", rates, along[at]))

    @cached_property
    def matrix(self) -> Array:
        """The equations, (size, size)."""
        return self.assembled()

    def assembled(self) -> Array:
        """Return the equations without keeping them."""
        matrix, response = np.empty((self.size, self.size), dtype=self.kind), self._by_active()
        here = response[self.at] if len(self.at) < len(response) else response
        np.negative(self._inner(self._rows_of_forces, self.at, here), out=matrix[: self.count])
        matrix[np.arange(self.count), np.arange(self.count)] += 1.0
        if len(self.others):
            matrix[self.count :] = self._inner(self.given.local.own, np.arange(self.points), response)
        return matrix

    @cached_property
    def right(self) -> Array:
        """The right-hand sides as a map of (1, dy), (size, 1+q)."""
        right = self._outer(self._rows_of_forces, self.at)
        if len(self.others):
            right = np.concatenate([right, -self._outer(self.given.local.own, np.arange(self.points))])
        return right

    def restricted(self, rows: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
        """Return rows in the states at the points (P, n) and (1, dy) as rows in u and in (1, dy)."""
        states = np.array([row[0] for row in rows]).reshape(len(rows), self.points, self.n)
        outer = np.array([row[1] for row in rows]).reshape(len(rows), len(self.columns))
        by_place = np.ascontiguousarray(states[:, :, self.places].transpose(1, 2, 0))
        weights = self.flexibility.pulled(by_place.reshape(self.intervals, self.ncol, *by_place.shape[1:]))
        weights = weights.reshape(self.points, self.k, len(rows))[self.at[:, None], self.active]
        own = states[:, :, self.others].reshape(len(rows), self.points * len(self.others))
        inner = [weights.reshape(self.count, len(rows)).T, own]
        outer = outer + np.tensordot(by_place, self.affine, axes=([0, 1], [0, 1]))
        return np.concatenate(inner, axis=1), outer

    def stages(self, inner: Array, given: Array) -> Array:
        """Return the states at the points, (P, n, r), of u (size, r) and (1, dy), (1+q, r)."""
        found = np.empty((self.points, self.n, inner.shape[1]), dtype=np.result_type(self.kind, inner))
        made = self.flexibility.applied(self.forces(inner))
        found[:, self.places] = made.reshape(self.points, -1, inner.shape[1]) + self.affine @ given
        found[:, self.others] = inner[self.count :].reshape(self.points, len(self.others), inner.shape[1])
        return found


def folded(orbit: Orbit, row: Row, wraps: float = 1.0) -> tuple[Array, Array]:
    """Return a row in the states at the points, (P, n), and in (1, dy); mesh points are ends of intervals.

    The first mesh point is `wraps` times the last.
    """
    stages = np.zeros_like(orbit.stages) if row.stages is None else row.stages.copy()
    stages[:, -1] += row.nodes[1:]
    stages[-1, -1] += wraps * row.nodes[0]
    gap = np.concatenate([wraps * orbit.stages[-1:, -1], orbit.stages[:, -1]]) - orbit.nodes
    value = row.value + float(np.vdot(row.nodes, gap))
    return stages.reshape(-1, orbit.nodes.shape[1]), np.append(value, row.outer)
