"""Own states that depend on the motion and on themselves, not on each other, as the strains of sliders.

At the points l of an interval of width h such a state s has

    r_l s'_l + q_l s_l + (forces and what is given)_l = 0,    s' = D s / h,

a small system for each state. So own states follow from the forces, and the equations left are those of the
forces alone (a Schur complement).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array


@dataclass(frozen=True)
class Carried:
    """Equations of the points of intervals in which own states follow from the forces one by one.

    Parameters
    ----------
    slopes, values : ndarray, shape (N, a, o)
        Coefficients r and q of the rates of own states, and of these, in their own rows.
    upon : ndarray, shape (N, a, k, o)
        Coefficients of own states in the rows of the k forces.
    """

    slopes: Array
    values: Array
    upon: Array

    @classmethod
    def of(cls, rows: Array, others: NDArray[np.int_], n: int, forces: int) -> Carried | None:
        """Return those of rows (N, a, k + o, 1 + 2n + ..), or None where own states depend on each other.

        others: which of the n states are own ones.
        """
        by_rate, by_state = rows[..., 1 + others], rows[..., 1 + n + others]
        slopes, values = (np.diagonal(each[:, :, forces:], axis1=2, axis2=3) for each in (by_rate, by_state))
        apart = all(
            np.count_nonzero(each[:, :, forces:]) == np.count_nonzero(own)
            for each, own in ((by_rate, slopes), (by_state, values))
        )
        if not apart or by_rate[:, :, :forces].any():
            return None
        return cls(slopes, values, by_state[:, :, :forces])

    def solved(self, block: Array, right: Array, rates: Array, width: Array) -> Array:
        """Return forces and own states at the points by what is given, (N, a k + a o, w).

        block (N, a, k + o, a k) and right (N, a, k + o, w): the rows' coefficients of the forces and of what
        is given. rates (a, a): D. width (N,): h. Raises numpy.linalg.LinAlgError.
        """
        (count, points, forces, own), size = self.upon.shape, block.shape[3]
        rows = np.concatenate([block, right], axis=3)
        own_rows = np.ascontiguousarray(np.swapaxes(rows[:, :, forces:], 1, 2))
        follow = np.ascontiguousarray(np.swapaxes(self._following(rates, width) @ own_rows, 1, 2))
        left = (rows[:, :, :forces] + self.upon @ follow).reshape(count, size, -1)
        found = np.linalg.solve(left[..., :size], -left[..., size:])
        each = follow.reshape(count, points * own, -1)
        return np.concatenate([found, each[..., size:] + each[..., :size] @ found], axis=1)

    def _following(self, rates: Array, width: Array) -> Array:
        """Own states at the points by the rest of their rows, (N, o, a, a)."""
        slopes, values = (np.swapaxes(each, 1, 2) for each in (self.slopes, self.values))
        each = slopes[..., None] * (rates / width[:, None, None])[:, None]
        same = np.arange(len(rates))
        each[..., same, same] += values
        return -np.linalg.inv(each).astype(float, copy=False)
