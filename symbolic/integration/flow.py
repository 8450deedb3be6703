"""Time integration of a compiled system with CVODES and LSODA, independent of collocation.

CVODES is fast and gives up now and then where contact is lost; LSODA is slower and then takes its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.checks import finite
from symbolic.equations.surfaces import STUCK
from symbolic.integration.crossings import SwitchCrossings
from symbolic.integration.cvodes import IntegrationError, integrated, integrator, kept
from symbolic.integration.lsoda import Rates, failure, followed
from symbolic.integration.modes import Event, Modes, Switched, Switching
from symbolic.integration.pieces import Follower
from symbolic.integration.rates import constraint_rows, explicit_rates, ode


class Followed(Switched, Protocol):
    """What is asked of a system that is integrated: besides its surfaces, which are impacts and kinks."""

    @property
    def resets(self) -> Sequence[int]: ...
    @property
    def kinks(self) -> Sequence[int]: ...
    @property
    def slides(self) -> dict[int, tuple[int, int]]: ...


class RestsError(IntegrationError):
    """Impacts without number: a motion comes to rest on a wall, and is to be followed from event to event."""


@dataclass(frozen=True)
class Trajectory:
    """Phases (N,), scaled states (N, n) and unknowns (N, m); the events on the way, and the modes at its end.

    The modes are those of the system's surfaces: a motion goes on in them.
    """

    phase: Array
    state: Array
    algebraic: Array
    events: tuple[Event, ...] = ()
    modes: Modes = ()


@dataclass(frozen=True, eq=False)
class Flow:
    """Integrates `system` with relative and absolute tolerance `tolerance` (scaled variables)."""

    system: Followed
    tolerance: float = 1e-8
    _integrators: dict[tuple[float, ...], ca.Function] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        if not 1e-13 <= finite("tolerance", self.tolerance) <= 1e-2:
            raise ValueError(f"tolerance is {self.tolerance}; it must lie between 1e-13 and 0.01")

    def run(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        modes: Modes | None = None,
    ) -> Trajectory:
        """Integrate from phase[0] and return the solution at all of `phase`, and at each impact twice.

        modes: those with which it begins, by default as the state has them. Raises IntegrationError where the
        integrator fails.
        """
        start = self._on_constraints(np.concatenate([state, algebraic]), parameter, float(phase[0]))
        phase = np.asarray(phase, dtype=float)
        if self.system.slides or STUCK in (modes or ()):
            return self._pieced(start, parameter, phase, modes)
        try:
            return self._through(start, parameter, phase)
        except RestsError:
            return self._pieced(start, parameter, phase, modes)

    def _through(self, start: Array, parameter: Array, phase: Array) -> Trajectory:
        """The motion through kinks and impacts. Raises RestsError where it comes to rest on a wall."""
        n = self.system.expressions.state.numel()
        switching = Switching(self.system, parameter, self.tolerance)

        def sweep(y: Array, along: Array) -> Array:
            found = integrated(self._cvodes(tuple(along)), y, parameter)
            later = self._lsoda(y, parameter, along) if found is None else found.T
            return np.concatenate([y[None, :], later])

        def reset(k: int, tau: float, y: Array) -> Array:
            after = self.system.reset(k, y[None, :n], np.array([tau]), parameter)[0]
            if switching.rests(k, tau, after):
                raise RestsError(f"it comes to rest on a wall at tau = {tau:.6g}", tau)
            return self._on_constraints(np.append(after, y[n:]), parameter, tau)

        given = reset if self.system.resets else None
        found = self._crossings.follow(sweep, start, phase, parameter, given)
        tau, values = found.with_impacts(phase)
        crossed = [(p.switch, p.before, p.rate) for p in found.crossings]
        events = switching.along(float(phase[0]), start[:n], crossed) if crossed else ()
        return Trajectory(tau, values[:, :n], values[:, n:], events, events[-1].modes if events else ())

    def _pieced(self, start: Array, parameter: Array, phase: Array, modes: Modes | None = None) -> Trajectory:
        """The motion from event to event, at each impact of which there are two points of one phase."""
        n = self.system.expressions.state.numel()
        switching, given = Switching(self.system, parameter, self.tolerance), ca.DM(parameter)

        def rates(modes: Modes) -> Rates:
            side = ca.DM(switching.side(modes))
            return lambda tau, y: np.array(self._beside[0](y, tau, given, side)).ravel()

        def slope(modes: Modes) -> Rates:
            side = ca.DM(switching.side(modes))
            return lambda tau, y: np.array(self._beside[1](y, tau, given, side))

        def settle(y: Array, tau: float) -> Array:
            return self._on_constraints(y, parameter, tau)

        found = Follower(switching, rates, slope, settle, n).run(start, phase, modes)
        values = found.values
        return Trajectory(found.phase, values[:, :n], values[:, n:], found.events, found.modes)

    def rates(self, trajectory: Trajectory, parameter: Array) -> Array:
        """Return (x', z') along a trajectory, shape (N, n+m)."""
        values = np.concatenate([trajectory.state, trajectory.algebraic], axis=1)
        rates, _ = self._rates
        found = [rates(y, tau, parameter) for y, tau in zip(values, trajectory.phase, strict=True)]
        return np.array(found).reshape(values.shape)

    def _lsoda(self, start: Array, parameter: Array, phase: Array) -> Array:
        rates, jacobian = self._rates
        return followed(
            lambda tau, y: np.array(rates(y, tau, parameter)).ravel(),
            lambda tau, y: np.array(jacobian(y, tau, parameter)),
            start,
            phase,
            self.tolerance,
        )

    def _cvodes(self, phase: tuple[float, ...]) -> ca.Function:
        return kept(self._integrators, phase, lambda: integrator(self._problem, phase, self.tolerance))

    @cached_property
    def _crossings(self) -> SwitchCrossings:
        return SwitchCrossings(
            self.system.expressions, self._problem["ode"], self.system.kinks, self.system.resets
        )

    @cached_property
    def _problem(self) -> dict[str, ca.SX]:
        return ode(self.system.expressions)

    @cached_property
    def _rates(self) -> tuple[ca.Function, ca.Function]:
        problem = self._problem
        arguments = [problem["x"], problem["t"], problem["p"]]
        jacobian = ca.jacobian(problem["ode"], problem["x"])
        return ca.Function("rates", arguments, [problem["ode"]]), ca.Function(
            "jacobian", arguments, [jacobian]
        )

    @cached_property
    def _beside(self) -> tuple[ca.Function, ca.Function]:
        """The rates on sides of the jumps, and their derivatives."""
        e = self.system.expressions
        known = [self._problem["x"], e.phase, e.parameter, e.sided.side]
        rates = explicit_rates(replace(e, residual=e.sided.residual))
        slope = ca.densify(ca.jacobian(rates, known[0]))
        return ca.Function("beside", known, [rates]), ca.Function("slope", known, [slope])

    @cached_property
    def _constraints(self) -> ca.Function:
        e = self.system.expressions
        rows = ca.vertcat(ca.SX(0, 1), *[e.residual[i] for i in constraint_rows(e)])
        y = ca.vertcat(e.state, e.algebraic)
        return ca.Function("constraints", [y, e.phase, e.parameter], [rows, ca.jacobian(rows, y)])

    def _on_constraints(self, y: Array, parameter: Array, phase: float) -> Array:
        """Return the nearest point that fulfils the constraints (Gauss-Newton)."""
        for _ in range(20):
            rows, jacobian = (np.array(a) for a in self._constraints(y, phase, parameter))
            if not np.isfinite(jacobian).all() or not np.isfinite(rows).all():
                raise failure(phase)
            if len(rows) == 0 or np.abs(rows).max() < 1e-14:
                break
            y = y - np.linalg.pinv(jacobian) @ rows.ravel()
        return y
