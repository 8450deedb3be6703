"""Conditions that hold an orbit at a fold, a doubling or a torus bifurcation while two parameters vary.

A fold or doubling is where K = M - I (with the rows and parameters that determine an orbit besides) or
K = M + I is singular: the corner of a bordered matrix vanishes,

    [K b; c' 0] [v; g] = [0; 1],   [w' g] [K b; c' 0] = [0 1],   dg = -w' dK v

(Govaerts 2000). A torus is where the determinant of the monodromy matrix on the pair's invariant subspace
is 1, which stays smooth where the pair becomes real.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy

from periodic.conditions.adjoint import Linear, gradient
from periodic.correction.condition import Condition, Given, SideCondition
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, differentiable


@dataclass(frozen=True)
class FoldCondition(Condition):
    """The orbit is a fold (LP) of a branch in any parameter."""

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit."""
        return _Singular(1.0, given)


@dataclass(frozen=True)
class DoublingCondition(Condition):
    """The orbit doubles its period (PD): a multiplier is -1."""

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit."""
        return _Singular(-1.0, Given(given.own))


@dataclass(frozen=True)
class TorusCondition(Condition):
    """A pair of multipliers has the product 1: a torus bifurcation (NS) while it is complex."""

    def check(self, system: System, parameter: Array) -> None:
        """Refuse a system whose orbits have no pair of multipliers."""
        if len(system.states) < 2:
            raise ValueError("determined has TorusCondition(), which needs two states; the system has one")

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit."""
        return _Pair()


@dataclass
class _Border:
    """The columns b and rows c that border K, chosen at the first orbit and kept."""

    column: Array | None = None
    row: Array | None = None

    def around(self, matrix: Array) -> tuple[float, Array, Array]:
        """Return g, v and w."""
        if self.column is None or self.row is None:
            left, _, right = np.linalg.svd(matrix)
            self.column, self.row = left[:, -1], right[-1]
        size = len(matrix)
        bordered = np.zeros((size + 1, size + 1))
        bordered[:size, :size] = matrix
        bordered[:size, size], bordered[size, :size] = self.column, self.row
        unit = np.append(np.zeros(size), 1.0)
        right, left = np.linalg.solve(bordered, unit), np.linalg.solve(bordered.T, unit)
        return float(right[-1]), right[:-1], left[:-1]


@dataclass(frozen=True)
class _Singular:
    """K is singular, K = M - multiplier I, extended by what else determines the orbit."""

    multiplier: float
    given: Given
    border: _Border = field(default_factory=_Border)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return g and its gradient."""
        linear = Linear.about(differentiable(system), orbit, self.given.free)
        rows = [c.linearise(system, orbit, self.given.free) for c in self.given.conditions]
        n = orbit.nodes.shape[1]
        top = linear.columns(linear.maps[-1])
        top[:, :n] -= self.multiplier * np.eye(n)
        matrix = np.concatenate([top, *(linear.functional(row)[None] for row in rows)])
        value, right, left = self.border.around(matrix)
        source = linear.source(left[:n])
        for weight, row in zip(left[n:], rows, strict=True):
            source += row.scaled(float(weight))
        found = gradient(linear, linear.tangent(right), source, free).scaled(-1.0)
        return Row(value + found.value, found.nodes, found.outer, found.stages)


@dataclass
class _Pair:
    """The product of a pair of multipliers is 1; the pair nearest to it at the first orbit, then followed."""

    basis: Array | None = None

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return det B - 1, B the monodromy matrix on the pair's subspace, and its gradient."""
        linear = Linear.about(differentiable(system), orbit, ())
        right, left = _subspaces(linear.monodromy, self.basis)
        if self.basis is None:
            self.basis = right
        block = left.T @ linear.monodromy @ right
        size = float(np.linalg.det(block))
        weights = left @ (size * np.linalg.inv(block).T)
        total = Row(size - 1, np.zeros_like(orbit.nodes), np.zeros(len(orbit.phases) + len(free)))
        for column, weight in zip(right.T, weights.T, strict=True):
            total += gradient(linear, linear.tangent(column), linear.source(weight), free)
        return total


def _subspaces(matrix: Array, basis: Array | None) -> tuple[Array, Array]:
    """Right and left bases (n, 2) of a pair's invariant subspace, with left.T right = I.

    The pair is the one whose product is nearest to 1, or whose subspace is nearest to `basis`.
    """
    chosen = _nearest(matrix, basis)

    def wanted(real: float, imag: float) -> bool:
        return bool(np.abs(chosen - complex(real, imag)).min() < SAME * np.abs(chosen).max())

    right = scipy.linalg.schur(matrix, sort=wanted)[1][:, :2]
    left = scipy.linalg.schur(matrix.T, sort=wanted)[1][:, :2]
    return right, left @ np.linalg.inv(right.T @ left)


SAME = 1e-6
"""Multipliers nearer to each other than this, relatively, belong to one pair."""


def _nearest(matrix: Array, basis: Array | None) -> Array:
    values, vectors = np.linalg.eig(matrix)
    first, second = np.triu_indices(len(values), 1)
    if basis is None:
        partners = np.abs(values[first] * values[second] - 1)
    else:
        outside = np.linalg.norm(vectors - basis @ (basis.T @ vectors), axis=0)
        partners = outside[first] + outside[second]
    k = partners.argmin()
    return np.array([values[first[k]], values[second[k]]])
