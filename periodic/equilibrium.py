"""The equations of an equilibrium, 0 = R(0, x, z, p), linearised, and one Newton step on them.

With R_x' dx' + R_x dx + R_z dz = 0 small motion is dx' = J dx, J the upper part of -[R_x' R_z]^-1 R_x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.closure import Closure, Direction
from periodic.newton import Outcome, Step, moved, sizes
from periodic.orbit import Orbit
from periodic.scheme import Array
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


def increment(
    system: System, orbit: Orbit, free: tuple[int, ...], closures: Sequence[Closure]
) -> Step | Outcome:
    """Return one Newton step for state, unknowns and free parameters, or why there is none."""
    n = orbit.nodes.shape[1]
    try:
        rows = rows_at(system, orbit, free)
        border = [_flat(closure, system, orbit, free) for closure in closures]
        matrix = np.vstack([rows.d_unknown, *(gradient for _, gradient in border)])
        right = np.zeros((len(matrix), 2))
        right[:, 0] = -np.append(rows.residual, [value for value, _ in border])
        right[-1, 1] = 1.0
        solution, kernel = np.linalg.solve(matrix, right).T
        jacobian = rows.jacobian
    except FloatingPointError:
        return Outcome.NOT_FINITE
    except np.linalg.LinAlgError:
        return Outcome.SINGULAR
    step = direction(orbit, solution, 0)
    change = moved(system, orbit.algebraic, step.algebraic) - orbit.algebraic
    outer = solution[len(rows.residual) :]
    unit = np.abs(rows.d_unknown[:, :n]).max()
    effect = np.abs(rows.d_unknown[:, len(rows.residual) :]).max(axis=0) / unit if unit else 0 * outer
    size, length = sizes(orbit, step.nodes, step.stages, change, outer, free, effect, system.nominal)
    along = direction(orbit, kernel, len(free)) if free else None
    residual = float(np.abs(rows.residual).max())
    return Step(
        orbit, step.nodes, step.stages, step.algebraic, outer, size, length, residual, jacobian[None], along
    )


def _flat(closure: Closure, system: System, orbit: Orbit, free: tuple[int, ...]) -> tuple[float, Array]:
    """A closure's value and its gradient in (x, z, p)."""
    row = closure.linearise(system, orbit, free)
    state = row.nodes.sum(axis=0)
    algebraic = np.zeros(orbit.algebraic.shape[2])
    if row.stages is not None:
        state = state + row.stages.sum(axis=(0, 1))
    return row.value, np.concatenate([state, algebraic, row.outer])


def direction(orbit: Orbit, vector: Array, free: int) -> Direction:
    """Return (x, z, p) as a direction of constant orbits; p holds the `free` free parameters, or none."""
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    nodes = np.broadcast_to(vector[:n], orbit.nodes.shape)
    outer = vector[n + m :] if free else np.zeros(1)
    return Direction(
        nodes=nodes,
        stages=np.broadcast_to(vector[:n], orbit.stages.shape),
        algebraic=np.broadcast_to(vector[n : n + m], orbit.algebraic.shape),
        phases=np.zeros(0),
        profile=nodes,
        parameter=float(outer[0]),
        others=outer[1:],
    )
