"""Where the equations, or their mean over the excitation, are at rest: Newton's method from many places."""

from __future__ import annotations

import numpy as np

from periodic.orbit.scheme import Array
from periodic.system import System

ITERATIONS = 60
"""Newton's steps towards an equilibrium."""

LONGEST = 0.25
"""Longest step, in widths of the box."""

RESTS = 1e-9
"""Step at an equilibrium, in widths of the box."""

HELD = 1e-6
"""Residual there, in what it changes by over the widths of the box."""


def at_rest(
    system: System, parameter: Array, x: Array, unit: Array, phases: Array
) -> list[tuple[Array, Array]]:
    """Return states (n,) and unknowns (m,) at which the mean of the equations over phases (K,) is at rest.

    x: states (S, n) from which it is looked for. unit: of distances between states, (n,).
    """
    n, z = x.shape[1], np.tile(system.rest(parameter)[1], (len(x), 1))
    found: list[tuple[Array, Array]] = []
    for _ in range(ITERATIONS):
        if not len(x):
            break
        residual, slope = _mean(system, parameter, x, z, phases)
        good = np.isfinite(slope).all(axis=(1, 2)) & np.isfinite(residual).all(axis=1)
        x, z, slope, residual = x[good], z[good], slope[good], residual[good]
        with np.errstate(over="ignore", invalid="ignore"):  # a slope of hardly any size
            step = -np.einsum("sij,sj->si", np.linalg.pinv(slope, rcond=1e-13), residual)
        good = np.isfinite(step).all(axis=1)
        x, z, step, slope, residual = x[good], z[good], step[good], slope[good], residual[good]
        size = np.abs(step[:, :n] / unit).max(axis=1, initial=0.0)
        units = np.append(unit, np.ones(slope.shape[2] - n))
        held = np.abs(residual) <= HELD * np.maximum(np.abs(slope) @ units, np.finfo(float).tiny)
        there = (size < RESTS) & held.all(axis=1)
        for state, unknowns in zip(x[there], z[there], strict=True):
            if all(np.abs((state - other) / unit).max() > np.sqrt(RESTS) for other, _ in found):
                found.append((state, unknowns))
        part = np.minimum(1.0, LONGEST / np.maximum(size, LONGEST))[:, None]
        x, z = (x + part * step[:, :n])[~there], system.move(z, part * step[:, n:])[~there]
    return found


def _mean(system: System, parameter: Array, x: Array, z: Array, phases: Array) -> tuple[Array, Array]:
    """The mean residuals (S, n + m) of states at rest and their derivatives (S, n + m, n + m)."""
    count = len(phases)
    many = np.repeat(x, count, axis=0)
    tau = np.tile(phases, len(x))
    line = system.linearise(np.zeros_like(many), many, np.repeat(z, count, axis=0), tau, parameter)
    slope = np.concatenate([line.d_state, line.d_algebraic], axis=2)
    each = (values.reshape(len(x), count, *values.shape[1:]) for values in (line.residual, slope))
    residual, slope = (values.mean(axis=1) for values in each)
    return residual, slope
