"""Orbits of any rates y' = f(tau, y) confirmed by DOP853 alone, the monodromy matrix by differences.

What is integrated is written out by hand beside each machine: nothing of `symbolic` or `periodic` is in it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

from reference.integration import TWO_PI, Array

Rates = Callable[[float, Array], ArrayLike]
STEP = 1e-5
"""Of the central differences, relative to the size of each state: good for four digits beside kinks."""


@dataclass(frozen=True)
class Shot:
    """A periodic motion: its first state, and the matrix M of its perturbations over a period."""

    start: Array
    monodromy: Array
    path: Callable[[Array], Array]

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of M, largest modulus first."""
        found = np.linalg.eigvals(self.monodromy).astype(np.complex128)
        return found[np.argsort(-np.abs(found), kind="stable")]

    def peak_to_peak(self, state: int, count: int = 4001) -> float:
        """Peak to peak of a state, its extrema on parabolas through samples."""
        values = self.path(np.linspace(0, TWO_PI, count))[state]
        return _top(values) + _top(-values)


def _top(values: Array) -> float:
    ring = values[:-1]
    k = int(ring.argmax())
    a, b, c = ring[k - 1], ring[k], ring[(k + 1) % len(ring)]
    curved = a - 2 * b + c
    return float(b - (a - c) ** 2 / (8 * curved) if curved else b)


def shot(rates: Rates, guess: ArrayLike, size: ArrayLike, rtol: float = 1e-12, step: float = STEP) -> Shot:
    """Newton on y(2 pi) = y(0) from a guess; tolerances and steps of differences are parts of `size`."""
    y, scale = np.array(guess, dtype=float), np.array(size, dtype=float)

    def end(begin: Array) -> Array:
        return np.asarray(_run(rates, begin, scale, rtol).y[:, -1])

    for _ in range(12):
        gap = end(y) - y
        aside = step * np.diag(scale)
        monodromy = np.array([(end(y + e) - end(y - e)) / (2 * e.sum()) for e in aside]).T
        if np.abs(gap / scale).max() < 1e3 * rtol:
            return Shot(y, monodromy, _run(rates, y, scale, rtol, dense=True).sol)
        y = y + np.linalg.solve(np.eye(len(y)) - monodromy, gap)
    raise ArithmeticError("shooting did not converge")


def _run(rates: Rates, begin: Array, scale: Array, rtol: float, dense: bool = False):  # type: ignore[no-untyped-def]
    tight = {"method": "DOP853", "rtol": rtol, "atol": rtol * scale, "max_step": TWO_PI / 60}
    found = solve_ivp(rates, (0.0, TWO_PI), begin, dense_output=dense, **tight)
    assert found.success, found.message
    return found
