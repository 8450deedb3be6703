"""The vector field of a system on given sides of its jumps, and the motions along it.

The ODE is y' = f(y, tau, p, sigma), y = (x, z), of `symbolic.integration.rates`. CVODES integrates it: fast,
though it gives up now and then where contact is lost; LSODA is slower and then takes its place. A few single
Runge-Kutta steps come before both, and Radau takes over for fast oscillations beside friction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.integration.buffered import Buffered
from symbolic.integration.cvodes import Cvodes
from symbolic.integration.lsoda import failure, followed
from symbolic.integration.rates import SENSITIVITY, constraint_rows, explicit_rates
from symbolic.integration.runge import Steps

RINGING = 1000.0
"""Oscillation of a mode (rad) in a motion above which Radau is used: CVODES resolves each cycle."""

LOOSE = 1e-6
"""Finest tolerance at which Radau is used; at finer ones it takes as many steps."""

CONSTRAINT_ITERATIONS = 20
"""Most Gauss-Newton steps onto the constraints."""

FULFILLED = 1e-14
"""Residual at which the constraints are fulfilled."""


@dataclass(frozen=True, eq=False)
class VectorField:
    """f in scaled variables.

    Parameters
    ----------
    expressions : Expressions
        The equations; ValueError where they are condensed, or not linear in the rates.
    sensitivity : float
        Added to the derivatives of constraints: see `symbolic.integration.rates`.
    """

    expressions: Expressions
    sensitivity: float = SENSITIVITY

    @cached_property
    def y(self) -> ca.SX:
        """The variables (x, z)."""
        return ca.vertcat(self.expressions.state, self.expressions.algebraic)

    @cached_property
    def given(self) -> ca.SX:
        """The parameters and the sides (p, sigma)."""
        return ca.vertcat(self.expressions.parameter, self.expressions.sided.side)

    @cached_property
    def rates(self) -> ca.SX:
        """The expression f."""
        e = self.expressions
        return explicit_rates(replace(e, residual=e.sided.residual) if e.sided.jumps else e, self.sensitivity)

    def sweep(self, start: Array, phase: Array, given: Array, tolerance: float) -> Array:
        """Return the motion from `start` at phase[0] at all of `phase` (K,), which rises, shape (K, w).

        Raises IntegrationError where both integrators fail.
        """
        near = self._steps.run(start, phase, given, tolerance)
        if near is not None:
            return near
        rings = tolerance >= LOOSE and self._rings(start, phase, given)
        found = None if rings else self._cvodes.run(start, phase, given, tolerance)
        if found is not None:
            return found
        later = followed(
            lambda tau, y: np.array(self._rates(y, tau, given)).ravel(),
            lambda tau, y: np.array(self._slope(y, tau, given)),
            start,
            phase,
            tolerance,
            "Radau" if rings else "LSODA",
        )
        return np.concatenate([start[None], later])

    def _rings(self, start: Array, phase: Array, given: Array) -> bool:
        """Whether beside friction a mode oscillates so often that Radau, which damps it, is faster."""
        if not self.expressions.sided.slides:
            return False
        slope = np.array(self._slope(start, phase[0], given))
        if not np.isfinite(slope).all():
            return False
        return float(np.abs(np.linalg.eigvals(slope).imag).max()) * (phase[-1] - phase[0]) > RINGING

    def along(self, values: Array, phase: Array, given: Array) -> Array:
        """Return y' along a motion, shape (K, w)."""
        return np.array(self._rates(values.T, phase[None], given)).T

    def guards(self, values: Array, phase: Array, given: Array) -> tuple[Array, Array]:
        """Return the switches along a motion and their derivatives in tau, both of shape (K, switches)."""
        one = self._guards_at
        (y, tau, p), (both,) = one.given, one.results
        found = np.empty((len(phase), *both.shape))
        p[:] = given
        for k, at in enumerate(phase):
            y[:], tau[0] = values[k], at
            one()
            found[k] = both
        return found[:, 0], found[:, 1]

    def on_constraints(self, y: Array, phase: float, parameter: Array) -> Array:
        """Return the nearest point (w,) that fulfils the constraints (Gauss-Newton).

        Raises IntegrationError where they have no finite values.
        """
        if not self._constraints.size1_out(0):
            return y
        for _ in range(CONSTRAINT_ITERATIONS):
            rows, jacobian = (np.array(a) for a in self._constraints(y, phase, parameter))
            if not np.isfinite(jacobian).all() or not np.isfinite(rows).all():
                raise failure(phase)
            if np.abs(rows).max() < FULFILLED:
                break
            y = y - np.linalg.pinv(jacobian) @ rows.ravel()
        return y

    def begun(self, y: Array, phase: float, parameter: Array) -> Array:
        """Return (x, z) with the same states and unknowns that fulfil the constraints, from a guess of these.

        By Newton's method in the unknowns alone; where that fails the nearest point (w,) that fulfils them.
        Raises IntegrationError where there is none.
        """
        n, found = self.expressions.state.numel(), y.copy()
        for _ in range(CONSTRAINT_ITERATIONS):
            rows, jacobian = (np.array(a) for a in self._constraints(found, phase, parameter))
            if not np.isfinite(jacobian).all() or not np.isfinite(rows).all():
                break
            if not rows.size or np.abs(rows).max() < FULFILLED:
                return found
            found[n:] -= np.linalg.pinv(jacobian[:, n:]) @ rows.ravel()
        return self.on_constraints(y, phase, parameter)

    def constraint_slope(self, y: Array, phase: float, parameter: Array) -> Array:
        """Return the derivatives of the constraints in y, shape (m, w)."""
        return np.array(self._constraints(y, phase, parameter)[1])

    @cached_property
    def _cvodes(self) -> Cvodes:
        return Cvodes({"x": self.y, "t": self.expressions.phase, "p": self.given, "ode": self.rates})

    @cached_property
    def _steps(self) -> Steps:
        return Steps(self._rates)

    @cached_property
    def _at(self) -> list[ca.SX]:
        return [self.y, self.expressions.phase, self.given]

    @cached_property
    def _rates(self) -> ca.Function:
        return ca.Function("rates", self._at, [self.rates])

    @cached_property
    def _slope(self) -> ca.Function:
        return ca.Function("slope", self._at, [ca.densify(ca.jacobian(self.rates, self.y))])

    @cached_property
    def _guards_at(self) -> Buffered:
        e = self.expressions
        along = ca.jtimes(e.guards, e.state, self.rates[: e.state.numel()])
        both = ca.horzcat(e.guards, along + ca.jacobian(e.guards, e.phase))
        return Buffered(ca.Function("guards", self._at, [ca.densify(both)]))

    @property
    def constraints(self) -> ca.SX:
        """The rows without rates, (m,)."""
        e = self.expressions
        return ca.vertcat(ca.SX(0, 1), *[e.residual[i] for i in constraint_rows(e)])

    @cached_property
    def _constraints(self) -> ca.Function:
        e, rows = self.expressions, self.constraints
        return ca.Function("constraints", [self.y, e.phase, e.parameter], [rows, ca.jacobian(rows, self.y)])
