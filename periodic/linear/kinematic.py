"""Rows q' = v of large systems, through which the stages of positions follow from those of velocities.

A kinematic row a dq' + b dv = -r has a single rate and a single other state. With h A, A = D^-1, which
integrates rates over the stages,

    dq_l = h sum_k A_lk dq'_k,   dq'_k = -(r_k + b_k dv_k) / a_k,

so that the rows left are those of the velocities alone: half the size, an eighth of the work.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array

PAYS_FROM = 8
"""Number of states from which eliminating kinematic rows saves time."""


@dataclass(frozen=True)
class Kinematic:
    """Kinematic rows with their positions and velocities (k,), the other rows and states (n-k,)."""

    rows: NDArray[np.int_]
    positions: NDArray[np.int_]
    velocities: NDArray[np.int_]
    other_rows: NDArray[np.int_]
    other_states: NDArray[np.int_]


def kinematic(by_rate: Array, by_state: Array) -> Kinematic | None:
    """Find the kinematic rows of R_x' and R_x, each (N, ncol, n, n); None of small systems or without any."""
    n = by_rate.shape[2]
    if n < PAYS_FROM:
        return None
    rates, states = ((values != 0).any(axis=(0, 1)) for values in (by_rate, by_state))
    rows = np.flatnonzero((rates.sum(axis=1) == 1) & (states.sum(axis=1) == 1))
    position, velocity = rates[rows].argmax(axis=1), states[rows].argmax(axis=1)
    once = [np.bincount(columns, minlength=n) == 1 for columns in (position, velocity)]
    kept = once[0][position] & once[1][velocity] & ~np.isin(velocity, position)
    kept &= (by_rate[:, :, rows, position] != 0).all(axis=(0, 1))
    if not kept.any():
        return None
    rows, position, velocity = rows[kept], position[kept], velocity[kept]
    left, states_left = np.setdiff1d(np.arange(n), rows), np.setdiff1d(np.arange(n), position)
    return Kinematic(rows, position, velocity, left, states_left)


def solve(found: Kinematic, by_rate: Array, by_state: Array, right: Array, weights: Array) -> Array:
    """Solve for the stages -right / (R_x' D + R_x), right (N, ncol, n, w), weights D (N, ncol, ncol)."""
    count, ncol, n, width = right.shape
    rows, position, others, states = found.rows, found.positions, found.other_rows, found.other_states
    slope = by_rate[:, :, rows, position]
    given = right[:, :, rows] / slope[..., None]
    ratio = by_state[:, :, rows, found.velocities] / slope
    integral = np.linalg.inv(weights).astype(float, copy=False)
    rate, state = by_rate[:, :, others], by_state[:, :, others]
    of_rates, of_positions = _columns(rate, position), _columns(state, position)

    matrix = _columns(rate, states)[:, :, :, None] * weights[:, :, None, :, None]
    each, column = np.arange(ncol), np.searchsorted(states, found.velocities)
    place = np.zeros((len(position), len(states)))
    place[np.arange(len(position)), column] = 1.0
    own = _columns(state, states) - (of_rates * ratio[:, :, None]) @ place
    matrix[:, each, :, each] += np.moveaxis(own, 1, 0)
    coupled = integral[:, :, :, None] * (ratio @ place)[:, None]
    matrix -= (of_positions @ place)[:, :, :, None] * coupled[:, :, None]

    aim = of_rates @ given + of_positions @ _along(integral, given) - right[:, :, others]
    size = ncol * len(states)
    solution = np.linalg.solve(matrix.reshape(count, size, size), aim.reshape(count, size, width))
    stages = np.empty((count, ncol, n, width))
    stages[:, :, states] = solution.reshape(count, ncol, len(states), width)
    rates = given + ratio[..., None] * stages[:, :, found.velocities]
    stages[:, :, position] = -_along(integral, rates)
    return stages


def _columns(values: Array, chosen: NDArray[np.int_]) -> Array:
    return np.ascontiguousarray(values[..., chosen])


def _along(matrix: Array, values: Array) -> Array:
    """Apply a matrix (N, ncol, ncol) to stages (N, ncol, k, w)."""
    return (matrix @ values.reshape(*values.shape[:2], -1)).reshape(values.shape)
