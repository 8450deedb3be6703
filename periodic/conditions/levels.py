"""Conditions that pick orbits of a branch by what they do: an output at a given level, or at its peak."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import cast

import numpy as np

from periodic.conditions.functionals import Functional, Smooth, Value, apart
from periodic.conditions.variations import variations, weighted
from periodic.correction.condition import Condition, Given, SideCondition
from periodic.linear.variation import Tangent
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, index_of

GRADIENT_STEP = 1e-4
"""Step, in peak-to-peak values, of differences of a functional's derivative."""


def smooth(functional: Functional) -> Smooth:
    """Return the functional as one with a derivative. Raises ValueError if it has none."""
    if not hasattr(functional, "linearise"):
        raise ValueError(
            f"functional is {functional!r}, which has no derivative; it must be one of periodic's own, or "
            f"have a method linearise(system, orbit, free)"
        )
    return cast(Smooth, functional)


@dataclass(frozen=True)
class Level(Condition):
    """A functional of the orbit has a given value: f = value.

    Parameters
    ----------
    functional : Functional
        f; as a condition it must have a derivative.
    value : float or str
        Its value in SI units; or the name of the parameter that it is equal to.

    Raises
    ------
    ValueError
        For a value that is no finite number.
    """

    functional: Functional
    value: float | str

    def __post_init__(self) -> None:
        finite = isinstance(self.value, int | float | np.number) and np.isfinite(self.value)
        if not (finite or (isinstance(self.value, str) and self.value)):
            raise ValueError(
                f"value of a Level is {self.value!r}; it must be a finite number, or a parameter's name"
            )

    def check(self, system: System, parameter: Array) -> None:
        """Refuse a system without the parameter that is named."""
        if isinstance(self.value, str):
            index_of(system, self.value)

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit."""
        return _Level(smooth(self.functional), self.value)


@dataclass(frozen=True)
class _Level:
    functional: Smooth
    value: float | str

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return f - value and its gradient."""
        row = self.functional.linearise(system, orbit, free)
        if isinstance(self.value, str):
            row += Value(self.value).linearise(system, orbit, free).scaled(-1.0)
            return Row(apart(self.functional, row.value, 0.0), row.nodes, row.outer, row.stages)
        return Row(apart(self.functional, row.value, self.value), row.nodes, row.outer, row.stages)


@dataclass(frozen=True)
class Peak(Condition):
    """A functional is stationary along the branch in the parameter that this condition is given for.

    With t the branch's tangent, df/du t = 0: a resonance peak (or a trough), on either side of a fold.

    Parameters
    ----------
    functional : Functional
        f, which must have a derivative.
    """

    functional: Functional

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit."""
        return _Peak(smooth(self.functional), given)


@dataclass
class _Peak:
    functional: Smooth
    given: Given
    border: Array | None = field(default=None)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return df/du t and its gradient; t is the kernel of the branch's equations, c' t = 1."""
        given = (*self.given.free, self.given.own)
        closed = variations(system, orbit, given).repeating(1.0)
        rows = [c.linearise(system, orbit, given) for c in self.given.conditions]
        top = closed.matrix
        matrix = np.concatenate([top, *(closed.functional(row)[None] for row in rows)])
        if self.border is None:
            self.border = np.linalg.svd(matrix)[2][-1]
        bordered = np.concatenate([matrix, self.border[None]])
        direction = np.linalg.solve(bordered, np.append(np.zeros(len(matrix)), 1.0))
        aim = self.functional.linearise(system, orbit, free)
        k = len(orbit.phases)
        own = [*range(k), *(k + free.index(i) for i in given)]
        along = Row(0.0, aim.nodes, aim.outer[own], aim.stages)
        slope = closed.functional(along)
        weights = -np.linalg.solve(bordered.T, slope)[:-1]
        others = weighted(rows, weights[len(top) :])
        source = along if others is None else along + others
        tangent = closed.tangent(direction)
        found = closed.gradient(direction, weights[: len(top)], source, free)
        found += self._bent(system, orbit, tangent, free)
        value = float(slope @ direction) + found.value
        return Row(value, found.nodes, found.outer, found.stages)

    def _bent(self, system: System, orbit: Orbit, tangent: Tangent, free: tuple[int, ...]) -> Row:
        """Return the second derivative of the functional along the tangent, by a central difference."""
        size = GRADIENT_STEP * max(orbit.span(), LEAST_SPAN) / np.abs(tangent.nodes).max()
        ends = [self.functional.linearise(system, tangent.moved(orbit, h), free) for h in (size, -size)]
        row = (ends[0] + ends[1].scaled(-1.0)).scaled(1 / (2 * size))
        return Row(0.0, row.nodes, row.outer, row.stages)
