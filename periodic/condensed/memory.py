"""How much memory the orbits of a condensed branch take at their peak, about."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

from periodic.condensed.floquet import ALL_KEPT_UP_TO, LEADING
from periodic.condensed.recursion import cheaper

REAL, COMPLEX = 8.0, 16.0
"""Bytes of a number."""

KEPT = 6
"""Orbits that are kept with their equations while a special point is located."""

SOLVING = 6
"""Matrices that exist at once while equations are set up and solved. Two more are kept with each orbit."""

HALVED = 8
"""States and forces of free motion on the halved mesh that exist at once while the error is estimated."""

CACHE = 2.0**20
"""Bytes that are solved for at once: what a core's own cache holds, about. Any will do; more are slower."""


def portions(intervals: int, each: float) -> Iterator[slice]:
    """Yield so many of `intervals` at once as CACHE holds of `each` bytes."""
    count = max(int(CACHE / each), 1)
    yield from (slice(first, min(first + count, intervals)) for first in range(0, intervals, count))


@dataclass(frozen=True)
class Memory:
    """What the equations of an orbit are made of.

    Parameters
    ----------
    points : int
        Collocation points of an interval.
    places, forces, own, modes : int
        Numbers of states of the linear part, of forces, of own states and of modes.
    active : float
        Fraction of the intervals in which forces depend on the motion.
    kinked : bool
        Whether the error estimate solves equations on the halved mesh, as it does with event nodes or own
        states. Otherwise those are never set up.
    even : bool
        Whether all intervals have one width.
    """

    points: int
    places: int
    forces: int
    own: int
    modes: int
    active: float
    kinked: bool
    even: bool = False

    def peak(self, intervals: int) -> float:
        """Return the bytes that orbits of so many intervals take, with their error estimates."""
        return self._matrices(intervals) + intervals * self._each

    def most(self, intervals: int, limit: float) -> int:
        """Return the largest number of intervals, up to `intervals`, that takes at most `limit` bytes."""
        return bisect_right(range(1, intervals + 1), limit, key=self.peak)

    @property
    def _coordinates(self) -> int:
        return 2 * self.modes + self.own

    def _matrices(self, intervals: int) -> float:
        """Bytes of the equations as matrices; 0 where they are solved interval by interval."""
        each = self.points * (self.forces + self.own)
        held = intervals if self.own else self.active * intervals
        size = self.points * (self.active * self.forces + self.own) * intervals
        finer = 2 if self.kinked else 1
        way = 4.0 * self._coordinates / (finer * intervals if self.even else 1)
        if cheaper(finer * size, self._coordinates, finer * held, each, way):
            return 0.0
        return REAL * size**2 * (2 * KEPT + SOLVING * finer**2)

    @property
    def _each(self) -> float:
        """Bytes of an interval's tables and of its motion; the halved mesh has tables as well."""
        a, c = self.points, self._coordinates
        followed = c if c <= ALL_KEPT_UP_TO else 2 * LEADING
        tables = COMPLEX * self.modes * a * (self.forces + self.places)
        tables += REAL * a**2 * self.forces * self.places
        rows = a * (self.forces + self.own) * (1.0 if self.own else self.active)
        tables += 2 * REAL * rows * c
        motion = REAL * c * followed
        halved = 0.0 if self.kinked else REAL * HALVED * 2 * a * (self.forces + self.places) * followed
        return KEPT * (tables + motion) + max(5 * motion, 2 * tables) + halved
