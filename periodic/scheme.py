"""Collocation points and the polynomials through them, on the unit interval.

Radau IIA (right end included) is stiffly accurate and keeps multipliers right through loss of contact;
Gauss points give the higher order 2 ncol at mesh points for smooth problems (Hairer & Wanner, Solving
ODEs II, IV.5).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Family(Enum):
    """Families of collocation points."""

    RADAU = "Radau IIA"
    GAUSS = "Gauss"


@dataclass(frozen=True)
class Scheme:
    """`ncol` collocation points of a family on (0, 1]; ncol from 2 to 7."""

    family: Family = Family.RADAU
    ncol: int = 4

    def __post_init__(self) -> None:
        if self.ncol not in range(2, 8):
            raise ValueError(f"ncol is {self.ncol}; it must be a whole number from 2 to 7")

    @cached_property
    def points(self) -> Array:
        """Collocation points c, shape (ncol,)."""
        if self.family is Family.GAUSS:
            return (scipy.special.roots_legendre(self.ncol)[0] + 1) / 2
        interior = scipy.special.roots_jacobi(self.ncol - 1, 1, 0)[0]
        return np.append((interior + 1) / 2, 1.0)

    @cached_property
    def knots(self) -> Array:
        """Points that carry the state polynomial: 0 and the collocation points, shape (ncol+1,)."""
        return np.append(0.0, self.points)

    @cached_property
    def differentiation(self) -> Array:
        """D with p'(knot_i) = sum_l D[i, l] p(knot_l), shape (ncol+1, ncol+1)."""
        gaps = self.knots[:, None] - self.knots[None, :] + np.eye(len(self.knots))
        weights = 1 / gaps.prod(axis=1)
        matrix = weights[None, :] / weights[:, None] / gaps
        np.fill_diagonal(matrix, 0.0)
        np.fill_diagonal(matrix, -matrix.sum(axis=1))
        return matrix

    @cached_property
    def stage_rates(self) -> Array:
        """The rows of D at the collocation points, shape (ncol, ncol+1)."""
        return np.ascontiguousarray(self.differentiation[1:])

    @cached_property
    def end(self) -> Array:
        """Weights of the knots' values in the value at 1, shape (ncol+1,)."""
        return self.basis(np.array([1.0]))[0]

    @cached_property
    def weights(self) -> Array:
        """Weights of the quadrature at the collocation points, shape (ncol,); their sum is 1."""
        powers = np.arange(self.ncol)
        moments = np.linalg.solve(self.points[None, :] ** powers[:, None], 1 / (powers + 1))
        return moments.astype(float, copy=False)

    def basis(self, theta: Array) -> Array:
        """Lagrange polynomials of the knots at theta, shape (len(theta), ncol+1)."""
        return lagrange(self.knots, theta)

    def algebraic_basis(self, theta: Array) -> Array:
        """Lagrange polynomials of the collocation points alone, shape (len(theta), ncol)."""
        return lagrange(self.points, theta)


def lagrange(knots: Array, theta: Array) -> Array:
    """Lagrange polynomials of `knots` at `theta`, shape (len(theta), len(knots))."""
    gaps = knots[:, None] - knots + np.eye(len(knots))
    factors = np.ones((len(knots) + 2, len(theta)))  # one on either side
    factors[1:-1] = theta - knots[:, None]
    before = np.cumprod(factors[:-2], axis=0)
    after = np.cumprod(factors[:1:-1], axis=0)[::-1]
    return (before * after / gaps.prod(axis=1)[:, None]).T
