"""Time integration of a compiled system with CVODES and LSODA, independent of collocation.

Rows without any derivative are constraints. Differentiated once in tau they give, with the other rows, a
linear system for the rates of states and unknowns alike,

    M(y) y' = b(y, tau, p),   y = (x, z),

an explicit ODE that keeps the constraints constant. Where contact is lost a constraint hardly depends on its
unknown and the ODE would be stiff without bound: its derivative in the unknown is raised by SENSITIVITY, so
that the unknown relaxes to its quasi-steady value within that time. CVODES is fast and gives up there now and
then; LSODA is slower and then takes its place.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
import scipy

if TYPE_CHECKING:
    from symbolic.compile import Array, CompiledSystem

SENSITIVITY = 1e-8
"""Added to the derivative of each constraint in its unknown, with which it rises."""


class IntegrationError(ArithmeticError):
    """The integrator gave up; the message says where."""


@dataclass(frozen=True)
class Trajectory:
    """Phases (N,), scaled states (N, n) and unknowns (N, m)."""

    phase: Array
    state: Array
    algebraic: Array


@dataclass(frozen=True, eq=False)
class Flow:
    """Integrates `system` with relative and absolute tolerance `tolerance` (scaled variables)."""

    system: CompiledSystem
    tolerance: float = 1e-8
    _integrators: dict[tuple[float, ...], ca.Function] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        if not 1e-13 <= self.tolerance <= 1e-2:
            raise ValueError(f"tolerance is {self.tolerance}; it must lie between 1e-13 and 0.01")

    def run(self, state: Array, algebraic: Array, parameter: Array, phase: Array) -> Trajectory:
        """Integrate from phase[0] and return the solution at all of `phase`.

        Raises IntegrationError where the integrator fails.
        """
        n = len(self.system.states)
        start = self._on_constraints(np.concatenate([state, algebraic]), parameter, float(phase[0]))
        try:
            later = np.array(self._cvodes(tuple(phase))(x0=start, p=parameter)["xf"]).T
        except RuntimeError:  # what CasADi raises for every failure of CVODES
            later = self._lsoda(start, parameter, phase)
        values = np.concatenate([start[None, :], later])
        return Trajectory(np.asarray(phase, dtype=float), values[:, :n], values[:, n:])

    def _lsoda(self, start: Array, parameter: Array, phase: Array) -> Array:
        rates, jacobian = self._rates
        found = scipy.integrate.solve_ivp(
            lambda tau, y: np.array(rates(y, tau, parameter)).ravel(),
            (phase[0], phase[-1]),
            start,
            method="LSODA",
            t_eval=phase[1:],
            rtol=self.tolerance,
            atol=self.tolerance,
            jac=lambda tau, y: np.array(jacobian(y, tau, parameter)),
        )
        if not found.success or not np.isfinite(found.y).all():
            where = f"between tau = {phase[0]:.6g} and {phase[-1]:.6g}"
            raise IntegrationError(f"CVODES and LSODA both failed {where}")
        return found.y.T

    def _cvodes(self, phase: tuple[float, ...]) -> ca.Function:
        if phase not in self._integrators:
            options = {
                "reltol": self.tolerance,
                "abstol": self.tolerance,
                "max_num_steps": 20000,
                "disable_internal_warnings": True,
                "show_eval_warnings": False,
            }
            self._integrators[phase] = ca.integrator(
                "flow", "cvodes", self._problem, phase[0], list(phase[1:]), options
            )
        return self._integrators[phase]

    @cached_property
    def _rates(self) -> tuple[ca.Function, ca.Function]:
        problem = self._problem
        arguments = [problem["x"], problem["t"], problem["p"]]
        jacobian = ca.jacobian(problem["ode"], problem["x"])
        return ca.Function("rates", arguments, [problem["ode"]]), ca.Function(
            "jacobian", arguments, [jacobian]
        )

    @cached_property
    def _problem(self) -> dict[str, ca.SX]:
        e = self.system.expressions
        return {
            "x": ca.vertcat(e.state, e.algebraic),
            "t": e.phase,
            "p": e.parameter,
            "ode": explicit_rates(self.system),
        }

    @cached_property
    def _constraints(self) -> ca.Function:
        e = self.system.expressions
        rows = ca.vertcat(ca.SX(0, 1), *[e.residual[i] for i in constraint_rows(self.system)])
        y = ca.vertcat(e.state, e.algebraic)
        return ca.Function("constraints", [y, e.phase, e.parameter], [rows, ca.jacobian(rows, y)])

    def _on_constraints(self, y: Array, parameter: Array, phase: float) -> Array:
        """Return the nearest point that fulfils the constraints (Gauss-Newton)."""
        for _ in range(20):
            rows, jacobian = (np.array(a) for a in self._constraints(y, phase, parameter))
            if len(rows) == 0 or np.abs(rows).max() < 1e-14:
                break
            y = y - np.linalg.pinv(jacobian) @ rows.ravel()
        return y


def constraint_rows(system: CompiledSystem) -> list[int]:
    """Return the indices of the rows without any derivative."""
    e = system.expressions
    pattern = ca.jacobian(e.residual, e.rate)
    return [i for i in range(e.residual.size1()) if pattern[i, :].nnz() == 0]


def explicit_rates(system: CompiledSystem, sensitivity: float = SENSITIVITY) -> ca.SX:
    """Return (x', z') as an expression in states, unknowns, phase and parameters.

    Raises ValueError for a system whose rows are not linear in x'.
    """
    e, constraints = system.expressions, constraint_rows(system)
    rate = ca.SX.sym("algebraic_rate", len(system.algebraics))
    rows = []
    for i in range(e.residual.size1()):
        row = e.residual[i]
        if i in constraints:
            row = (
                ca.jtimes(row, e.state, e.rate)
                + ca.jtimes(row, e.algebraic, rate)
                + ca.jacobian(row, e.phase)
            )
            row += sensitivity * rate[constraints.index(i)]
        rows.append(row)
    rates, stacked = ca.vertcat(e.rate, rate), ca.vertcat(*rows)
    if ca.depends_on(ca.jacobian(stacked, rates), rates):
        raise ValueError("the rows of the system are not linear in its rates; time integration needs them so")
    rest = ca.substitute(stacked, rates, ca.SX.zeros(rates.size1()))
    return ca.solve(ca.jacobian(stacked, rates), -rest)
