"""Periodic orbits confirmed by stiff time integration, which shares nothing with collocation.

The states, the unknowns and perturbations of all states are integrated over a period by CVODES, and where it
gives up by SciPy's Radau.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import symbolic as sym
from periodic import Orbit
from symbolic.integration.rates import constraint_rows, explicit_rates

Array = NDArray[np.float64]

PIECES = 60
"""Most of the period that a step of the integrator may take: no kink is passed over."""

LOST = 1e-4
"""Uncertainty of perturbations where contact is lost: the unknown is then held by a regularisation."""


@dataclass(frozen=True)
class Return:
    """Where a motion is after one period: gap (n,), monodromy (n, n), and the largest growth on the way."""

    gap: Array
    monodromy: Array
    growth: float

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of the monodromy matrix, largest modulus first."""
        found = np.linalg.eigvals(self.monodromy).astype(np.complex128)
        return found[np.argsort(-np.abs(found), kind="stable")]


class Integrator:
    """Integrates a system with the given relative and absolute tolerance (scaled variables)."""

    def __init__(self, system: sym.CompiledSystem, tolerance: float = 1e-10) -> None:
        e = system.expressions
        y = ca.vertcat(e.state, e.algebraic)
        rows = ca.vertcat(ca.SX(0, 1), *[e.residual[i] for i in constraint_rows(e)])
        right = explicit_rates(e)
        moved = ca.SX.sym("moved", y.size1(), len(system.states))
        change = ca.jacobian(right, y) @ moved
        self.ode = {
            "x": ca.vertcat(y, ca.vec(moved)),
            "t": e.phase,
            "p": e.parameter,
            "ode": ca.vertcat(right, ca.vec(change)),
        }
        self.constraints = ca.Function("constraints", [y, e.phase, e.parameter], [rows, ca.jacobian(rows, y)])
        self.states, self.size, self.tolerance = len(system.states), y.size1(), tolerance
        self.uncertainty = LOST if system.algebraics else 1e3 * tolerance

    def well_posed(self, orbit: Orbit, phases: Array) -> float:
        """Return the phase at which the states determine the unknowns best: that of firm contact."""
        if self.size == self.states:
            return float(phases[0])
        return float(max(phases, key=lambda tau: self._hold(orbit, tau)))

    def _hold(self, orbit: Orbit, tau: float) -> float:
        at = np.array([tau])
        y = np.concatenate([orbit.state(at)[0], orbit.algebraic_guess(at)[0]])
        by = np.array(self.constraints(y, tau, orbit.parameter)[1])
        return float(np.linalg.svd(by[:, self.states :], compute_uv=False).min())

    def once_round(self, orbit: Orbit, tau: float) -> Return:
        """Return what one period makes of the orbit's state at tau."""
        n, size, span = self.states, self.size, orbit.mesh.period
        y, tangent = self._consistent(orbit, tau)
        start, phases = np.concatenate([y, tangent.T.ravel()]), tau + np.linspace(0, span, PIECES + 1)
        try:
            found = self._cvodes(start, phases, orbit.parameter)
        except RuntimeError:  # what CasADi raises for every failure of CVODES
            found = self._radau(start, phases, orbit.parameter)
        moved = found[:, size:].reshape(-1, n, size)[:, :, :n].transpose(0, 2, 1)
        growth = float(np.linalg.norm(moved, axis=(1, 2)).max())
        return Return(found[-1, :n] - y[:n], moved[-1], growth)

    def _cvodes(self, start: Array, phases: Array, parameter: Array) -> Array:
        options = {
            "reltol": self.tolerance,
            "abstol": 1e-2 * self.tolerance,
            "max_num_steps": 100_000,
            "max_step_size": phases[1] - phases[0],
            "disable_internal_warnings": True,
            "show_eval_warnings": False,
        }
        integrator = ca.integrator("round", "cvodes", self.ode, phases[0], list(phases[1:]), options)
        return np.array(integrator(x0=start, p=parameter)["xf"]).T

    def _radau(self, start: Array, phases: Array, parameter: Array) -> Array:
        arguments = [self.ode["x"], self.ode["t"], self.ode["p"]]
        rates = ca.Function("rates", arguments, [self.ode["ode"]])
        jacobian = ca.Function("jacobian", arguments, [ca.jacobian(self.ode["ode"], self.ode["x"])])
        found: Any = solve_ivp(
            lambda tau, z: np.array(rates(z, tau, parameter)).ravel(),
            (phases[0], phases[-1]),
            start,
            method="Radau",
            t_eval=phases[1:],
            rtol=self.tolerance,
            atol=1e-2 * self.tolerance,
            max_step=phases[1] - phases[0],
            jac=lambda tau, z: np.array(jacobian(z, tau, parameter)),
        )
        assert found.success, found.message
        return np.array(found.y.T)

    def _consistent(self, orbit: Orbit, tau: float) -> tuple[Array, Array]:
        """States and unknowns on the constraints, and how both move with the states, shape (n+m, n)."""
        n, at = self.states, np.array([tau])
        y = np.concatenate([orbit.state(at)[0], orbit.algebraic_guess(at)[0]])
        if self.size == n:
            return y, np.eye(n)
        for _ in range(30):
            rows, by = (np.array(a) for a in self.constraints(y, tau, orbit.parameter))
            if np.abs(rows).max() < 1e-13:
                break
            y[n:] -= np.linalg.solve(by[:, n:], rows.ravel())
        return y, np.concatenate([np.eye(n), -np.linalg.solve(by[:, n:], by[:, :n])])
