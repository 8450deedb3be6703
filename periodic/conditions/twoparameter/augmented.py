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

from periodic.conditions.variations import variations, weighted
from periodic.correction.condition import Condition, Given, SideCondition
from periodic.equilibrium.held import oscillating_row, oscillation, singular_row
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, resets_of


@dataclass(frozen=True)
class FoldCondition(Condition):
    """The orbit is a fold (LP) of a branch in any parameter."""

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit."""
        return _Singular(1.0, given)


@dataclass(frozen=True)
class DoublingCondition(Condition):
    """The orbit doubles its period (PD): a multiplier is -1."""

    def check(self, system: System, parameter: Array) -> None:
        """Refuse a system whose multiplier is positive."""
        if not resets_of(system):
            _two_states(self, system)

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit. Raises ValueError for an equilibrium."""
        of_orbits(self, origin)
        return _Singular(-1.0, Given(given.own))


@dataclass(frozen=True)
class TorusCondition(Condition):
    """A pair of multipliers has the product 1: a torus bifurcation (NS) while it is complex."""

    def check(self, system: System, parameter: Array) -> None:
        """Refuse a system whose orbits have no pair of multipliers."""
        _two_states(self, system)

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit. Raises ValueError for an equilibrium."""
        of_orbits(self, origin)
        return _Pair()


def _two_states(condition: Condition, system: System) -> None:
    if len(system.states) < 2:
        name = type(condition).__name__
        raise ValueError(f"determined has {name}(), which needs two states; the system has one")


def of_orbits(condition: Condition, origin: Orbit) -> None:
    """Refuse a condition of periodic orbits for an equilibrium. Raises ValueError."""
    if origin.equilibrium:
        name = type(condition).__name__
        raise ValueError(f"determined has {name}(...), which holds orbits; it must be left out of equilibria")


@dataclass(frozen=True)
class HopfCondition(Condition):
    """A pair of eigenvalues of the equilibrium has the sum 0: a Hopf point (HB) while it is complex."""

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an equilibrium. Raises ValueError for an orbit that is none."""
        if not origin.equilibrium:
            raise ValueError(
                "determined has HopfCondition(), which holds equilibria; it must be left out of orbits"
            )
        return _Oscillating(origin)


@dataclass
class _Oscillating:
    """The sum of a pair of eigenvalues is 0: of the pair nearest the axis at the origin, then followed."""

    origin: Orbit
    near: Array | None = None

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return half the sum and its gradient."""
        if self.near is None:
            self.near = oscillation(system, self.origin)
        return oscillating_row(system, orbit, free, self.near)


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
        if orbit.equilibrium:
            return singular_row(system, orbit, free, self.border.around)
        closed = variations(system, orbit, self.given.free).repeating(self.multiplier)
        rows = [c.linearise(system, orbit, self.given.free) for c in self.given.conditions]
        top = closed.matrix
        matrix = np.concatenate([top, *(closed.functional(row)[None] for row in rows)])
        value, right, left = self.border.around(matrix)
        source = weighted(rows, left[len(top) :])
        found = closed.gradient(right, left[: len(top)], source, free).scaled(-1.0)
        return Row(value + found.value, found.nodes, found.outer, found.stages)


@dataclass
class _Pair:
    """The product of a pair of multipliers is 1; the pair nearest to it at the first orbit, then followed."""

    near: Array | None = None

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return the product less 1, and its gradient."""
        row, self.near = variations(system, orbit, ()).pair(self.near, free)
        return row
