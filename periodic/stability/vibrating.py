"""The spectrum of an orbit about which perturbations vibrate faster than its mesh resolves."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Complex, Spectrum


@dataclass(frozen=True, eq=False)
class VibratingSpectrum(Spectrum):
    """Multipliers, and how far solutions turn, by more than their mesh points show.

    Parameters
    ----------
    turning : ndarray, shape (N, n, n)
        The mean over each interval of A in dx/dtau = A x, times the interval's width.
    """

    turning: Array = field(kw_only=True)

    def _rotated(self, solutions: Complex) -> Array:
        """How far solutions (N+1, n, k) turn: the integral of Im(w* A w)/|w|^2, by the trapezoidal rule."""
        ends = [_turned(self.turning, w) for w in (solutions[:-1], solutions[1:])]
        return np.asarray((ends[0] + ends[1]).sum(axis=0) / 2)


def _turned(turning: Array, solutions: Complex) -> Array:
    """Im(w* A w)/|w|^2 of solutions (N, n, k), times the widths of the intervals, shape (N, k)."""
    product = (solutions.conj() * (turning @ solutions)).sum(axis=1)
    size = (np.abs(solutions) ** 2).sum(axis=1)
    return np.asarray(product.imag / np.where(size > 0, size, 1.0))
