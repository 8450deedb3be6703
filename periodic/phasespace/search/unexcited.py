"""Equilibria and unstable cycles of systems that are not excited."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.orbit.scheme import Array
from periodic.phasespace.following.box import Box
from periodic.phasespace.orbits.clocks import PER_TURN
from periodic.phasespace.search.atrest import at_rest
from periodic.phasespace.search.settle import Settling

RETURN = 0.1
"""Distance between a motion and itself later that may be a cycle nearby, in its size."""

CYCLES, TURNS = 12, 6
"""Closest returns that are tried, and the longest of them in turns."""


@dataclass(frozen=True, eq=False)
class Unexcited:
    """The search for equilibria by Newton's method, and for cycles from where motions come back closest."""

    settling: Settling
    box: Box
    places: int
    seed: int

    def run(self) -> str:
        """Add what is found to the orbits known; return what was tried, in words."""
        before = len(self.settling.orbits)
        for state, unknowns in self._still():
            point = self.settling.clock.complete(np.concatenate([state, unknowns]), [], -1.0)
            if point is not None:
                self.settling.add(point, -1.0, "by Newton's method on the equations at rest")
        rests = len(self.settling.orbits) - before
        for y, lag in self._returns():
            point = self.settling.clock.complete(y, [], lag)
            if point is not None:
                self.settling.add(point, lag, "from a motion that came back")
        cycles = len(self.settling.orbits) - before - rests
        return (
            f"Newton's method on the equations at rest from {self.places} places, and from the closest "
            f"returns of motions: {rests} more equilibria, {cycles} more cycles"
        )

    def _still(self) -> list[tuple[Array, Array]]:
        """States and unknowns at which nothing moves."""
        crowd, unit = self.settling.crowd, self.settling.unit
        x = self.box.draw(self.places, self.seed, crowd.system, crowd.parameter)
        return at_rest(crowd.system, crowd.parameter, x, unit, np.zeros(1))

    def _returns(self) -> list[tuple[Array, float]]:
        """Where motions that never settle came back closest, and after how many looks."""
        settling, found = self.settling, list[tuple[float, Array, float]]()
        for path in settling.sections[:4]:
            size = np.maximum(np.ptp(path, axis=0), 1e-12)
            for lag in range(PER_TURN // 2, min(TURNS * PER_TURN, len(path) // 2)):
                off = np.abs((path[lag:] - path[:-lag]) / size).max(axis=1)
                k = int(off.argmin())
                if off[k] < RETURN:
                    found.append((float(off[k]), path[k], float(lag)))
        found.sort(key=lambda each: each[0])
        chosen: list[tuple[Array, float]] = []
        for _, state, after in found:
            if all(abs(after - other) > PER_TURN / 4 for _, other in chosen):
                chosen.append((settling.crowd.begin(state[None])[0], after))
        return chosen[:CYCLES]
