"""The equations of an invariant curve of the map over a period T, x(0) -> x(T), and their solution.

The curve u(theta), theta in [0, 2 pi), is given by its values at M angles (`grid`), equispaced and an odd
number where it is smooth. On a torus the map P turns it by the angle rho:

    P(u(theta_j - rho)) = u(theta_j),   sum_j w_j (u_j - v_j) . v'_j = 0,

the second a phase condition with the curve v before (Schilder, Osinga & Vogt, SIAM J. Appl. Dyn. Syst.
4 (2005) 459-488; Kuznetsov, Elements of Applied Bifurcation Theory, 7.3). T is the period of the excitation;
where there is none it is unknown too, and sum_j (u_j - v_j) . f(v_j) = 0 holds the phase along the flow f.
Events are those of the motions: contacts, impacts and friction are crossed where they happen.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.system import System
from periodic.system.ensembles import FOLLOWED
from periodic.system.precision import MOST_ITERATIONS
from periodic.tori.section import Section

DIFFERENCE = 1e-5
"""Step of differences in the period and in a parameter, as a part of their sizes."""

STEP = 1e-6
"""Phase (rad) by which a motion goes on for its rates."""

FAR = 1e3
"""By how much equations are off where Newton's method has lost the torus."""


@dataclass(frozen=True, eq=False)
class Invariance:
    """The equations in the M n states, rho, T of a free torus, and one parameter, whose index is `free`.

    tolerance: of the integration. scale: of the parameter, in which its steps are measured. released: the
    index of another parameter that is unknown in place of rho, which stays.
    """

    system: System
    free: int
    tolerance: float
    scale: float = 1.0
    released: int | None = None

    def linearise(self, torus: Section) -> tuple[Array, Array]:
        """Return the residual (M n,) and its derivatives (M n, M n + k). Raises ArithmeticError.

        k: rho, T where it is free, and the parameter.
        """
        count, n = torus.states.shape
        back, slope = torus.grid.interpolation(torus.grid.angles - torus.rotation)
        before = back @ torus.states
        images, slopes = self.mapped(torus, before)
        residual = (images - torus.states).ravel()
        moved = np.einsum("jk,jab->jakb", back, slopes).reshape(count * n, count * n)
        if self.released is None:
            columns = [-np.einsum("jab,jb->ja", slopes, slope @ torus.states).ravel()]
        else:
            columns = [self._by_parameter(torus, before, self.released, 1.0).ravel()]
        if torus.free:
            columns.append(self._by_period(torus, before).ravel())
        columns.append(self._by_parameter(torus, before, self.free, self.scale).ravel())
        return residual, np.column_stack([moved - np.eye(count * n), *columns])

    def mapped(self, torus: Section, states: Array) -> tuple[Array, Array]:
        """Return the images of states (K, n), and the derivatives of a torus's map there, (K, n, n)."""
        crowd, n = self._crowd(torus.parameter), states.shape[1]
        y = crowd.begin(states)
        found = crowd.run(y, 1, torus.period, tangents=crowd.tangents(y), raw=True)
        if (found.outcome != FOLLOWED).any() or not np.isfinite(found.tangents).all():
            raise ArithmeticError("a motion on the torus cannot be followed")
        return found.ends[:, :n], np.swapaxes(found.tangents[:, :, :n], 1, 2)

    def rates(self, torus: Section) -> Array:
        """Return dx/dtau at the states, (M, n)."""
        ends = [self._ends(torus.states, torus.parameter, side * STEP) for side in (1, 0)]
        return (ends[0] - ends[1]) / STEP

    def _by_period(self, torus: Section, before: Array) -> Array:
        """Derivative of the images of states (M, n) in T, (M, n)."""
        step = DIFFERENCE * torus.period
        ends = [self._ends(before, torus.parameter, torus.period + s * step) for s in (1, -1)]
        return (ends[0] - ends[1]) / (2 * step)

    def _by_parameter(self, torus: Section, before: Array, which: int, scale: float) -> Array:
        """Derivative of the images of states (M, n) in a parameter over its scale, (M, n)."""
        value = torus.parameter[which]
        step = DIFFERENCE * max(abs(value), 1e-3 * scale)
        ends = []
        for side in (1, -1):
            parameter = torus.parameter.copy()
            parameter[which] = value + side * step
            ends.append(self._ends(before, parameter, torus.period))
        return (ends[0] - ends[1]) / (2 * step) * scale

    def _ends(self, states: Array, parameter: Array, stretch: float) -> Array:
        """Where states are after a stretch."""
        if stretch == 0:
            return states
        crowd = self._crowd(parameter)
        found = crowd.run(crowd.begin(states), 1, stretch)
        if (found.outcome != FOLLOWED).any():
            raise ArithmeticError("a motion on the torus cannot be followed")
        return found.ends[:, : states.shape[1]]

    def _crowd(self, parameter: Array) -> Crowd:
        return Crowd(self.system, parameter, self.tolerance)


@dataclass(frozen=True, eq=False)
class Unknowns:
    """All unknowns of a torus as one array: states, rho, T where it is free, the parameter over its scale.

    In place of rho a parameter that is released.
    """

    equations: Invariance
    like: Section

    def of(self, torus: Section) -> Array:
        """Return the array of a torus."""
        released = self.equations.released
        first = torus.rotation if released is None else torus.parameter[released]
        last = [first, *([torus.period] if torus.free else [])]
        value = torus.parameter[self.equations.free] / self.equations.scale
        return np.concatenate([torus.states.ravel(), [*last, value]])

    def torus(self, values: Array) -> Section:
        """Return the torus of an array."""
        parameter, count = self.like.parameter.copy(), self.like.states.size
        parameter[self.equations.free] = values[-1] * self.equations.scale
        states, released = values[:count].reshape(self.like.states.shape), self.equations.released
        if released is not None:
            parameter[released] = values[count]
        return replace(
            self.like,
            states=states,
            rotation=float(values[count]) if released is None else self.like.rotation,
            period=float(values[count + 1]) if self.like.free else self.like.period,
            parameter=parameter,
            residual=np.inf,
            tail=self.like.grid.tail(states),
        )

    @cached_property
    def weights(self) -> Array:
        """Weights in the arclength: states by those of an average over the angles, others by 1."""
        own = np.repeat(self.like.grid.weights, self.like.states.shape[1])
        return np.concatenate([own, np.ones(3 if self.like.free else 2)])


def phase_rows(equations: Invariance, torus: Section) -> Array:
    """Return what the phase conditions hold, over all unknowns, (1 or 2, M n + k)."""
    grid = torus.grid
    rows = [grid.interpolation(grid.angles)[1] @ torus.states]
    if torus.free:
        rows.append(equations.rates(torus))
    zeros = np.zeros(3 if torus.free else 2)
    return np.array([np.concatenate([(grid.weights[:, None] * row).ravel(), zeros]) for row in rows])


def solved(
    equations: Invariance, guess: Section, before: Section, held: Array, level: float, tol: float
) -> tuple[Section, Array] | None:
    """Return the torus near a guess with held . unknowns = level, and the tangent of its family.

    None where Newton's method fails. before: the torus whose phases are kept. held . tangent is positive.
    """
    unknowns = Unknowns(equations, guess)
    values, origin = unknowns.of(guess), unknowns.of(before)
    try:
        along = phase_rows(equations, before)
        for _ in range(MOST_ITERATIONS):
            torus = unknowns.torus(values)
            residual, jacobian = equations.linearise(torus)
            size = float(np.abs(residual).max())
            if not size < FAR:
                return None
            gaps = [*(along @ (values - origin)), held @ values - level]
            matrix = np.vstack([jacobian, along, held])
            if size < tol and np.abs(gaps).max() < tol:
                return replace(torus, residual=size), _tangent(matrix, unknowns.weights)
            values = values - np.linalg.solve(matrix, np.append(residual, gaps))
    except (ArithmeticError, np.linalg.LinAlgError):
        return None
    return None


def _tangent(matrix: Array, weights: Array) -> Array:
    """The unit vector that all rows but the last leave as it is."""
    last = np.zeros(len(matrix))
    last[-1] = 1.0
    found = np.linalg.solve(matrix, last)
    return np.asarray(found / np.sqrt(weights @ found**2))
