"""The algebraic unknowns away from collocation points: solved for there, never interpolated."""

from __future__ import annotations

import numpy as np

from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.system import System

ITERATIONS = 12
CLOSE = 1e-10
LONGEST = 5.0


def solve_algebraic(
    system: System, rate: Array, state: Array, guess: Array, tau: Array, parameter: Array
) -> Array:
    """Solve g(x', x, z, tau, p) = 0 for z at each point, shape (points, m), by Newton from a guess."""
    n, algebraic = state.shape[1], guess
    if algebraic.shape[1] == 0:
        return algebraic
    for _ in range(ITERATIONS):
        line = system.linearise(rate, state, algebraic, tau, parameter)
        finite = np.isfinite(line.residual).all(axis=1) & np.isfinite(line.d_algebraic).all(axis=(1, 2))
        change = np.zeros_like(algebraic)
        rows = line.d_algebraic[finite, n:]
        change[finite] = np.linalg.solve(rows, line.residual[finite, n:, None])[..., 0]
        algebraic = algebraic - np.clip(change, -LONGEST, LONGEST)
        if np.abs(change).max() < CLOSE:
            break
    return algebraic


def algebraic_at(system: System, orbit: Orbit, tau: Array) -> Array:
    """Return the unknowns at phases tau, shape (len(tau), m)."""
    guess = orbit.algebraic_guess(tau)
    return solve_algebraic(system, orbit.rate(tau), orbit.state(tau), guess, tau, orbit.parameter)
