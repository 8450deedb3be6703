"""The algebraic unknowns away from collocation points: solved for there, never interpolated."""

from __future__ import annotations

import numpy as np

from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.system.precision import MOST_ITERATIONS

UNKNOWN_INCREMENT = 1e-10
LONGEST_STEP = 5.0


def solve_algebraic(
    system: System, rate: Array, state: Array, guess: Array, tau: Array, parameter: Array
) -> Array:
    """Solve g(x', x, z, tau, p) = 0 for z at each of K points by Newton's method.

    Parameters
    ----------
    system : System
        The system whose last m rows are g.
    rate, state : ndarray, shape (K, n)
        dx/dtau and x, scaled.
    guess : ndarray, shape (K, m)
        Where to start.
    tau : ndarray, shape (K,)
        Phases in rad.
    parameter : ndarray, shape (p,)
        The parameters in SI.

    Returns
    -------
    ndarray, shape (K, m)
        z, after MOST_ITERATIONS iterations at most.
    """
    n, algebraic = state.shape[1], guess
    if algebraic.shape[1] == 0:
        return algebraic
    for _ in range(MOST_ITERATIONS):
        line = system.linearise(rate, state, algebraic, tau, parameter)
        finite = np.isfinite(line.residual).all(axis=1) & np.isfinite(line.d_algebraic).all(axis=(1, 2))
        change = np.zeros_like(algebraic)
        rows = line.d_algebraic[finite, n:]
        change[finite] = np.linalg.solve(rows, line.residual[finite, n:, None])[..., 0]
        algebraic = algebraic - np.clip(change, -LONGEST_STEP, LONGEST_STEP)
        if np.abs(change).max() < UNKNOWN_INCREMENT:
            break
    return algebraic


def algebraic_at(system: System, orbit: Orbit, tau: Array) -> Array:
    """Return the unknowns of an orbit, solved for at each phase.

    Parameters
    ----------
    system : System
        The system.
    orbit : Orbit
        The orbit.
    tau : ndarray, shape (K,)
        Phases in rad.

    Returns
    -------
    ndarray, shape (K, m)
        Scaled unknowns.
    """
    guess = orbit.algebraic_guess(tau)
    return solve_algebraic(system, orbit.rate(tau), orbit.state(tau), guess, tau, orbit.parameter)
