"""Unstable orbits: fixed points of the map over some periods, from places where motions have been."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.box import Box
from periodic.phasespace.orbits.clocks import NEAR, PART
from periodic.phasespace.orbits.recurrence import same
from periodic.phasespace.search.atrest import at_rest
from periodic.phasespace.search.fixedpoints import FixedPoints
from periodic.phasespace.search.settle import Settling

PHASES = 16
"""Phases of which the mean of the equations is taken."""

ROUNDS = 2
"""How often the same places are started from: first as they are, then with what was found deflated."""

RETURNS = 16
"""Closest returns of motions that never settle, for each number of periods, that are places to start from."""


@dataclass(frozen=True, eq=False)
class Unstable:
    """The search for unstable orbits beside motions that have settled.

    places: how many states are started from for each number of periods.
    """

    settling: Settling
    box: Box
    periods: int
    places: int
    seed: int

    def run(self) -> str:
        """Add orbits to those known; return what was tried, in words."""
        before = len(self.settling.orbits)
        rests = self._rests()
        for periods in range(1, self.periods + 1):
            for round_ in range(ROUNDS):
                known = self._roots(periods) if round_ else np.zeros((0, self.settling.n))
                if not self._one(periods, known):
                    break
        found = len(self.settling.orbits) - before
        return (
            f"collocation from {rests} states at which the equations' mean over a period rests, and Newton's "
            f"method on the maps over 1 to {self.periods} periods from {self.places} places each, then with "
            f"what was found deflated: {found} more orbits"
        )

    def _rests(self) -> int:
        """Look for orbits about states at which the equations' mean over a period rests; how many there are.

        Those about one that is very unstable are out of reach of motions.
        """
        crowd, settling = self.settling.crowd, self.settling
        x = self.box.draw(self.places, self.seed, crowd.system, crowd.parameter)
        phases = np.linspace(0, FORCED, PHASES, endpoint=False)
        found = at_rest(crowd.system, crowd.parameter, x, settling.unit, phases)
        for state, unknowns in found:
            point = settling.clock.completion.about(state, unknowns)
            if point is not None and not self._held(point.orbit.state(np.zeros(1))):
                settling.add(point, 1, "about a state at rest")
        return len(found)

    def _held(self, state: Array) -> bool:
        """Whether friction holds something all along a motion of one period: it is of a family then."""
        path = self.settling.crowd.run(self.settling.crowd.begin(state), 1, FORCED)
        return bool(self.settling.holds(path.modes[0], path.changes[0]))

    def _one(self, periods: int, known: Array) -> int:
        """Search the map over some periods once; how many roots there were."""
        settling = self.settling
        starts = self._starts(periods)
        middle = (self.box.low + self.box.high) / 2
        roots = FixedPoints(settling.crowd, periods, settling.unit, middle).found(starts, known)
        fresh: list[Array] = []
        for root in roots:
            if all(np.abs((root - other) / settling.unit).max() > NEAR * PART for other in fresh):
                fresh.append(root)
        for root in fresh:
            self._complete(root, periods)
        return len(roots)

    def _complete(self, root: Array, periods: int) -> None:
        """Complete a fixed point to an orbit, unless it is known."""
        settling = self.settling
        y = settling.crowd.begin(root[None])
        path = settling.crowd.run(y, periods, FORCED, keep=True)
        assert path.sections is not None
        sections = path.sections[0, :-1, : settling.n]
        for lag in (k for k in range(1, periods + 1) if periods % k == 0):
            if any(
                same(sections[:lag], one.sections, settling.unit, NEAR * PART) for one in settling.orbits.each
            ):
                return
        if settling.holds(path.modes[0], path.changes[0]):  # one of a family that simulations lead to
            return
        modes = settling.crowd.run(y, 0, FORCED).modes[0]
        point = settling.clock.complete(y[0], list(modes), periods)
        if point is not None:
            settling.add(point, periods, "by Newton's method on the map")

    def _starts(self, periods: int) -> Array:
        """Places to start from: half in the box, half on motions on their way, and closest returns."""
        settling, half = self.settling, self.places // 2
        rng, crowd = np.random.default_rng(self.seed + periods), settling.crowd
        inside = self.box.draw(half, self.seed + periods, crowd.system, crowd.parameter)
        early = settling.early if settling.early is not None else inside
        early = early[np.isfinite(early).all(axis=1)]
        on_way = early[rng.integers(len(early), size=self.places - half)] if len(early) else inside
        return np.concatenate([inside, on_way, self._returns(periods)])

    def _returns(self, periods: int) -> Array:
        """States at which motions without an end came back closest after some periods."""
        paths = self.settling.sections
        if not len(paths) or paths.shape[1] <= periods:
            return np.zeros((0, self.settling.n))
        apart = np.abs((paths[:, periods:] - paths[:, :-periods]) / self.settling.unit).max(axis=2)
        closest = np.argsort(apart, axis=None)[:RETURNS]
        motion, at = np.unravel_index(closest, apart.shape)
        return np.asarray(paths[motion, at])

    def _roots(self, periods: int) -> Array:
        """Known states that the map leaves where they are."""
        each = [
            one.sections for one in self.settling.orbits.each if one.periods and periods % one.periods == 0
        ]
        return np.concatenate(each) if each else np.zeros((0, self.settling.n))
