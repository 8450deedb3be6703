"""Vibrations too fast for the mesh: the error that they make in the multipliers.

A stiffly accurate scheme damps vibrations that it does not resolve. That does a slow orbit no harm, but the
multiplier of a fast vibration comes out near 0, on the halved mesh as well, so that the error estimate does
not show it. Its true modulus is about exp of the integral of Re lambda over the period, lambda an eigenvalue
of the Jacobian in dx' = J dx (the adiabatic approximation, as the vibration is fast).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import System

FAST = 4.0
"""Turn of a vibration in an interval (rad) above which it is examined; below, the halved mesh shows it."""

Complex = NDArray[np.complex128]


def lost(system: System, orbit: Orbit) -> float:
    """Return by how much the multiplier of the least damped such vibration is computed too small."""
    width = orbit.grid.width
    jacobian = jacobians(system, orbit) * width[:, None, None]
    with np.errstate(over="ignore", invalid="ignore"):  # what is beyond all numbers is large
        large = ~(np.abs(jacobian @ jacobian).sum(axis=2).max(axis=1) <= FAST**2)
    if not (large.any() and np.isfinite(jacobian).all()):
        return 0.0
    exponents = np.linalg.eigvals(jacobian[large]).astype(np.complex128)
    fast = np.abs(exponents.imag) > FAST
    held = fast.any(axis=1)
    if not held.any():
        return 0.0
    least = np.where(fast, exponents.real, -np.inf)[held].argmax(axis=1)
    exponents = exponents[held][np.arange(held.sum()), least]
    true = exponents.real.sum()
    found = np.minimum(exponents.real, np.log(np.abs(growth(orbit.mesh.scheme, exponents)))).sum()
    return float(np.exp(min(true, 0.0)) - np.exp(min(found, 0.0)))


def jacobians(system: System, orbit: Orbit) -> Array:
    """Return J of dx' = J dx about the middle of every interval, (N, n, n); NaN where it has none."""
    k, n = orbit.mesh.scheme.ncol // 2, orbit.nodes.shape[1]
    at = orbit.knot_rates[:, 1 + k], orbit.stages[:, k], orbit.algebraic[:, k], orbit.stage_phases[:, k]
    found = system.linearise(*at, orbit.parameter)
    rates = np.concatenate([found.d_rate, found.d_algebraic], axis=2)
    try:
        return np.linalg.solve(rates, -found.d_state)[:, :n].astype(float, copy=False)
    except np.linalg.LinAlgError:  # the matrix of the rates is singular there
        return np.full((len(rates), n, n), np.nan)


def growth(scheme: Scheme, exponents: Complex) -> Complex:
    """Return what the scheme makes of exp(z) in one interval: its stability function, shape of z (k,)."""
    inner = scheme.differentiation[1:, 1:] - exponents[:, None, None] * np.eye(scheme.ncol)
    start = np.broadcast_to(-scheme.differentiation[1:, :1], (len(exponents), scheme.ncol, 1))
    stages = np.linalg.solve(inner, start.astype(np.complex128))[:, :, 0]
    end = scheme.basis(np.array([1.0]))[0]
    return end[0] + stages @ end[1:]
