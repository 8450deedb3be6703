"""Where a closed curve is known: at equispaced angles, or between breaks at which its derivatives jump.

Without breaks a curve is a Fourier series through M equispaced angles. A section that crosses a surface, as a
contact, is smooth between such crossings alone: there it is a polynomial in each of the pieces, through
Gauss' points, and what is wrong with it shrinks with their number as it does for smooth curves.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
from numpy.polynomial import legendre

from periodic.orbit.scheme import Array

TURN = 2 * np.pi

FEWEST = 6
"""Points of a piece, at least."""


@dataclass(frozen=True, eq=False)
class Grid:
    """M angles of a curve; breaks (B,): rising angles in [0, 2 pi), none or more than one."""

    count: int
    breaks: Array = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def angles(self) -> Array:
        """The angles, (M,)."""
        if not len(self.breaks):
            return TURN * np.arange(self.count) / self.count
        pieces = zip(self.breaks, self._widths, self._sizes, strict=True)
        return np.concatenate([at + wide * (1 + _points(n)[0]) / 2 for at, wide, n in pieces])

    @cached_property
    def weights(self) -> Array:
        """Weights of an average over the curve, (M,)."""
        if not len(self.breaks):
            return np.full(self.count, 1 / self.count)
        pieces = zip(self._widths, self._sizes, strict=True)
        return np.concatenate([_points(n)[1] * wide / 2 / TURN for wide, n in pieces])

    def interpolation(self, at: Array) -> tuple[Array, Array]:
        """Return the matrices (K, M) that make the curve and its slope at angles (K,) of its values."""
        if not len(self.breaks):
            return _fourier(self.count, at)
        value, slope = np.zeros((len(at), self.count)), np.zeros((len(at), self.count))
        since = np.mod(at - self.breaks[0], TURN)
        piece = np.searchsorted(self.breaks - self.breaks[0], since, side="right") - 1
        first = 0
        for k, (wide, n) in enumerate(zip(self._widths, self._sizes, strict=True)):
            mine = np.flatnonzero(piece == k)
            local = 2 * (since[mine] - (self.breaks[k] - self.breaks[0])) / wide - 1
            terms, inverse = legendre.legvander(local, n - 1), _transform(n)
            own = np.arange(first, first + n)
            value[np.ix_(mine, own)] = terms @ inverse
            slope[np.ix_(mine, own)] = terms @ _derivative(n) @ inverse * 2 / wide
            first += n
        return value, slope

    def tail(self, states: Array) -> float:
        """Return the two highest harmonics, or terms of a piece, relative to the curve: an error estimate."""
        if not len(self.breaks):
            size = np.abs(np.fft.rfft(states, axis=0))[1:].max(axis=1)
            return float(size[-2:].max() / max(size.max(), np.finfo(float).tiny))
        ends = np.cumsum(self._sizes)
        each = [_transform(n) @ states[end - n : end] for n, end in zip(self._sizes, ends, strict=True)]
        largest = np.abs(states - self.weights @ states).max()
        return float(max(np.abs(terms[-2:]).max() for terms in each) / max(largest, np.finfo(float).tiny))

    @cached_property
    def _widths(self) -> Array:
        return np.diff(np.append(self.breaks, self.breaks[0] + TURN))

    @cached_property
    def _sizes(self) -> tuple[int, ...]:
        """Points of each piece: as many, but for a rest that the widest have."""
        pieces = len(self.breaks)
        sizes = np.full(pieces, self.count // pieces)
        sizes[np.argsort(-self._widths, kind="stable")[: self.count % pieces]] += 1
        return tuple(int(n) for n in sizes)


def _fourier(count: int, at: Array) -> tuple[Array, Array]:
    """Dirichlet's kernel and its slope, at angles less those that are equispaced."""
    order = np.arange(1, count // 2 + 1)
    there = np.multiply.outer(at, order)
    own = np.multiply.outer(order, TURN * np.arange(count) / count)
    cos, sin = np.cos(there), np.sin(there)
    value = 1 + 2 * (cos @ np.cos(own) + sin @ np.sin(own))
    slope = 2 * ((cos * order) @ np.sin(own) - (sin * order) @ np.cos(own))
    return value / count, slope / count


@cache
def _points(count: int) -> tuple[Array, Array]:
    """Gauss' points in (-1, 1) and their weights."""
    nodes, weights = legendre.leggauss(count)
    return np.asarray(nodes), np.asarray(weights)


@cache
def _transform(count: int) -> Array:
    """What makes the terms of Legendre's series of values at Gauss' points."""
    nodes, weights = _points(count)
    terms = legendre.legvander(nodes, count - 1) * weights[:, None]
    return np.asarray(terms.T * (np.arange(count) + 0.5)[:, None])


@cache
def _derivative(count: int) -> Array:
    """What makes the terms of a series' derivative of its own."""
    return np.vstack([legendre.legder(np.eye(count)), np.zeros(count)])
