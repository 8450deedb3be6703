"""Time integration of a compiled system with CVODES and LSODA, independent of collocation.

CVODES is fast and gives up now and then where contact is lost; LSODA is slower and then takes its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.checks import finite
from symbolic.equations.expressions import Expressions
from symbolic.integration.cvodes import integrated, integrator, kept
from symbolic.integration.events import Event, pieced
from symbolic.integration.lsoda import Rates, failure, followed
from symbolic.integration.passages import Passages
from symbolic.integration.rates import constraint_rows, ode
from symbolic.integration.sliding import Sides, Sliding


class Followed(Protocol):
    """What is asked of a system that is integrated: its expressions, impacts and kinks, where it sticks."""

    @property
    def expressions(self) -> Expressions: ...
    @property
    def resets(self) -> Sequence[int]: ...
    @property
    def kinks(self) -> Sequence[int]: ...
    @property
    def slides(self) -> dict[int, tuple[int, int]]: ...
    def switch(self, state: Array, phase: Array, parameter: Array) -> Array: ...
    def reset(self, switch: int, state: Array, phase: Array, parameter: Array) -> Array: ...


@dataclass(frozen=True)
class Trajectory:
    """Phases (N,), scaled states (N, n) and unknowns (N, m)."""

    phase: Array
    state: Array
    algebraic: Array


@dataclass(frozen=True, eq=False)
class Flow:
    """Integrates `system` with relative and absolute tolerance `tolerance` (scaled variables)."""

    system: Followed
    tolerance: float = 1e-8
    _integrators: dict[tuple[float, ...], ca.Function] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        if not 1e-13 <= finite("tolerance", self.tolerance) <= 1e-2:
            raise ValueError(f"tolerance is {self.tolerance}; it must lie between 1e-13 and 0.01")

    def run(self, state: Array, algebraic: Array, parameter: Array, phase: Array) -> Trajectory:
        """Integrate from phase[0] and return the solution at all of `phase`, and at each impact twice.

        Raises IntegrationError where the integrator fails.
        """
        n = self.system.expressions.state.numel()
        start = self._on_constraints(np.concatenate([state, algebraic]), parameter, float(phase[0]))
        phase = np.asarray(phase, dtype=float)
        if self.system.slides:
            return self._pieced(start, parameter, phase)

        def sweep(y: Array, along: Array) -> Array:
            found = integrated(self._cvodes(tuple(along)), y, parameter)
            later = self._lsoda(y, parameter, along) if found is None else found.T
            return np.concatenate([y[None, :], later])

        def reset(k: int, tau: float, y: Array) -> Array:
            after = self.system.reset(k, y[None, :n], np.array([tau]), parameter)[0]
            return self._on_constraints(np.append(after, y[n:]), parameter, tau)

        given = reset if self.system.resets else None
        tau, values = self._passages.follow(sweep, start, phase, parameter, given).with_impacts(phase)
        return Trajectory(tau, values[:, :n], values[:, n:])

    def _pieced(self, start: Array, parameter: Array, phase: Array) -> Trajectory:
        """The motion through dry friction and impacts, at each of which there are two points of one phase."""
        system, n = self.system, self.system.expressions.state.numel()
        sliding = Sliding(system, parameter, self.tolerance) if system.slides else None

        def rates(sides: Sides) -> Rates:
            plain = self._rates[0]
            if sliding is not None:
                return sliding.rates(sides)
            return lambda tau, y: np.array(plain(y, tau, parameter)).ravel()

        def impact(k: int, sides: Sides) -> Event[Sides]:
            def value(tau: float, y: Array) -> float:
                return float(system.switch(y[None, :n], np.array([tau]), parameter)[0, k])

            def after(tau: float, y: Array) -> tuple[Array, Sides]:
                mapped = system.reset(k, y[None, :n], np.array([tau]), parameter)[0]
                found = self._on_constraints(np.append(mapped, y[n:]), parameter, tau)
                return found, sides if sliding is None else sliding.again(sides, tau, found)

            return Event(value, after)

        def events(sides: Sides) -> list[Event[Sides]]:
            slips = [] if sliding is None else sliding.events(sides)
            return [*(impact(k, sides) for k in system.resets), *slips]

        sides = () if sliding is None else sliding.begin(float(phase[0]), start)
        slope = np.array(self._rates[1](start, float(phase[0]), parameter))
        fastest = float(np.abs(np.linalg.eigvals(slope)).max()) if np.isfinite(slope).all() else 0.0
        tau, values = pieced(rates, events, sides, start, phase, self.tolerance, fastest=fastest)
        return Trajectory(tau, values[:, :n], values[:, n:])

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
    def _passages(self) -> Passages:
        return Passages(self.system.expressions, self._problem["ode"], self.system.kinks, self.system.resets)

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
