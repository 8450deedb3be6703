"""Time integration with sensitivities by CVODES, for shooting.

The ODE y' = f(y, tau, p), y = (x, z), of `symbolic.integration.rates` is integrated together with the
derivatives of y in the first state and in the free parameters q,

    Y' = f_y Y + (0, f_q),

so that the step control bounds the errors of both. The unknowns start on the constraints: g(x, z) + EPSILON z
= 0 has a solution for every x, also where contact is lost and g hardly depends on z. The flow keeps to it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np
import scipy

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.equations.surfaces import Kind
from symbolic.integration.cvodes import Cvodes, IntegrationError
from symbolic.integration.field import VectorField
from symbolic.integration.follower import Followed, Follower
from symbolic.integration.modes import Modes, Switched, Switching
from symbolic.integration.rates import constraint_rows
from symbolic.interrupts import interruptible

EPSILON = 1e-10
"""Added to the derivative, which is positive, of each constraint in its unknown."""

TIGHTER = (1.0, 0.1, 0.01)
"""Tolerances tried in turn, as parts of the wanted one."""

ASIDE = 1e3
"""Distance before a kink, in tolerances, at which `_carried` takes over from the integrator."""

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

    At kinks, and at jumps at given phases, the integration begins anew. Raises ValueError for a system
    without a constraint for each unknown.
    """

    system: Switched
    move: Callable[[Array, Array], Array]
    _sensitive: dict[tuple[int, ...], Cvodes] = field(default_factory=dict, repr=False)
    _starts: dict[tuple[int, ...], ca.Function] = field(default_factory=dict, repr=False)
    _slopes: dict[tuple[int, ...], ca.Function] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        rows, unknowns = len(constraint_rows(self.expressions)), self.expressions.algebraic.size1()
        if rows != unknowns:
            raise ValueError(
                f"the system has {rows} constraints for {unknowns} algebraic unknowns; "
                f"time integration needs one for each"
            )

    @property
    def expressions(self) -> Expressions:
        """The equations."""
        return self.system.expressions

    @interruptible()
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
        IntegrationError where CVODES fails, ValueError where the motion is mapped, held, or meets a jump that
        depends on it.
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
        size, (found, modes) = self._field.y.numel(), self._followed(start, parameter, phase, tolerance)
        values, y, begin, done = [], start, float(phase[0]), -np.inf
        for passage in found.passages:
            given, kink = self._given(parameter, modes), passage.root
            near = ASIDE * tolerance / abs(kink.rate) if kink.rate else np.inf
            end = max(kink.before - near, (begin + kink.before) / 2)
            inside = np.append(phase[(phase > done) & (phase <= kink.before)], kink.before)
            early = np.concatenate([[begin], inside[inside < end], [end]])
            piece = self._integrated(y, given, np.maximum(early, begin), free, tolerance)[1:]
            late = [self._carried(piece[-1], given, end, at - end, free) for at in inside[inside >= end]]
            values += [piece[:-1], np.array(late[:-1]).reshape(-1, len(y))]
            y, begin, done = np.append(passage.y, late[-1][size:]), kink.after, kink.before
            modes = passage.modes
        last = np.maximum(np.append(begin, phase[phase > done]), begin)
        values.append(self._integrated(y, self._given(parameter, modes), last, free, tolerance)[1:])
        return np.concatenate(values)

    def _followed(
        self, start: Array, parameter: Array, phase: Array, tolerance: float
    ) -> tuple[Followed, Modes]:
        """The motion alone, and its first modes; just its start where no guard can end these."""
        n, y = self.expressions.state.numel(), start[: self._field.y.numel()]
        switching = Switching(self.system, parameter, tolerance)
        _, modes = switching.begin(float(phase[0]), y[:n])
        if not switching.guards(modes):
            return Followed(y[None], [], (), modes), modes
        follower = Follower(
            switching,
            lambda modes, y, along: self._field.sweep(y, along, self._given(parameter, modes), tolerance),
            lambda modes, y, along: self._field.guards(y, along, self._given(parameter, modes)),
            lambda y, tau: y,
            n,
        )
        found = follower.run(y, phase, modes)
        for event in found.events:
            surface = self.system.surfaces[event.surface]
            at_given = not ca.depends_on(self.expressions.switches[surface.switch], self.expressions.state)
            if surface.kind != Kind.KINK and not (surface.kind == Kind.JUMP and at_given):
                raise ValueError(
                    f"the motion meets {surface.name} at tau = {event.phase:.6g}; derivatives are known "
                    f"through kinks and jumps at given phases alone"
                )
        return found, modes

    def _given(self, parameter: Array, modes: Modes) -> Array:
        """Parameters and sides of the jumps."""
        return np.concatenate([parameter, Switching(self.system, parameter, 0.0).side(modes)])

    def _carried(self, y: Array, given: Array, phase: float, way: float, free: tuple[int, ...]) -> Array:
        """y and its derivatives a short way on, by the equations linearised at y."""
        field, n = self._field, self.expressions.state.numel()
        size, width = field.y.numel(), n + len(free)
        if free not in self._slopes:
            slopes = [ca.jacobian(field.rates, v) for v in (field.y, self._chosen(free))]
            known = [field.y, self.expressions.phase, field.given]
            self._slopes[free] = ca.Function("slopes", known, [field.rates, *slopes])
        rate, jacobian, by_free = (np.array(a) for a in self._slopes[free](y[:size], phase, given))
        generator = np.zeros((size + len(free), size + len(free)))
        generator[:size] = way * np.hstack([jacobian, by_free])
        both = np.vstack([y[size:].reshape(width, size).T, np.eye(width)[n:]])
        gradient = (scipy.linalg.expm(generator) @ both)[:size]
        return np.append(y[:size] + way * rate.ravel(), gradient.T.ravel())

    def _integrated(
        self, start: Array, given: Array, phase: Array, free: tuple[int, ...], tolerance: float
    ) -> Array:
        """y and its derivatives at all phases, a row each.

        CVODES gives up where a step runs too far into a sudden touch-down. A tighter tolerance shortens it.
        """
        if free not in self._sensitive:
            self._sensitive[free] = Cvodes(self._problem(free))
        for factor in TIGHTER:
            found = self._sensitive[free].run(start, phase, given, factor * tolerance)
            if found is not None:
                return found
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

    @cached_property
    def _field(self) -> VectorField:
        return VectorField(self.expressions, EPSILON)

    def _problem(self, free: tuple[int, ...]) -> dict[str, ca.SX]:
        """The ODE of y and its derivatives."""
        y, rates, n = self._field.y, self._field.rates, self.expressions.state.numel()
        in_free = ca.horzcat(ca.SX(y.numel(), n), ca.jacobian(rates, self._chosen(free)))
        gradient = ca.SX.sym("gradient", y.numel(), n + len(free))
        moved = ca.jacobian(rates, y) @ gradient + in_free
        return {
            "x": ca.vertcat(y, ca.vec(gradient)),
            "t": self.expressions.phase,
            "p": self._field.given,
            "ode": ca.vertcat(rates, ca.vec(moved)),
        }
