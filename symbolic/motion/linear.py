"""The linear system about the rest of a model: equilibrium, Jacobian, eigenvalues, frequencies, damping.

With the unexcited rows R(x', x, z, p) = 0 linearised at rest, ' = d/dtau and d/dt = omega d/dtau,

    R_x' dx' + R_z dz = -R_x dx,   so that   d(dx)/dt = J dx,

with J the upper rows of -omega [R_x' R_z]^-1 R_x; small motions are sums of exp(lambda t), lambda its
eigenvalues.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np
import scipy

from symbolic.arrays import Array, Complex
from symbolic.checks import one_of, refusal, sequence
from symbolic.interrupts import interruptible
from symbolic.system.compile import all_states
from symbolic.system.compiled import CompiledSystem, with_values

BALANCED_RESIDUAL = 1e-12
"""Scaled residual up to which a point with a singular stiffness counts as an equilibrium."""

FREQUENCIES_MEET = 1e-9
"""Relative difference of the two frequencies up to which they count as met."""

REAL_EIGENVALUE = 1e-7
"""Imaginary parts up to this, of the largest eigenvalue, are rounding: of a double zero its square root."""


class NoRestError(ArithmeticError):
    """No equilibrium was found, or small motion about it is not determined; the message says where."""


@dataclass(frozen=True, kw_only=True)
class Modes:
    """Rest and small motion about it.

    Parameters
    ----------
    parameter : ndarray, shape (p,)
        Values of the parameters, SI.
    omega : float
        Excitation frequency in rad/s.
    state : ndarray, shape (n,)
        Equilibrium, scaled.
    algebraic : ndarray, shape (m,)
        Unknowns there.
    jacobian : ndarray, shape (n, n)
        J of d(dx)/dt = J dx with the states in SI units (a velocity state is dq/dtau, in the unit of q).
    eigenvalues : ndarray, shape (n,)
        Those of J in rad/s, slowest first.
    """

    parameter: Array
    omega: float
    state: Array
    algebraic: Array
    jacobian: Array
    eigenvalues: Complex

    @property
    def oscillating(self) -> Complex:
        """One eigenvalue of each conjugate pair (positive imaginary part), in rad/s, slowest first."""
        return self.eigenvalues[self.eigenvalues.imag > REAL_EIGENVALUE * np.abs(self.eigenvalues).max()]

    @property
    def frequencies(self) -> Array:
        """Undamped natural frequencies ``|lambda|`` of the oscillating pairs, in rad/s."""
        return np.abs(self.oscillating)

    @property
    def damped_frequencies(self) -> Array:
        """Damped natural frequencies Im(lambda) of the oscillating pairs, in rad/s."""
        return self.oscillating.imag

    @property
    def damping_ratios(self) -> Array:
        """Damping ratios ``-Re(lambda)/|lambda|`` of the oscillating pairs."""
        return -self.oscillating.real / np.abs(self.oscillating)


@dataclass(frozen=True, eq=False)
class RestFinder:
    """Finds the rest of `system` at any parameters, and linearises there; made once for many of them."""

    system: CompiledSystem

    @cached_property
    def _rows(self) -> ca.Function:
        e = self.system.expressions
        unknown = ca.vertcat(e.state, e.algebraic)
        results = [e.unexcited, ca.jacobian(e.unexcited, unknown), ca.jacobian(e.unexcited, e.rate)]
        return ca.Function("rest", [e.rate, e.state, e.algebraic, e.parameter], [*results, e.frequency])

    @interruptible()
    def modes(self, parameter: Array) -> Modes:
        """Return rest and small motion at a parameter vector (SI). Raises NoRestError."""
        n = len(self.system.states)
        point = self._rest(parameter)
        _, stiffness, inertia, omega = self._rows(np.zeros(n), point[:n], point[n:], parameter)
        jacobian = float(omega) * self._explicit(np.array(stiffness), np.array(inertia), parameter)
        eigenvalues = np.linalg.eigvals(jacobian).astype(np.complex128)
        scale = np.array([state.scale for state in self.system.states])
        return Modes(
            parameter=parameter,
            omega=float(omega),
            state=point[:n],
            algebraic=point[n:],
            jacobian=scale[:, None] * jacobian / scale,
            eigenvalues=eigenvalues[np.argsort(np.abs(eigenvalues), kind="stable")],
        )

    def _rest(self, parameter: Array) -> Array:
        """Return scaled states and unknowns at rest by Newton's method from the parts' own rest values."""
        n = len(self.system.states)
        point = np.concatenate(self.system.rest(parameter))
        for _ in range(20):
            rows = self._rows(np.zeros(n), point[:n], point[n:], parameter)
            residual, stiffness = np.array(rows[0]).ravel(), np.array(rows[1])
            if not np.isfinite(stiffness).all() or not np.isfinite(residual).all():
                break
            if np.linalg.matrix_rank(stiffness) < len(point):
                if np.abs(residual).max() < BALANCED_RESIDUAL:
                    return point
                break
            change = np.linalg.solve(stiffness, residual)
            point = point - change
            if np.abs(change).max() < 1e-13 * (1 + np.abs(point).max()):
                return point
        raise NoRestError(f"no equilibrium was found at {self._named(parameter)}")

    def _explicit(self, stiffness: Array, inertia: Array, parameter: Array) -> Array:
        """Return dx' = J dx from R_x dx + R_z dz + R_x' dx' = 0, shape (n, n), scaled."""
        n = inertia.shape[1]
        rates = np.concatenate([inertia, stiffness[:, n:]], axis=1)
        if np.linalg.matrix_rank(rates) < len(rates):
            raise NoRestError(f"the rates of small motion are not determined at {self._named(parameter)}")
        return np.linalg.solve(rates, -stiffness[:, :n])[:n]

    def _named(self, parameter: Array) -> str:
        names = [p.name for p in self.system.parameters]
        return ", ".join(f"{name} = {value:g}" for name, value in zip(names, parameter, strict=True))


def modes(system: CompiledSystem, values: Mapping[str, float] | None = None) -> Modes:
    """Return rest and small motion about it, d(dx)/dt = J dx.

    Parameters
    ----------
    system : CompiledSystem
        The system; its excitation is left out.
    values : mapping of str to float, optional
        Parameters (SI) that differ from their nominal values.

    Returns
    -------
    Modes
        Equilibrium, Jacobian, eigenvalues, frequencies and damping ratios.

    Raises
    ------
    ValueError
        For a name that is no parameter, and a value out of range.
    NoRestError
        Where no equilibrium is found.
    """
    system = all_states(system)
    return RestFinder(system).modes(with_values(system, {} if values is None else values))


def resonance(
    system: CompiledSystem,
    parameter: str,
    bounds: tuple[float, float],
    values: Mapping[str, float] | None = None,
) -> float | None:
    """Return where the excitation frequency meets the lowest natural frequency, ``omega(p) = |lambda(p)|``.

    Parameters
    ----------
    system : CompiledSystem
        The system.
    parameter : str
        Name of p, on which both frequencies depend.
    bounds : tuple of float
        Where to look, SI.
    values : mapping of str to float, optional
        Parameters (SI) that differ from their nominal values.

    Returns
    -------
    float or None
        p in SI. None where they do not meet between the bounds, nothing oscillates at one of them, or the
        lowest frequency jumps past the excitation's because a mode ceases to oscillate.

    Raises
    ------
    ValueError
        For a name that is no parameter or is also in `values`, and a value out of range.
    NoRestError
        Where no equilibrium is found.
    """
    varied, ends = varying(system, parameter, values), _ends(parameter, bounds)
    finder = RestFinder(all_states(system))

    def excess(value: float) -> float:
        found = finder.modes(varied(value))
        return found.omega / float(found.frequencies[0]) - 1 if len(found.frequencies) else math.inf

    excesses = [excess(bound) for bound in ends]
    if not all(map(math.isfinite, excesses)) or not excesses[0] * excesses[1] < 0:
        return None
    # An infinite excess inside has a sign to bisect by; what is found then may be a jump.
    root = float(scipy.optimize.brentq(excess, *ends, xtol=1e-13 * max(map(abs, ends)), rtol=1e-13))
    return root if abs(excess(root)) < FREQUENCIES_MEET else None


def varying(
    system: CompiledSystem, parameter: str, values: Mapping[str, float] | None
) -> Callable[[float], Array]:
    """Return from a value of one parameter to the vector of all of them (SI). Raises ValueError."""
    fixed = {} if values is None else values
    with_values(system, fixed)
    one_of("parameter", parameter, [p.name for p in system.parameters])
    if parameter in fixed:
        raise ValueError(f"parameter is {parameter!r}, which is also in values; it must be one or the other")
    return lambda value: with_values(system, {**fixed, parameter: value})


def _ends(parameter: str, bounds: object) -> tuple[float, float]:
    """The two bounds of a parameter. Raises ValueError."""
    given = sequence(f"bounds of {parameter}", bounds)
    if len(given) != 2:
        raise refusal(f"bounds of {parameter}", bounds, "two finite numbers")
    return given[0], given[1]
