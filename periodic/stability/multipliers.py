"""The Floquet multipliers of an orbit, from its fundamental matrices, computed once."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.linear.unknowns import Increment
from periodic.orbit.scheme import Array
from periodic.system.precision import CONVERGED, SMALLEST

Complex = NDArray[np.complex128]

ERRORS_FROM_ONE = 100.0
"""A multiplier counts as 1 if its distance from 1 is less than this many times the multipliers' error,"""

ROUNDED_ONE = 1e-10
"""... or less than this."""

LOST_FLOW = 0.1
"""Distance of the trivial multiplier from 1 above which those of a long orbit are lost in rounding."""


class Stability(Enum):
    """What decides stability: multipliers and the unit circle, or eigenvalues and the imaginary axis."""

    MULTIPLIERS = "Floquet multipliers"
    EIGENVALUES = "eigenvalues of the Jacobian"


@dataclass(frozen=True)
class Pair:
    """A complex pair of multipliers: argument, modulus, distance from +1, and how far its solution w turns.

    rotated: the mean rotation of all components, the integral of Im(w* dw)/|w|^2 over the period. Unlike
    that of a single component, which may pass through 0, it changes smoothly with the orbit.
    left: left eigenvector (n,), scaled so that 2 |left x| is the largest size within the period of the pair's
    part of a disturbance that is x at its beginning; None where eigenvectors coincide.
    place: its index among the multipliers.
    """

    argument: float
    modulus: float
    distance: float
    rotated: float
    left: Complex | None = None
    place: int = 0

    def turn(self, other: Pair) -> float:
        """Return the change of argument to the multiplier of another orbit, whole turns included."""
        least = other.argument - self.argument
        return least + math.tau * round((other.rotated - self.rotated - least) / math.tau)

    def _apart(self, other: Pair, sign: int) -> float:
        """Distance of another orbit's pair, for -1 of its conjugate: changes of argument and of rotation."""
        least, along = sign * other.argument - self.argument, sign * other.rotated - self.rotated
        return abs(least + math.tau * round((along - least) / math.tau)) + abs(along)

    def nearest(self, others: Sequence[Pair]) -> Pair:
        """Return the member of another orbit's pairs that continues this one."""
        both = ((other, sign) for sign in (1, -1) for other in others)
        found, sign = min(both, key=lambda choice: self._apart(*choice))
        return found if sign > 0 else found.conjugate()

    def conjugate(self) -> Pair:
        """Return the pair's other member."""
        left = None if self.left is None else self.left.conj()
        return replace(self, argument=-self.argument, rotated=-self.rotated, left=left)


FEW_PAIRS = 3
"""Up to this many pairs a loop over them is faster than arrays."""


def nearest(pairs: Sequence[Pair], others: Sequence[Pair]) -> list[Pair]:
    """Return the members of another orbit's pairs that continue each of these, see `Pair.nearest`."""
    if len(pairs) <= FEW_PAIRS:
        return [pair.nearest(others) for pair in pairs]
    own, other = (np.array([(pair.argument, pair.rotated) for pair in some]) for some in (pairs, others))
    least, along = np.moveaxis(np.concatenate([other, -other]) - own[:, None], 2, 0)
    apart = np.abs(least + math.tau * np.round((along - least) / math.tau)) + np.abs(along)
    chosen = map(int, apart.argmin(axis=1))
    return [others[k] if k < len(others) else others[k - len(others)].conjugate() for k in chosen]


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Multipliers and their solutions.

    Parameters
    ----------
    fundamental : ndarray, shape (N+1, n, n)
        Fundamental matrices at the mesh points, the last of which is the monodromy matrix; of an equilibrium
        the Jacobian in 1/s, shape (1, n, n).
    trivial : int
        Number of trivial multipliers, which are 1 at all parameters.
    """

    fundamental: Array
    trivial: int = 0

    @property
    def monodromy(self) -> Array:
        """The monodromy matrix, shape (n, n)."""
        return self.fundamental[-1]

    @property
    def frame(self) -> Array | None:
        """Orthonormal basis (coordinates, n) that the matrix is written in; None where it is the states'."""
        return None

    @cached_property
    def _eigen(self) -> tuple[Complex, Complex]:
        values, vectors = np.linalg.eig(self.monodromy)
        return values.astype(np.complex128), vectors.astype(np.complex128)

    @property
    def multipliers(self) -> Complex:
        """Eigenvalues of the monodromy matrix, shape (n,), in no order."""
        return self._eigen[0]

    @property
    def vectors(self) -> Complex:
        """Their eigenvectors, shape (n, n), one a column."""
        return self._eigen[1]

    @cached_property
    def nontrivial(self) -> Complex:
        """The multipliers without those that are 1 whatever the parameters."""
        return without_trivial(self.multipliers, self.trivial)

    @cached_property
    def pairs(self) -> list[Pair]:
        """A member of each complex pair of multipliers that is not 1 whatever the parameters."""
        multipliers = self.multipliers
        upper = multipliers.imag > 0
        upper[np.abs(multipliers - 1).argsort()[: self.trivial]] = False
        chosen = np.flatnonzero(upper)
        solutions = self.fundamental @ self.vectors[:, chosen]
        both = zip(map(int, chosen), self._rotated(solutions), self._sizes(solutions, chosen), strict=True)
        return [self._pair(k, float(turn), size) for k, turn, size in both]

    def _rotated(self, solutions: Complex) -> Array:
        """How far solutions (N+1, n, k) turn in the period, shape (k,)."""
        return np.asarray(_rotations(solutions[:-1], solutions[1:]).sum(axis=0))

    def _pair(self, k: int, rotated: float, size: float) -> Pair:
        mu, left = complex(self.multipliers[k]), self._left(k)
        left = None if left is None else left * size
        return Pair(cmath.phase(mu), abs(mu), abs(1 - mu), rotated, left, k)

    def _sizes(self, solutions: Complex, chosen: NDArray[np.int_]) -> Array:
        """Largest size within the period of solutions (N+1, n, k) that begin with the chosen eigenvectors."""
        return np.asarray(np.abs(solutions).max(axis=(0, 1), initial=0.0))

    @cached_property
    def _inverse(self) -> Complex | None:
        """Left eigenvectors, one a row, with products of 1 with the right ones; None where some coincide."""
        try:
            found = np.linalg.inv(self.vectors).astype(np.complex128)
        except np.linalg.LinAlgError:
            return None
        return found if np.abs(found).max() < 1 / CONVERGED else None

    @cached_property
    def _triangle(self) -> tuple[Complex, Complex]:
        """M = Q T Q* with T upper triangular."""
        found = scipy.linalg.schur(self.monodromy, output="complex")
        return found[0].astype(np.complex128), found[1].astype(np.complex128)

    def _left(self, k: int) -> Complex | None:
        """The left eigenvector whose product with the right one is 1; None where these coincide with others.

        It is solved for alone, in the triangle T, where the matrix of all eigenvectors is singular: those of
        multipliers near 0 coincide.
        """
        if self._inverse is not None:
            return np.asarray(self._inverse[k])
        triangle, rotated = self._triangle
        values = np.diag(triangle)
        at = int(np.abs(values - self.multipliers[k]).argmin())
        rest = triangle[at + 1 :, at + 1 :] - values[at] * np.eye(len(values) - at - 1)
        found = np.zeros(len(values), dtype=complex)
        found[at] = 1.0
        try:
            found[at + 1 :] = scipy.linalg.solve_triangular(rest, -triangle[at, at + 1 :], trans="T")
        except np.linalg.LinAlgError:
            return None
        found = found @ rotated.conj().T
        product = found @ self.vectors[:, k]
        return None if abs(product) < np.linalg.norm(found) * CONVERGED else np.asarray(found / product)

    def apart(self, monodromy: Array, operator: object = None) -> float:
        """Return the distance from another spectrum, over the largest multiplier.

        Parameters
        ----------
        monodromy : ndarray, shape (n, n)
            The monodromy matrix of the other.
        operator : Operator, optional
            The equations that the other belongs to, for spectra that compare more than monodromy matrices.

        Returns
        -------
        float
            The larger one of the differences of the sums of first and second powers.
        """
        return apart(self.monodromy / self.radius, monodromy / self.radius)

    def start(self, change: Increment) -> Array:
        """Return the states' part of a change of the orbit at the beginning of the period.

        Parameters
        ----------
        change : Increment
            The change.

        Returns
        -------
        ndarray, shape (n,)
            Scaled states.
        """
        return change.profile[0]

    @property
    def radius(self) -> float:
        """The largest modulus, at least 1: what errors of multipliers are compared with."""
        return max(1.0, float(np.abs(self.multipliers).max()))

    @property
    def known(self) -> bool:
        """Whether the trivial multiplier is near 1: then rounding has not spoilt others that are not huge."""
        return not self.trivial or bool(np.abs(self.multipliers - 1).min() <= LOST_FLOW)


def apart(one: Array, two: Array) -> float:
    """Distance of two monodromy matrices in the sums of first and second powers of their multipliers.

    Unlike the multipliers themselves these stay smooth where two of them meet.
    """
    first = abs(two.trace() - one.trace())
    second = abs(np.vdot(two, two.T) - np.vdot(one, one.T)) / 2
    return float(max(first, second))


def _rotations(begin: Complex, end: Complex) -> Array:
    """The integral of Im(w* dw)/|w|^2 along the chords between vectors, shapes (K, n, k) and (K, k).

    Where a contact reverses a velocity within an interval the chord passes between the two, not by +-pi.
    """
    product = (_directions(begin).conj() * _directions(end)).sum(axis=1)
    angle = np.arccos(np.clip(product.real, -1, 1))
    found: Array = product.imag / np.sinc(angle / np.pi).clip(CONVERGED)
    return found


def _directions(vectors: Complex) -> Complex:
    """Vectors (K, n, k) of length 1; those that have decayed to 0 are unchanged."""
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    found: Complex = vectors / np.where(size > SMALLEST, size, 1.0)
    return found


def without_trivial(multipliers: Complex, count: int) -> Complex:
    """Return the multipliers without the `count` that are nearest 1."""
    if count == 0:
        return multipliers
    return np.delete(multipliers, np.abs(multipliers - 1).argsort(kind="stable")[:count])
