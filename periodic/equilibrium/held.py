"""Equilibria held at a fold or a Hopf point while two parameters vary.

A fold is where R_v, v = (x, z), is singular: the corner of a bordered matrix vanishes, as of orbits (see
`periodic.conditions.twoparameter.augmented`). At a Hopf point a pair of eigenvalues has the sum 0: with V a
basis of its invariant subspace, R_v V + R_x' V B = 0, and W the left one, W R_x' V = I,

    d tr B = -tr W (dR_v V + dR_x' V B),

which stays smooth where the pair becomes real, by differences of the equations' derivatives; what is held to
be zero is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from periodic.equilibrium.linearise import Rows, rows_at
from periodic.linear.invariantpair import subspaces, within
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.system.precision import difference_step

DIFFERENCE_STEP = difference_step(order=2)
"""Of central differences in scaled states, and in parameters as a part of their size."""

NEUTRAL = 1e-6
"""Sum of two real eigenvalues, in parts of their sizes, that is 0."""


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


def oscillating_row(system: System, orbit: Orbit, free: tuple[int, ...], near: Array) -> Row:
    """Return half the sum of a pair of eigenvalues per unit of tau and its gradient.

    The pair is the one whose subspace is nearest to the basis `near` (n, 2).
    """
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    rows = rows_at(system, orbit, ())
    values, vectors = np.linalg.eig(rows.jacobian)
    right, left = subspaces(rows.jacobian, within(near, vectors), values)
    block = left.T @ rows.jacobian @ right
    v = np.vstack([right, rows.unknowns @ right])
    w = np.linalg.solve(rows.d_motion.T, np.vstack([left, np.zeros((m, 2))]))

    def slope(rows: Rows) -> float:
        moved = _derivative(rows, n + m) @ v + rows.d_rate @ (right @ block)
        return -float(np.sum(w * moved)) / 2

    return _gathered(system, orbit, free, float(np.trace(block)) / 2, slope)


def oscillation(system: System, orbit: Orbit) -> Array:
    """Return a basis (n, 2) of the subspace of the complex pair of eigenvalues nearest to the imaginary axis.

    Of the real pair whose sum is 0, where there is one. Raises numpy.linalg.LinAlgError where there is
    neither.
    """
    jacobian = rows_at(system, orbit, ()).jacobian
    values = np.linalg.eigvals(jacobian)
    first, second = np.triu_indices(len(values), 1)
    sums = np.abs(values[first] + values[second]) / (np.abs(values[first]) + np.abs(values[second]))
    pairs = np.isclose(values[first], values[second].conj(), rtol=1e-12, atol=0) & (values[first].imag != 0)
    sums[~pairs & (sums > NEUTRAL)] = np.inf
    if not np.isfinite(sums).any():
        raise np.linalg.LinAlgError("no pair of eigenvalues is complex: the equilibrium is no Hopf point")
    k = int(sums.argmin())
    return subspaces(jacobian, [int(first[k]), int(second[k])], values)[0]


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
        [
            np.full(n + m, DIFFERENCE_STEP),
            DIFFERENCE_STEP * np.maximum(np.abs(orbit.parameter[list(free)]), DIFFERENCE_STEP),
        ]
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
