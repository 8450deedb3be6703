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
    """Collocation points on (0, 1].

    Parameters
    ----------
    family : Family
        Radau IIA or Gauss.
    ncol : int
        Number of points in each interval, from 2 to 7.

    Raises
    ------
    ValueError
        For another number.
    """

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
    def barycentric(self) -> Array:
        """Weights of the knots, 1 / prod_{i != j} (c_j - c_i), shape (ncol+1,)."""
        return barycentric(self.knots)

    @cached_property
    def inner_barycentric(self) -> Array:
        """Those of the collocation points alone, shape (ncol,)."""
        return barycentric(self.points)

    @cached_property
    def differentiation(self) -> Array:
        """D with p'(knot_i) = sum_l D[i, l] p(knot_l), shape (ncol+1, ncol+1)."""
        gaps, weights = self.knots[:, None] - self.knots + np.eye(len(self.knots)), self.barycentric
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
        if self.family is Family.GAUSS:
            return scipy.special.roots_legendre(self.ncol)[1] / 2
        nodes, weights = scipy.special.roots_jacobi(self.ncol - 1, 1, 0)
        return np.append(weights / (1 - nodes) / 2, 1 / self.ncol**2)

    @cached_property
    def halves(self) -> tuple[Array, Array, Array]:
        """What takes knots, and collocation points alone, to those of both halves, and to their common end.

        Shapes (2 ncol, ncol+1), (2 ncol, ncol) and (ncol+1,).
        """
        both = np.concatenate([self.points / 2, (1 + self.points) / 2])
        return self.basis(both), self.algebraic_basis(both), self.basis(np.array([0.5]))[0]

    def basis(self, theta: Array) -> Array:
        """Return the Lagrange polynomials of the knots.

        Parameters
        ----------
        theta : ndarray, shape (K,)
            Places in [0, 1].

        Returns
        -------
        ndarray, shape (K, ncol+1)
            One column a knot.
        """
        return lagrange(self.knots, self.barycentric, theta)

    def algebraic_basis(self, theta: Array) -> Array:
        """Return the Lagrange polynomials of the collocation points alone.

        Parameters
        ----------
        theta : ndarray, shape (K,)
            Places in [0, 1].

        Returns
        -------
        ndarray, shape (K, ncol)
            One column a point.
        """
        return lagrange(self.points, self.inner_barycentric, theta)


def barycentric(knots: Array) -> Array:
    """Return the weights 1 / prod_{i != j} (c_j - c_i) of knots c, shape (L,).

    Parameters
    ----------
    knots : ndarray, shape (L,)
        The knots.

    Returns
    -------
    ndarray, shape (L,)
        One weight a knot.
    """
    return 1 / (knots[:, None] - knots + np.eye(len(knots))).prod(axis=1)


def lagrange(knots: Array, weights: Array, theta: Array) -> Array:
    """Return the Lagrange polynomials l_j(theta) = w_j prod_{i != j} (theta - c_i).

    Parameters
    ----------
    knots, weights : ndarray, shape (L,)
        Their knots c and barycentric weights w.
    theta : ndarray, shape (K,)
        Where to evaluate them.

    Returns
    -------
    ndarray, shape (K, L)
        One column a polynomial.
    """
    factors = np.ones((len(knots) + 2, len(theta)))  # one on either side
    np.subtract(theta, knots[:, None], out=factors[1:-1])
    before = factors[:-2].cumprod(axis=0)
    after = factors[:1:-1].cumprod(axis=0)[::-1]
    return (before * after * weights[:, None]).T
