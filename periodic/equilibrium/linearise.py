"""The equations of an equilibrium, 0 = R(0, x, z, p), linearised.

With R_x' dx' + R_x dx + R_z dz = 0 small motion is dx' = J dx, J the upper part of -[R_x' R_z]^-1 R_x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.linear import bordered
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System

CROSSING = 1e-4
"""Least singular value of R_u, as a part of the largest, up to which two branches cross."""


@dataclass(frozen=True)
class Rows:
    """The equations at an equilibrium: residual (n+m,), derivatives in x' (n+m, n) and in the
    unknowns (x, z, p), (n+m, n+m+q).
    """

    residual: Array
    d_rate: Array
    d_unknown: Array

    @cached_property
    def d_motion(self) -> Array:
        """Derivatives in (x', z), shape (n+m, n+m)."""
        return np.hstack([self.d_rate, self.d_unknown[:, self.d_rate.shape[1] : len(self.residual)]])

    @cached_property
    def _rates(self) -> Array:
        """(x', z) as a map of x, shape (n+m, n). Raises numpy.linalg.LinAlgError where not determined."""
        n = self.d_rate.shape[1]
        return np.linalg.solve(self.d_motion, -self.d_unknown[:, :n]).astype(float, copy=False)

    @property
    def jacobian(self) -> Array:
        """J per unit of tau, shape (n, n). Raises numpy.linalg.LinAlgError where x' is not determined."""
        return self._rates[: self.d_rate.shape[1]]

    @property
    def unknowns(self) -> Array:
        """dz = U dx in small motion, shape (m, n)."""
        return self._rates[self.d_rate.shape[1] :]

    def balanced(self, scale: float) -> Array:
        """Derivatives in u = (x, z, p / scale), every row over its length in (x', z)."""
        lengths = np.linalg.norm(self.d_motion, axis=1)
        columns = np.ones(self.d_unknown.shape[1])
        columns[len(self.residual) :] = scale
        return self.d_unknown / lengths[:, None] * columns


def crossing(matrix: Array) -> bool:
    """Whether derivatives in u have a kernel of more than one dimension, so that branches cross."""
    sizes = np.linalg.svd(matrix, compute_uv=False)
    return bool(sizes[-1] < CROSSING * (sizes[0] if len(sizes) > 1 else 1.0))


def rows_at(system: System, orbit: Orbit, free: tuple[int, ...], rate: Array | None = None) -> Rows:
    """Linearise at an equilibrium, or beside one where x' is `rate` (n,).

    Raises FloatingPointError where the equations are not finite.
    """
    state, algebraic = orbit.nodes[:1], orbit.algebraic[:1, 0]
    moving = np.zeros_like(state) if rate is None else rate[None]
    line = system.linearise(moving, state, algebraic, np.zeros(1), orbit.parameter, free)
    unknown = np.concatenate([line.d_state, line.d_algebraic, line.d_parameter], axis=2)[0]
    if not all(np.isfinite(values).all() for values in (line.residual, line.d_rate, unknown)):
        raise FloatingPointError("the residual or a derivative is not finite")
    return Rows(line.residual[0], line.d_rate[0], unknown)


@dataclass(frozen=True)
class Constant:
    """The equations of an equilibrium, see `periodic.linear.operator.Operator`."""

    orbit: Orbit
    rows: Rows

    @property
    def residual(self) -> float:
        """The largest residual."""
        return float(np.abs(self.rows.residual).max())

    @property
    def fundamental(self) -> Array:
        """J per unit of tau, shape (1, n, n). Raises numpy.linalg.LinAlgError where x' is not determined."""
        return self.rows.jacobian[None]

    @property
    def effect(self) -> Array:
        """About how much the states change with each free parameter, shape (q,)."""
        rows, n = self.rows, self.orbit.nodes.shape[1]
        unit = np.abs(rows.d_unknown[:, :n]).max()
        effect = np.abs(rows.d_unknown[:, len(rows.residual) :]).max(axis=0)
        return np.asarray(effect / unit if unit else 0 * effect)

    def solve(self, rows: Sequence[Row], right: Array) -> tuple[Increment, ...]:
        """Return an increment for each column of `right`, shape (1 + len(rows), columns).

        Raises numpy.linalg.LinAlgError where the bordered matrix is singular.
        """
        own = np.column_stack([self.rows.residual, self.rows.d_unknown])
        border = [np.append(row.value, flat(self.orbit, row)) for row in rows]
        return tuple(direction(self.orbit, u) for u in bordered.solve(np.vstack([own, *border]), right).T)


def flat(orbit: Orbit, row: Row) -> Array:
    """Return a row's gradient in (x, z, p) of an equilibrium."""
    state = row.nodes.sum(axis=0)
    if row.stages is not None:
        state = state + row.stages.sum(axis=(0, 1))
    return np.concatenate([state, np.zeros(orbit.algebraic.shape[2]), row.outer])


def linearise(system: System, orbit: Orbit, free: tuple[int, ...]) -> Constant:
    """Linearise the equations at an equilibrium, in its unknowns and the parameters `free`."""
    return Constant(orbit, rows_at(system, orbit, free))


def direction(orbit: Orbit, vector: Array) -> Increment:
    """Return (x, z, p) as an increment of constant orbits."""
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    nodes = np.broadcast_to(vector[:n], orbit.nodes.shape)
    stages = np.broadcast_to(vector[:n], orbit.stages.shape)
    algebraic = np.broadcast_to(vector[n : n + m], orbit.algebraic.shape)
    return Increment(nodes, stages, algebraic, np.zeros(0), vector[n + m :], nodes)
