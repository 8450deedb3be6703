"""The equations of what is nonlinear, the linear part put in: forces that depend on the motion, own states.

At each collocation point the system's rows give the forces, and the rates of its own states, in terms of all
states there; the states of the linear part are those that the forces of the whole period make,

    x_L = L f + dL,    f = F(x_L, s, tau, p),    s' = S(x_L, s, tau, p).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.linearised import Linearised
from periodic.condensed.moments import Complex
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array


class Coupled:
    """Equations matrix u = right (1, dy) of the forces that depend on the motion and the own states.

    u holds the active forces at the points (P ka), then the own states there (P o).

    Parameters
    ----------
    given : Linearised
        The system about its orbit.
    flexibility : ndarray, shape (P s, P k)
        What forces do to the states of the linear part.
    wraps : complex
        Own states at the beginning of the period in parts of those at its end: 1 in periodic motion, 0 where
        they begin with nothing.
    """

    def __init__(self, given: Linearised, flexibility: Array | Complex, *, wraps: complex) -> None:
        orbit, local = given.orbit, given.local
        self.given, self.flexibility, self.wraps = given, flexibility, wraps
        self.kind = np.result_type(flexibility, wraps)
        self.n = n = orbit.nodes.shape[1]
        self.places, self.others = list(given.part.states), given.others
        self.points, self.k = len(local.forces), local.forces.shape[1]
        by_motion = local.forces[:, :, 1 : 1 + 2 * n]
        self.active = np.flatnonzero(np.abs(by_motion).max(axis=(0, 2), initial=0.0) > 0)
        self.passive = np.setdiff1d(np.arange(self.k), self.active)
        self.count = self.points * len(self.active)
        self.size = self.count + self.points * len(self.others)
        self.columns = [0, *range(1 + 2 * n, local.forces.shape[2])]

    def _onto(self, chosen: NDArray[np.int_]) -> Array:
        """Columns of the flexibility for some of the forces, (P, s, P chosen)."""
        whole: Array = np.asarray(self.flexibility)
        shape = (self.points, len(self.places), self.points)
        return whole.reshape(*shape, self.k)[..., chosen].reshape(*shape[:2], self.points * len(chosen))

    @cached_property
    def _by_active(self) -> Array:
        return self._onto(self.active)

    @cached_property
    def affine(self) -> Array:
        """States of the linear part by (1, dy), forces that do not depend on them included: (P, s, 1+q)."""
        driven = self.given.local.forces[:, self.passive][:, :, self.columns]
        return self.given.affine + self._onto(self.passive) @ driven.reshape(
            self.points * len(self.passive), len(self.columns)
        )

    def _rate_blocks(self, rates: Array) -> Array:
        """Rows (P, r, o) that multiply the own states' rates, as rows in the own states, (P, r, P, o)."""
        orbit = self.given.orbit
        scheme, (count, points, _) = orbit.mesh.scheme, orbit.stages.shape
        weights = scheme.stage_rates / orbit.grid.width[:, None, None]
        shape = (count, points, rates.shape[1], count, points, len(self.others))
        found = np.zeros(shape, dtype=self.kind)
        local = rates.reshape(count, points, rates.shape[1], -1)
        each = np.arange(count)
        found[each, :, :, each] += np.einsum("naro,nab->narbo", local, weights[:, :, 1:])
        begun = np.einsum("naro,na->naro", local, weights[:, :, 0])
        found[each[1:], :, :, each[:-1], -1] += begun[1:]
        found[0, :, :, -1, -1] += self.wraps * begun[0]
        return found.reshape(self.points, rates.shape[1], self.points, -1)

    def _rows(self, rows: Array) -> tuple[Array, Array]:
        """Rows (P, r, w) of (1, d rate, d state, dy) as rows in u, and in (1, dy)."""
        n, others = self.n, self.others
        by_place = rows[:, :, [1 + n + k for k in self.places]]
        inner = np.zeros((self.points, rows.shape[1], self.size), dtype=self.kind)
        inner[:, :, : self.count] = by_place @ self._by_active
        outer = rows[:, :, self.columns] + by_place @ self.affine
        if len(others):
            own = self._rate_blocks(rows[:, :, 1 + others])
            each = np.arange(self.points)
            own[each, :, each] += rows[:, :, 1 + n + others]
            inner[:, :, self.count :] = own.reshape(self.points, rows.shape[1], -1)
            outer[:, :, 0] += self._gap(rows[:, :, 1 + others])
        return inner, outer

    def _gap(self, rates: Array) -> Array:
        """What rates (P, r, o) get where mesh points are not yet the ends of their intervals, (P, r)."""
        orbit = self.given.orbit
        count, points, _ = orbit.stages.shape
        gap = np.concatenate([orbit.stages[-1:, -1], orbit.stages[:-1, -1]]) - orbit.nodes[:-1]
        weights = orbit.mesh.scheme.stage_rates[:, 0] / orbit.grid.width[:, None]
        along = (weights[:, :, None] * gap[:, None, self.others]).reshape(self.points, -1)
        return np.asarray(np.einsum("pro,po->pr", rates, along))

    @cached_property
    def _assembled(self) -> tuple[Array, Array]:
        local = self.given.local
        inner, outer = self._rows(local.forces[:, self.active])
        matrix = np.zeros((self.size, self.size), dtype=self.kind)
        matrix[: self.count] = -inner.reshape(self.count, self.size)
        matrix[np.arange(self.count), np.arange(self.count)] += 1.0
        right = np.zeros((self.size, len(self.columns)), dtype=self.kind)
        right[: self.count] = outer.reshape(self.count, len(self.columns))
        if len(self.others):
            inner, outer = self._rows(local.own)
            matrix[self.count :] = inner.reshape(-1, self.size)
            right[self.count :] = -outer.reshape(-1, len(self.columns))
        return matrix, right

    @property
    def matrix(self) -> Array:
        """The equations, (size, size)."""
        return self._assembled[0]

    @property
    def right(self) -> Array:
        """Their right-hand sides by (1, dy), (size, 1+q)."""
        return self._assembled[1]

    def restricted(self, states: Array, outer: Array) -> tuple[Array, Array]:
        """Return a row in the states at the points (P, n) and (1, dy) as one in u and (1, dy)."""
        by_place = states[:, self.places].ravel()
        inner = np.zeros(self.size, dtype=self.kind)
        inner[: self.count] = by_place @ self._by_active.reshape(len(by_place), self.count)
        inner[self.count :] = states[:, self.others].ravel()
        return inner, outer + by_place @ self.affine.reshape(len(by_place), -1)

    def stages(self, inner: Array, given: Array) -> Array:
        """Return the states at the points, (P, n), of u and (1, dy)."""
        found = np.empty((self.points, self.n), dtype=np.result_type(self.kind, inner))
        found[:, self.places] = self._by_active @ inner[: self.count] + self.affine @ given
        found[:, self.others] = inner[self.count :].reshape(self.points, len(self.others))
        return found


def folded(orbit: Orbit, row: Row, wraps: float = 1.0) -> tuple[Array, Array]:
    """Return a row in the states at the points, (P, n), and in (1, dy); mesh points are ends of intervals.

    The first is `wraps` times the last.
    """
    stages = np.zeros_like(orbit.stages) if row.stages is None else row.stages.copy()
    stages[:, -1] += row.nodes[1:]
    stages[-1, -1] += wraps * row.nodes[0]
    gap = np.concatenate([wraps * orbit.stages[-1:, -1], orbit.stages[:, -1]]) - orbit.nodes
    value = row.value + float(np.vdot(row.nodes, gap))
    return stages.reshape(-1, orbit.nodes.shape[1]), np.append(value, row.outer)
