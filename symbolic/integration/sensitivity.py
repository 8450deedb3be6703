"""Time integration with sensitivities by CVODES: what a system offers to shooting.

The ODE y' = f(y, tau, p), y = (x, z), of `symbolic.integration.rates` is integrated together with the
derivatives of y in the first state and in the free parameters q,

    Y' = f_y Y + (0, f_q),

so that the step control answers for both. The unknowns start on the constraints: g(x, z) + EPSILON z = 0 has
a solution for every x, also where contact is lost and g hardly depends on z. The flow keeps to it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np
import scipy

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.integration.crossings import SwitchCrossings
from symbolic.integration.cvodes import IntegrationError, integrated, integrator, kept, spaced
from symbolic.integration.rates import constraint_rows, explicit_rates

EPSILON = 1e-10
"""Added to the derivative of each constraint in its unknown, with which it rises."""

TIGHTER = (1.0, 0.1, 0.01)
"""Tolerances tried in turn, as parts of the wanted one."""

ASIDE = 1e3
"""How far before a kink, in tolerances, the derivatives are integrated: past it they have none."""

UNKNOWN_ITERATIONS = 60
INCREMENT = 1e-13


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

    `kinks` are the switches at whose level the rates have a kink: there the integration begins anew.
    Raises ValueError for a system without a constraint for each unknown.
    """

    expressions: Expressions
    move: Callable[[Array, Array], Array]
    kinks: Sequence[int] = ()
    _integrators: dict[Hashable, ca.Function] = field(default_factory=dict, repr=False)
    _starts: dict[tuple[int, ...], ca.Function] = field(default_factory=dict, repr=False)
    _slopes: dict[tuple[int, ...], ca.Function] = field(default_factory=dict, repr=False)

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
        values = self._through(start, parameter, phase, free, tolerance)
        both = values.reshape(len(phase), width, -1).swapaxes(1, 2)
        return Sensitivities(both[:, :n, 0], both[:, n:, 0], both[:, :n, 1:], both[:, n:, 1:])

    def _through(
        self, start: Array, parameter: Array, phase: Array, free: tuple[int, ...], tolerance: float
    ) -> Array:
        """The values at all phases: the kinks are found first, then each piece between them integrated."""

        def sweep(y: Array, along: Array) -> Array:
            return np.concatenate([y[None], self._integrated(y, parameter, along, None, tolerance)])

        def piece(y: Array, begin: float, wanted: Array) -> Array:
            along = np.unique(np.append(begin, np.maximum(wanted, begin)))
            last = spaced(along)
            used, place = np.unique(last, return_inverse=True)
            later = self._integrated(y, parameter, along[used], free, tolerance) if len(used) > 1 else y[:0]
            values = np.concatenate([y[None], later.reshape(-1, len(y))])[place]
            for k in np.flatnonzero(last != np.arange(len(along))):
                way = along[k] - along[last[k]]
                values[k] = self._carried(values[k], parameter, along[last[k]], way, free)
            return values[np.searchsorted(along, wanted)]

        size = self.expressions.state.size1() + self.expressions.algebraic.size1()
        kinks = self._crossings.follow(sweep, start[:size], phase, parameter).crossings if self.kinks else []
        found, y, begin, done = [], start, float(phase[0]), -np.inf
        for crossing in kinks:
            near = ASIDE * tolerance / abs(crossing.rate) if crossing.rate else np.inf
            end = max(crossing.before - near, (begin + crossing.before) / 2)
            inside = np.append(phase[(phase > done) & (phase <= crossing.before)], crossing.before)
            values = piece(y, begin, np.append(inside[inside < end], end))
            late = [self._carried(values[-1], parameter, end, at - end, free) for at in inside[inside >= end]]
            found += [values[:-1], np.array(late[:-1]).reshape(-1, len(y))]
            y, begin, done = np.append(crossing.y, late[-1][size:]), crossing.after, crossing.before
        return np.concatenate([*found, piece(y, begin, phase[phase > done])])

    def _carried(self, y: Array, parameter: Array, phase: float, way: float, free: tuple[int, ...]) -> Array:
        """y and its derivatives a short way on, by the equations linearised where they are."""
        e = self.expressions
        size, width = e.state.size1() + e.algebraic.size1(), e.state.size1() + len(free)
        if free not in self._slopes:
            known = [ca.vertcat(e.state, e.algebraic), e.phase, e.parameter]
            slopes = [self._rates, ca.jacobian(self._rates, known[0])]
            slopes.append(ca.jacobian(self._rates, self._chosen(free)))
            self._slopes[free] = ca.Function("slopes", known, slopes)
        rate, jacobian, by_free = (np.array(a) for a in self._slopes[free](y[:size], phase, parameter))
        generator = np.zeros((size + len(free), size + len(free)))
        generator[:size] = way * np.hstack([jacobian, by_free])
        both = np.vstack([y[size:].reshape(width, size).T, np.eye(width)[e.state.size1() :]])
        gradient = (scipy.linalg.expm(generator) @ both)[:size]
        return np.append(y[:size] + way * rate.ravel(), gradient.T.ravel())

    def _integrated(
        self, start: Array, parameter: Array, phase: Array, free: tuple[int, ...] | None, tolerance: float
    ) -> Array:
        """All but the first values, a row each; those of y alone where `free` is None.

        CVODES gives up where a step runs too far into a sudden touch-down. A tighter tolerance shortens it.
        """
        for factor in TIGHTER:
            later = integrated(self._cvodes(free, tuple(phase), factor * tolerance), start, parameter)
            if later is not None and np.isfinite(later).all():
                return later.T
        raise IntegrationError(f"CVODES failed between tau = {phase[0]:.6g} and {phase[-1]:.6g}")

    def _start(
        self, state: Array, algebraic: Array, parameter: Array, phase: float, free: tuple[int, ...]
    ) -> Array:
        """The first y and its derivatives, column by column; the unknowns fulfil the constraints."""
        n, m, q = len(state), len(algebraic), len(free)
        rows, unknown = self._constraints(free), algebraic
        for _ in range(UNKNOWN_ITERATIONS):
            g, by_state, by_unknown, by_free = (np.array(a) for a in rows(state, unknown, phase, parameter))
            if not np.isfinite(by_unknown).all() or not np.isfinite(g).all():
                break
            change: Array = np.linalg.solve(by_unknown, -g.ravel()).astype(float)
            if (np.abs(change) <= INCREMENT * (1 + np.abs(unknown))).all() or (np.abs(g) <= INCREMENT).all():
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

    def _cvodes(
        self, free: tuple[int, ...] | None, phase: tuple[float, ...], tolerance: float
    ) -> ca.Function:
        key = (free, phase, tolerance)
        return kept(self._integrators, key, lambda: integrator(self._problem(free), phase, tolerance))

    @cached_property
    def _crossings(self) -> SwitchCrossings:
        return SwitchCrossings(self.expressions, self._rates, self.kinks)

    @cached_property
    def _rates(self) -> ca.SX:
        return explicit_rates(self.expressions, EPSILON)

    def _problem(self, free: tuple[int, ...] | None) -> dict[str, ca.SX]:
        """The ODE of y and, unless `free` is None, its derivatives."""
        e, rates = self.expressions, self._rates
        y = ca.vertcat(e.state, e.algebraic)
        if free is None:
            return {"x": y, "t": e.phase, "p": e.parameter, "ode": rates}
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
