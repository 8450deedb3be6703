"""The linear part of a rotor over its speed: natural frequencies, damping, critical speeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from symbolic.arrays import Array
from symbolic.checks import positive, refusal, sequence, whole
from symbolic.structures.flexibility import damping_at
from symbolic.structures.matrices import DENSE, Matrices, dense

RIGID = 1e-7
"""Part of the largest eigenvalue up to which rounding makes frequencies of double zeros (as eps^(1/2))."""


@dataclass(frozen=True, eq=False)
class Campbell:
    """Natural frequencies of a structure over its speed.

    Parameters
    ----------
    speeds : ndarray, shape (N,)
        Omega in rad/s.
    frequencies : ndarray, shape (N, k)
        Damped natural frequencies Im(lambda) in rad/s, ascending; NaN where fewer than k oscillate. What
        decays to rounding within a period does not, as pairs that gyroscopic moments make of overdamped ones.
    damping : ndarray, shape (N, k)
        Damping ratios ``-Re(lambda)/|lambda|``; negative where the rotor is unstable.
    """

    speeds: Array
    frequencies: Array
    damping: Array

    def critical(self, order: float = 1.0) -> Array:
        """Return the critical speeds at which a natural frequency is a multiple of the speed.

        Parameters
        ----------
        order : float
            frequency = order * speed; 1 for unbalance.

        Returns
        -------
        ndarray
            Speeds in rad/s, ascending, by linear interpolation between the speeds of the diagram.

        Raises
        ------
        ValueError
            For an order that is not positive.
        """
        apart = self.frequencies - positive("order", order) * self.speeds[:, None]
        rows, columns = np.nonzero(apart[:-1] * apart[1:] <= 0)
        before, after = apart[rows, columns], apart[rows + 1, columns]
        gap = np.where(before == after, 1.0, before - after)
        return np.unique(self.speeds[rows] + (self.speeds[rows + 1] - self.speeds[rows]) * before / gap)


def campbell(matrices: Matrices, speeds: Sequence[float], count: int = 6) -> Campbell:
    """Return the natural frequencies of M q'' + (C + Omega G) q' + K q = 0 over the speed Omega.

    Parameters
    ----------
    matrices : Matrices
        The structure; reduce it first where it has more than some hundred degrees of freedom.
    speeds : sequence of float
        Omega in rad/s, ascending.
    count : int
        How many frequencies, the lowest first.

    Returns
    -------
    Campbell
        Frequencies and damping ratios.

    Raises
    ------
    ValueError
        For speeds that do not ascend, and a structure too large for it.
    """
    given = np.array(sequence("speeds", speeds))
    if (np.diff(given) <= 0).any():
        raise refusal("speeds", speeds, "ascending")
    if matrices.size > DENSE:
        raise ValueError(
            f"the structure has {matrices.size} freedoms; a Campbell diagram takes at most {DENSE}: "
            f"reduce it by symbolic.craig_bampton"
        )
    rows = [_oscillating(matrices, speed, whole("count", count, 1)) for speed in given]
    values = np.array(rows)
    return Campbell(given, values.imag, -values.real / np.abs(values))


def _oscillating(matrices: Matrices, speed: float, count: int) -> Array:
    """The lowest eigenvalues of motions of which something is left after a period, rad/s."""
    mass, n = dense(matrices.M), matrices.size
    lower = np.linalg.solve(mass, np.hstack([-dense(matrices.K), -dense(damping_at(matrices, speed))]))
    values = np.linalg.eigvals(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]))
    rigid = values.imag <= RIGID * np.abs(values).max()
    decays = 2 * np.pi * np.abs(values.real) >= -math.log(np.finfo(float).eps) * values.imag
    found = values[~rigid & ~decays]
    found = found[np.argsort(found.imag)][:count]
    return np.r_[found, np.full(count - len(found), np.nan + 1j * np.nan)]
