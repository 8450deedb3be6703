"""Exponentials and their moments: the response of a mode to forces that are polynomials in an interval.

With l_b the Lagrange polynomials of the collocation points c_a on the unit interval,

    moment_ab(x) = int_0^{e_a} exp(x (e_a - s)) l_b(s) ds,

with e_a the collocation points, or other places given. It is computed by its Taylor series where |x| is
small, else in closed form with the derivatives of l_b.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import factorial

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array, Scheme

Complex = NDArray[np.complex128]

SERIES_UP_TO, TERMS = 3.0, 32
"""|x| up to which the Taylor series is taken, and its terms."""


@dataclass(frozen=True)
class Table:
    """exp(e_a x), moments and their derivatives in x at M values of x.

    growth (M, a), moment and slope (M, a, b).
    """

    growth: Complex
    moment: Complex
    slope: Complex

    def take(self, chosen: NDArray[np.int_], modes: int) -> Table:
        """Return the table of intervals, (N, J, ...), from this of widths, `modes` values of x for each."""
        arrays = [a.reshape(-1, modes, *a.shape[1:]) for a in (self.growth, self.moment, self.slope)]
        if len(arrays[0]) == 1:
            return Table(*(np.broadcast_to(a, (len(chosen), *a.shape[1:])) for a in arrays))
        return Table(*(a[chosen] for a in arrays))


@dataclass(frozen=True)
class Moments:
    """The tables of a scheme, at its collocation points or at other places of the unit interval.

    Parameters
    ----------
    scheme : Scheme
        Collocation points.
    ends : tuple of float
        The places e_a.
    """

    scheme: Scheme
    ends: tuple[float, ...] = ()

    @cached_property
    def places(self) -> Array:
        """The places e_a, (a,)."""
        return np.array(self.ends) if self.ends else self.scheme.points

    @cached_property
    def _monomials(self) -> Array:
        """l_b(s) = sum_p monomials[p, b] s^p."""
        points = self.scheme.points
        return np.linalg.inv(np.vander(points, increasing=True)).astype(float)

    @cached_property
    def taylor(self) -> Array:
        """Coefficients of x^m, shape (TERMS, a, b)."""
        points = self.places
        found = np.zeros((TERMS, len(points), self.scheme.ncol))
        for m in range(TERMS):
            for p, row in enumerate(self._monomials):
                power = points ** (p + m + 1) * (factorial(p) / factorial(p + m + 1))
                found[m] += power[:, None] * row
        return found

    @cached_property
    def derivatives(self) -> Array:
        """Derivatives of l_b at 0 and at the places, shape (order, 1+a, b)."""
        points, count = np.append(0.0, self.places), self.scheme.ncol
        found = np.zeros((count, len(points), count))
        for order in range(count):
            for p in range(order, count):
                factor = factorial(p) / factorial(p - order)
                found[order] += factor * points[:, None] ** (p - order) * self._monomials[p]
        return found

    def table(self, x: Complex) -> Table:
        """Return the table at values x, shape (M,)."""
        points, count = self.places, self.scheme.ncol
        growth = np.exp(x[:, None] * points)
        shape = (len(x), len(points), count)
        moment, slope = np.empty(shape, dtype=complex), np.empty(shape, dtype=complex)
        near = np.abs(x) <= SERIES_UP_TO
        if near.any():
            powers = np.vander(x[near], TERMS, increasing=True)
            series = self.taylor.reshape(TERMS, -1)
            order = np.arange(1, TERMS)[:, None]
            moment[near] = (powers @ series).reshape(-1, *shape[1:])
            slope[near] = (powers[:, :-1] @ (order * series[1:])).reshape(-1, *shape[1:])
        if not near.all():
            far = x[~near]
            inverse = np.vander(1 / far, count + 1, increasing=True)[:, 1:]
            steep = -inverse * np.arange(1, count + 1) / far[:, None]
            series = self.derivatives.reshape(count, -1)
            value = (inverse @ series).reshape(-1, 1 + len(points), count)
            change = (steep @ series).reshape(-1, 1 + len(points), count)
            grown = growth[~near, :, None]
            moment[~near] = grown * value[:, :1] - value[:, 1:]
            begun = points[:, None] * value[:, :1] + change[:, :1]
            slope[~near] = grown * begun - change[:, 1:]
        return Table(growth, moment, slope)
