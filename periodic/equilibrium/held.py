"""Equilibria held at a fold or a Hopf point while two parameters vary.

A fold is where R_v, v = (x, z), is singular: the corner of a bordered matrix vanishes, as of orbits (see
`periodic.conditions.augmented`). At a Hopf point a pair of eigenvalues has the sum 0: with R_v v + lambda
R_x' v / omega = 0 and w the left eigenvector,

    d lambda = -w (dR_v + lambda dR_x' / omega) v / (w R_x' v / omega),

by differences of the equations' derivatives; what is held to be zero is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.equilibrium.linearise import Rows, rows_at
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System

STEP = 1e-5
"""Step of central differences in scaled states, and in parameters as a part of their size."""

Complex = NDArray[np.complex128]


def singular_row(
    system: System,
    orbit: Orbit,
    free: tuple[int, ...],
    around: Callable[[Array], tuple[float, Array, Array]],
) -> Row:
    """Return g, which vanishes where R_v is singular, with its gradient; `around` borders a matrix."""
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    value, right, left = around(_derivative(rows_at(system, orbit, ()), n + m))

    def slope(rows: Rows) -> float:
        return -float(left @ _derivative(rows, n + m) @ right)

    return _gathered(system, orbit, free, value, slope)


def oscillating_row(
    system: System, orbit: Orbit, free: tuple[int, ...], near: complex | None
) -> tuple[Row, complex]:
    """Return Re lambda per unit of tau with its gradient, and lambda, of the pair nearest to `near`.

    Without one it is the complex pair nearest to the imaginary axis. Raises numpy.linalg.LinAlgError where
    no pair is complex.
    """
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    rows = rows_at(system, orbit, ())
    rate = np.hstack([rows.d_rate, np.zeros((n + m, m))])
    values, left, right = scipy.linalg.eig(-_derivative(rows, n + m), rate, left=True, right=True)
    upper = np.flatnonzero(np.isfinite(values) & (values.imag > 0))
    if len(upper) == 0:
        raise np.linalg.LinAlgError("no pair of eigenvalues is complex: the Hopf point has become a saddle")
    away = (
        np.abs(values[upper].real) / np.abs(values[upper]) if near is None else np.abs(values[upper] - near)
    )
    k = int(upper[away.argmin()])
    v, w, found = right[:, k], left[:, k].conj(), complex(values[k])
    size = w @ rate @ v

    def slope(rows: Rows) -> float:
        moved = _derivative(rows, n + m) @ v + found * (rows.d_rate @ v[:n])
        return float((-(w @ moved) / size).real)

    return _gathered(system, orbit, free, found.real, slope), found


def _derivative(rows: Rows, size: int) -> Array:
    """R_v, shape (n+m, n+m)."""
    return rows.d_unknown[:, :size]


def _gathered(
    system: System, orbit: Orbit, free: tuple[int, ...], value: float, slope: Callable[[Rows], float]
) -> Row:
    """The row of a number whose change is linear in that of the equations' derivatives, z eliminated."""
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    rows = rows_at(system, orbit, free)
    steps = np.concatenate(
        [np.full(n + m, STEP), STEP * np.maximum(np.abs(orbit.parameter[list(free)]), STEP)]
    )

    def beside(k: int, step: float) -> Rows:
        change, parameter = np.zeros(n + m + len(free)), orbit.parameter.copy()
        change[k] = step
        parameter[list(free)] += change[n + m :]
        states, unknowns = orbit.nodes + change[:n], orbit.algebraic + change[n : n + m]
        return rows_at(system, replace(orbit, nodes=states, algebraic=unknowns, parameter=parameter), ())

    gradient = np.array(
        [(slope(beside(k, h)) - slope(beside(k, -h))) / (2 * h) for k, h in enumerate(steps)], dtype=float
    )
    if m:
        algebraic = rows.d_unknown[n:]
        weights = -np.linalg.solve(algebraic[:, n : n + m].T, gradient[n : n + m])
        gradient = gradient + weights @ algebraic
        value += float(weights @ rows.residual[n:])
    nodes = np.zeros_like(orbit.nodes)
    nodes[0] = gradient[:n]
    return Row(value, nodes, gradient[n + m :])
