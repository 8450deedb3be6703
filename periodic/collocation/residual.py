"""Collocation equations: the residual at the collocation points, linearised, with the unknowns z eliminated.

At each collocation point R(x', x, z, tau, p) = 0 with x' the polynomial's derivative. The unknowns z are
eliminated point by point through the algebraic rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.events.modes import linearise, sides
from periodic.events.thresholds import SAME_PHASE
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import LinearisationLike, System


@dataclass(frozen=True)
class Rows:
    """The linearised equations at all points.

    columns (points, n+m, 1+2n+q): residual, d rate, d state, dy; d_algebraic (points, n+m, m).
    """

    columns: Array
    d_algebraic: Array

    @property
    def residual(self) -> float:
        """The largest residual."""
        return float(np.abs(self.columns[:, :, 0]).max())


@dataclass(frozen=True, eq=False)
class Evaluated:
    """Residual and derivatives at the collocation points of an orbit, as `LinearisationLike` has them.

    They are computed for all intervals when first asked for; or for some intervals at a time, where all of
    them would take too much memory.
    """

    system: System
    orbit: Orbit
    free: tuple[int, ...]

    def part(self, intervals: slice) -> LinearisationLike:
        """Return them for the points of consecutive intervals."""
        system, orbit, (count, ncol, n) = self.system, self.orbit, self.orbit.stages.shape
        begin, end, _ = intervals.indices(count)
        tau, stages = self._places
        rate = orbit.knot_rates[begin:end, 1:].reshape(-1, n)
        unknowns = orbit.algebraic[begin:end].reshape(len(rate), orbit.algebraic.shape[2])
        at = rate, stages[begin:end].reshape(-1, n), unknowns, tau[begin:end].ravel(), orbit.parameter
        line = linearise(system, at, np.repeat(sides(system, orbit)[begin:end], ncol, axis=0), self.free)
        exact = orbit.mesh.exact_ends
        ends = (exact[(exact >= begin) & (exact < end)] - begin) * ncol + ncol - 1
        if len(ends) and orbit.mesh.scheme.points[-1] == 1.0:
            if line.d_state.shape[1:] != (line.residual.shape[1], n):
                return line  # it is refused where stages are eliminated
            late = line.d_phase[ends] + np.einsum("pij,pj->pi", line.d_state[ends], rate[ends])
            line.residual[ends] += SAME_PHASE * late
        return line

    @cached_property
    def _places(self) -> tuple[Array, Array]:
        return _before_kinks(self.orbit, self.orbit.knot_rates[:, 1:])

    @cached_property
    def _whole(self) -> LinearisationLike:
        return self.part(slice(None))

    @property
    def residual(self) -> Array:
        """R, shape (points, n+m)."""
        return self._whole.residual

    @property
    def d_rate(self) -> Array:
        """Its derivative in x', shape (points, n+m, n)."""
        return self._whole.d_rate

    @property
    def d_state(self) -> Array:
        """Its derivative in x, shape (points, n+m, n)."""
        return self._whole.d_state

    @property
    def d_algebraic(self) -> Array:
        """Its derivative in z, shape (points, n+m, m)."""
        return self._whole.d_algebraic

    @property
    def d_phase(self) -> Array:
        """Its derivative in tau, shape (points, n+m)."""
        return self._whole.d_phase

    @property
    def d_parameter(self) -> Array:
        """Its derivatives in the free parameters, shape (points, n+m, q)."""
        return self._whole.d_parameter


def evaluated(system: System, orbit: Orbit, free: tuple[int, ...]) -> Evaluated:
    """Return residual and derivatives at the collocation points of an orbit, interval by interval."""
    return Evaluated(system, orbit, free)


def _before_kinks(orbit: Orbit, rate: Array) -> tuple[Array, Array]:
    """Phases and stages at which the equations are evaluated: those of the collocation points.

    A collocation point on a kink (Radau, at the end of a segment) is taken SAME_PHASE earlier: else rounding
    would decide from which side its derivatives are. `Evaluated.part` corrects the residual to first order.
    """
    tau, stages, ends = orbit.stage_phases, orbit.stages, orbit.mesh.exact_ends
    if len(ends) and orbit.mesh.scheme.points[-1] == 1.0:
        stages = stages.copy()
        tau[ends, -1] -= SAME_PHASE
        stages[ends, -1] -= SAME_PHASE * rate[ends, -1]
    return tau, stages


def rows_of(orbit: Orbit, line: LinearisationLike, tied: bool = False) -> Rows:
    """Return the rows of evaluated equations, with columns for the event nodes' phases.

    tied: columns only for the two event nodes that bound each interval's segment, `Mesh.ties`; the interval
    does not depend on the others.
    Raises FloatingPointError where they are not finite.
    """
    gradients = orbit.mesh.tie_gradients if tied else orbit.mesh.gradients
    moving = _phase_columns(orbit, line.d_rate, line.d_phase, *gradients)
    columns = [line.residual[:, :, None], line.d_rate, line.d_state, moving, line.d_parameter]
    return finite(Rows(np.concatenate(columns, axis=2), line.d_algebraic))


def finite(rows: Rows) -> Rows:
    """Return the rows. Raises FloatingPointError where they are not finite."""
    if not (np.isfinite(rows.columns).all() and np.isfinite(rows.d_algebraic).all()):
        raise FloatingPointError("the residual or a derivative is not finite")
    return rows


def _phase_columns(
    orbit: Orbit, d_rate: Array, d_phase: Array, left_gradient: Array, width_gradient: Array
) -> Array:
    """Derivatives of the rows in event nodes' phases (N, k), which move and stretch the intervals."""
    points, k = orbit.mesh.scheme.points, left_gradient.shape[1]
    if k == 0:
        return np.zeros((*d_phase.shape, 0))
    shift = left_gradient[:, None, :] + width_gradient[:, None, :] * points[:, None]
    stretch = np.repeat(width_gradient / orbit.grid.width[:, None], len(points), axis=0)
    rate = orbit.knot_rates[:, 1:].reshape(len(d_phase), -1, 1)
    return d_phase[:, :, None] * shift.reshape(len(d_phase), 1, k) - (d_rate @ rate) * stretch[:, None, :]


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
