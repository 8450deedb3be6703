"""The orbits that a search knows so far."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from periodic.orbit.scheme import Array
from periodic.results.point import Point

RADIUS = 1e-3
"""A motion so near to a stable orbit twice, a stretch apart, ends there, in units of the states,"""

PART = 0.1
"""... or nearer, so that it is nearer to it by this factor than any other orbit is."""

ONE = 1e-6
"""Places nearer to each other are one."""


@dataclass(eq=False)
class Known:
    """An orbit that was found.

    sections: states (p, n) of it, one in each of its periods, or along a cycle. periods: how many; 0 of an
    equilibrium. spacing: the largest distance from one of a cycle's states to the next. starts: how many led
    to it. held: surfaces that friction holds all along, wherever: it is one of a family then. why: what is
    not known of it.
    """

    sections: Array
    periods: int
    point: Point | None
    found: str
    spacing: float = 0.0
    starts: int = 0
    why: str = ""
    held: frozenset[int] = frozenset()

    @property
    def stable(self) -> bool:
        """Whether it is; what is known of simulations alone is."""
        return self.point is None or self.point.stable

    def apart(self, state: Array, unit: Array) -> float:
        """Return how far a state is from the nearest of its own."""
        return float(np.abs((self.sections - state) / unit).max(axis=1).min())


@dataclass(frozen=True, eq=False)
class Orbits:
    """Orbits in order; unit (n,): of distances between states; same: whether two are one, to a distance."""

    unit: Array
    same: Callable[[Array, Array, float], bool]
    each: list[Known] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.each)

    def add(self, one: Known, near: float) -> bool:
        """Add an orbit unless it is known to a distance; whether it was added."""
        if any(self.same(one.sections, other.sections, near + one.spacing) for other in self.each):
            return False
        self.each.append(one)
        return True

    def family(self, held: frozenset[int], periods: int) -> int:
        """Return which orbit is of the family that is held at the same surfaces, -1 for none."""
        mine = (k for k, one in enumerate(self.each) if one.held == held and one.periods == periods)
        return next(mine, -1) if held else -1

    def near(self, state: Array, distance: float) -> bool:
        """Return whether a state is near a stable orbit."""
        return any(one.apart(state, self.unit) < distance for one in self.each if one.stable)

    def targets(self) -> tuple[Array, list[int], Array, float] | None:
        """Return the places of stable orbits, whose each is, the units, and how near a motion must come."""
        stable = [(k, one) for k, one in enumerate(self.each) if one.stable]
        if not stable:
            return None
        whose = [k for k, one in stable for _ in one.sections]
        places = np.concatenate([one.sections for _, one in stable])
        spacing = max(one.spacing for _, one in stable)
        return places, whose, self.unit, max(min(RADIUS, PART * self._gap()), spacing)

    def _gap(self) -> float:
        """The least distance between two orbits."""
        least = np.inf
        for k, one in enumerate(self.each):
            for other in self.each[:k]:
                gaps = np.abs((one.sections[:, None] - other.sections) / self.unit).max(axis=2)
                least = min(least, float(gaps[gaps > ONE].min(initial=np.inf)))
        return least
