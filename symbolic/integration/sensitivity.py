"""Time integration with sensitivities by CVODES: what a system offers to shooting.

The ODE y' = f(y, tau, p), y = (x, z), of `symbolic.integration.rates` is integrated together with the
derivatives of y in the first state and in the free parameters q,

    Y' = f_y Y + (0, f_q),

so that the step control answers for both. The unknowns start on the constraints: g(x, z) + EPSILON z = 0 has
a solution for every x, also where contact is lost and g hardly depends on z. The flow keeps to it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.integration.cvodes import IntegrationError, integrated, integrator
from symbolic.integration.rates import constraint_rows, explicit_rates

EPSILON = 1e-10
"""Added to the derivative of each constraint in its unknown, with which it rises."""

TIGHTER = (1.0, 0.1, 0.01)
"""Tolerances tried in turn, as parts of the wanted one."""

KEPT = 64
"""How many integrators are kept; each is for certain phases."""

ITERATIONS = 60
CLOSE = 1e-13


@dataclass(frozen=True)
class Sensitivities:
    """A trajectory at K phases: state (K, n), algebraic (K, m), and their derivatives in the first state and
    then in the free parameters, state_gradient (K, n, n+q), algebraic_gradient (K, m, n+q).
    """

    state: Array
    algebraic: Array
    state_gradient: Array
    algebraic_gradient: Array


@dataclass(frozen=True, eq=False)
class SensitiveFlow:
    """Integrates a system in scaled variables; `move` takes the unknowns along Newton's increments.

    Raises ValueError for a system without a constraint for each unknown.
    """

    expressions: Expressions
    move: Callable[[Array, Array], Array]
    _integrators: dict[Hashable, ca.Function] = field(default_factory=dict, repr=False)
    _starts: dict[tuple[int, ...], ca.Function] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        rows, unknowns = len(constraint_rows(self.expressions)), self.expressions.algebraic.size1()
        if rows != unknowns:
            raise ValueError(
                f"the system has {rows} constraints for {unknowns} algebraic unknowns; "
                f"time integration needs one for each"
            )

    def run(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        free: tuple[int, ...],
        tolerance: float,
    ) -> Sensitivities:
        """Return the solution from `state` at phase[0] at all of `phase`, with its derivatives.

        algebraic is a guess of the unknowns at phase[0], tolerance relative and absolute. Raises
        IntegrationError where CVODES fails.
        """
        n, width = len(state), 1 + len(state) + len(free)
        start = self._start(state, algebraic, parameter, float(phase[0]), free)
        later = self._integrated(start, parameter, tuple(phase), free, tolerance)
        values = np.column_stack([start, later])
        both = values.T.reshape(len(phase), width, -1).swapaxes(1, 2)
        return Sensitivities(both[:, :n, 0], both[:, n:, 0], both[:, :n, 1:], both[:, n:, 1:])

    def _integrated(
        self,
        start: Array,
        parameter: Array,
        phase: tuple[float, ...],
        free: tuple[int, ...],
        tolerance: float,
    ) -> Array:
        """All but the first values, a column each.

        CVODES gives up where a step runs too far into a sudden touch-down. A tighter tolerance shortens it.
        """
        for factor in TIGHTER:
            later = integrated(self._cvodes(free, phase, factor * tolerance), start, parameter)
            if later is not None and np.isfinite(later).all():
                return later
        raise IntegrationError(f"CVODES failed between tau = {phase[0]:.6g} and {phase[-1]:.6g}")

    def _start(
        self, state: Array, algebraic: Array, parameter: Array, phase: float, free: tuple[int, ...]
    ) -> Array:
        """The first y and its derivatives, column by column; the unknowns fulfil the constraints."""
        n, m, q = len(state), len(algebraic), len(free)
        rows, unknown = self._constraints(free), algebraic
        for _ in range(ITERATIONS):
            g, by_state, by_unknown, by_free = (np.array(a) for a in rows(state, unknown, phase, parameter))
            if not np.isfinite(by_unknown).all() or not np.isfinite(g).all():
                break
            change: Array = np.linalg.solve(by_unknown, -g.ravel()).astype(float)
            if (np.abs(change) <= CLOSE * (1 + np.abs(unknown))).all() or (np.abs(g) <= CLOSE).all():
                gradient = -np.linalg.solve(by_unknown, np.hstack([by_state, by_free]))
                first = np.hstack([np.eye(n), np.zeros((n, q))])
                y = np.append(state, unknown)[:, None]
                return np.hstack([y, np.vstack([first, gradient])]).T.ravel()
            unknown = self.move(unknown[None, :], change[None, :])[0]
        raise IntegrationError(f"the {m} unknowns at tau = {phase:.6g} were not found")

    def _constraints(self, free: tuple[int, ...]) -> ca.Function:
        if free not in self._starts:
            e = self.expressions
            rows = ca.vertcat(ca.SX(0, 1), *[e.residual[i] for i in constraint_rows(e)])
            rows += EPSILON * e.algebraic
            results = [rows, *(ca.jacobian(rows, v) for v in (e.state, e.algebraic, self._chosen(free)))]
            self._starts[free] = ca.Function(
                "constraints", [e.state, e.algebraic, e.phase, e.parameter], results
            )
        return self._starts[free]

    def _chosen(self, free: tuple[int, ...]) -> ca.SX:
        return ca.vertcat(ca.SX(0, 1), *[self.expressions.parameter[i] for i in free])

    def _cvodes(self, free: tuple[int, ...], phase: tuple[float, ...], tolerance: float) -> ca.Function:
        key = (free, phase, tolerance)
        if key not in self._integrators:
            while len(self._integrators) >= KEPT:
                self._integrators.pop(next(iter(self._integrators)))  # the oldest
            self._integrators[key] = integrator(self._problem(free), phase, tolerance)
        return self._integrators[key]

    @cached_property
    def _rates(self) -> ca.SX:
        return explicit_rates(self.expressions, EPSILON)

    def _problem(self, free: tuple[int, ...]) -> dict[str, ca.SX]:
        """The ODE of y and its derivatives."""
        e, rates = self.expressions, self._rates
        y = ca.vertcat(e.state, e.algebraic)
        in_state = ca.SX(y.size1(), e.state.size1())
        in_free = ca.jacobian(rates, self._chosen(free))
        gradient = ca.SX.sym("gradient", y.size1(), e.state.size1() + len(free))
        moved = ca.jacobian(rates, y) @ gradient + ca.horzcat(in_state, in_free)
        return {
            "x": ca.vertcat(y, ca.vec(gradient)),
            "t": e.phase,
            "p": e.parameter,
            "ode": ca.vertcat(rates, ca.vec(moved)),
        }
