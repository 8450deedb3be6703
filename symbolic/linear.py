"""The linear system about the rest of a model: equilibrium, eigenvalues, natural frequencies, damping ratios.

With the unexcited rows R(x', x, z, p) = 0 linearised at rest, small motions exp(lambda t) obey the pencil

    (R_x dx + R_z dz) + (lambda / omega) R_x' dx = 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from symbolic.compile import Array, CompiledSystem

INFINITE = 1e12
"""Eigenvalues of the pencil beyond this belong to the algebraic unknowns."""


class NoRestError(ArithmeticError):
    """No equilibrium was found; the message says at which parameters."""


@dataclass(frozen=True)
class Modes:
    """Rest and small motion: scaled state (n,), unknowns (m,); eigenvalues (n,) in rad/s, slowest first."""

    state: Array
    algebraic: Array
    eigenvalues: NDArray[np.complex128]

    @property
    def oscillating(self) -> NDArray[np.complex128]:
        """One eigenvalue of each conjugate pair (positive imaginary part), in rad/s."""
        return self.eigenvalues[self.eigenvalues.imag > 0]

    @property
    def frequencies(self) -> Array:
        """Undamped natural frequencies |lambda| of the oscillating pairs, in rad/s."""
        return np.abs(self.oscillating)

    @property
    def damping_ratios(self) -> Array:
        """Damping ratios -Re(lambda)/|lambda| of the oscillating pairs."""
        return -self.oscillating.real / np.abs(self.oscillating)


def modes(system: CompiledSystem, values: Mapping[str, float] | None = None) -> Modes:
    """Return rest and linear motion at the nominal parameters, or with some `values` (SI) changed.

    Raises ValueError for a name that is no parameter, NoRestError where no equilibrium is found.
    """
    parameter = with_values(system, values or {})
    e, n = system.expressions, len(system.states)
    arguments = [e.rate, e.state, e.algebraic, e.parameter]
    unknown = ca.vertcat(e.state, e.algebraic)
    jacobian = [ca.jacobian(e.unexcited, unknown), ca.jacobian(e.unexcited, e.rate)]
    function = ca.Function("linear", arguments, [e.unexcited, *jacobian, e.frequency])
    point = np.concatenate(system.rest(parameter))
    for _ in range(20):
        residual, stiffness, inertia, omega = function(np.zeros(n), point[:n], point[n:], parameter)
        if np.linalg.matrix_rank(np.array(stiffness)) < len(point):
            break
        change = np.linalg.solve(np.array(stiffness), np.array(residual)).ravel()
        point = point - change
        if not np.isfinite(point).all():
            break
        if np.abs(change).max() < 1e-13 * (1 + np.abs(point).max()):
            return Modes(
                point[:n], point[n:], _eigenvalues(np.array(stiffness), np.array(inertia), float(omega))
            )
    raise NoRestError(f"no equilibrium was found at {dict(values or {})} (other parameters nominal)")


def with_values(system: CompiledSystem, values: Mapping[str, float]) -> Array:
    """Return the nominal parameter vector with some values (SI) replaced, by name."""
    parameter = system.nominal
    names = [p.name for p in system.parameters]
    for name, value in values.items():
        if name not in names:
            raise ValueError(f"parameter is {name!r}; it must be one of {', '.join(names)}")
        parameter[names.index(name)] = value
    return parameter


def _eigenvalues(stiffness: Array, inertia: Array, omega: float) -> NDArray[np.complex128]:
    mass = np.zeros_like(stiffness)
    mass[:, : inertia.shape[1]] = -inertia
    found = linalg.eigvals(stiffness, mass)
    finite = found[np.isfinite(found) & (np.abs(found) < INFINITE)] * omega
    return finite[np.argsort(np.abs(finite))].astype(np.complex128)
