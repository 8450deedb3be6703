"""A motion integrated period by period until it comes back, or taken to an orbit near which it comes.

A motion that settles slowly, or never, as it is chaotic or repeats itself after several periods, comes near
orbits of one period now and then. From the closest returns Newton's method finds them (Lathrop & Kostelich,
Phys. Rev. A 40 (1989) 4028, look for them there). Where words are read from motions it goes by `Closing`,
else by `ReturnMap`, or from the whole of a period, of which no part need grow much.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy

from periodic.correction.discretisation import Discretisation
from periodic.correction.outcome import FAILURES
from periodic.correction.tolerance import Accuracy
from periodic.events.motions import FOLLOWED, PERIODS, STILL, has_words, motion_from, orbit_of
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.sampling import FARTHEST_SAMPLE
from periodic.orbit.scheme import Array
from periodic.system import Moving, TrajectoryLike
from periodic.tracing.closing import Closing
from periodic.tracing.pace import periods_left
from periodic.tracing.returnmap import ReturnMap

CLOSE = 1e-2 * STILL
"""As `STILL`, of a motion settled further, as the order of events near each other may need it."""

NEAR = 1e-2
"""As `STILL`, for the result of Newton's method on the return map: near enough to read its word."""

TRANSIENTS = (10, 40)
"""Periods after which `ReturnMap` is tried, where it takes less than to settle."""

BETWEEN = TRANSIENTS[0]
"""Periods after which `Closing` is tried, and again and again: it takes few."""

PLACES_IN_PERIOD = 193
"""Phases in a period at which the motion is computed,"""

MOST_PLACES = 2**6 * (PLACES_IN_PERIOD - 1) + 1
"""... and at the most once it has settled, so that every other one shows what lies between."""

RETURNS = 4
"""Closest returns of a motion that never settles that are guesses of orbits."""


Place = tuple[Array, Array, Sequence[int] | None]
"""Where a period begins: the state, the unknowns, and the modes before, where they are known."""


@dataclass(eq=False)
class Transient:
    """A motion of a system at some parameters, at the beginning of a period.

    path: its last period. The methods raise FAILURES.
    """

    method: Discretisation
    system: Moving
    parameter: Array
    place: Place
    path: TrajectoryLike = field(init=False)
    _count: int = field(default=0, init=False)
    _turn: int = field(default=TRANSIENTS[0], init=False)
    _apart: list[float] = field(default_factory=list, init=False)
    _closest: tuple[float, Place] | None = field(default=None, init=False)
    _returns: list[tuple[float, Place]] = field(default_factory=list, init=False)

    def settles(self, wanted: float) -> bool:
        """Go on until the motion comes back but for a part of its peak to peak, or is near an orbit.

        False where it does not within PERIODS, or grows beyond all numbers.
        """
        while self._count < PERIODS:
            found = self._found(wanted) if self._count >= self._turn else None
            if not self._period(found or self.place):
                return False
            if found is not None:  # a motion leaves the orbit again where that is unstable
                self.place, self._apart, self._closest = found, self._apart[-1:], None
                self._turn = self._count + 1
            if found is not None or self._apart[-1] < wanted:
                return True
        return False

    def orbit(self) -> Orbit | None:
        """Return the next period as a guess of an orbit: see `periodic.events.motions.orbit_of`."""
        return self._read(*self.place, FOLLOWED)

    def returns(self) -> Iterator[TrajectoryLike]:
        """Yield the periods that came back closest, the closest first."""
        for _, place in sorted(self._returns, key=lambda each: each[0])[:RETURNS]:
            yield self.samples(place)

    def samples(self, place: Place | None = None) -> TrajectoryLike:
        """Return a period at phases enough that cubics through every other one show the others.

        The next one, or that from a place.
        """
        places = PLACES_IN_PERIOD
        while True:
            path = self._followed(*(place or self.place), places)
            size = np.maximum(np.ptp(path.state, axis=0), Accuracy.STANDARD)
            between = scipy.interpolate.PchipInterpolator(path.phase[::2], path.state[::2], axis=0)
            missed = np.abs(between(path.phase[1::2]) - path.state[1::2]).max(axis=0)
            if (missed < FARTHEST_SAMPLE * size).all() or places >= MOST_PLACES:
                return path
            places = 2 * places - 1

    def _read(
        self, state: Array, algebraic: Array, modes: Sequence[int] | None, tolerance: float
    ) -> Orbit | None:
        """The period from a place as a guess of an orbit."""
        return orbit_of(self.system, state, algebraic, self.parameter, tolerance, before=modes)

    def _followed(
        self, state: Array, algebraic: Array, modes: Sequence[int] | None, places: int = PLACES_IN_PERIOD
    ) -> TrajectoryLike:
        """A period from a place."""
        phase = np.linspace(0, FORCED, places)
        return motion_from(self.system, state, algebraic, self.parameter, phase, Accuracy.STANDARD, modes)

    def _period(self, place: Place) -> bool:
        """Follow a period from a place; whether it is finite."""
        self.path = path = self._followed(*place)
        if not np.isfinite(path.state).all():
            return False
        self.place = path.state[-1], path.algebraic[-1], path.modes
        self._count += 1
        self._apart.append(apart(path.state))
        self._returns.append((self._apart[-1], place))
        if self._closest is None or self._apart[-1] < self._closest[0]:
            self._closest = self._apart[-1], place
        return True

    def _found(self, wanted: float) -> Place | None:
        """The beginning of an orbit nearby, by Newton's method where to settle would take longer."""
        left = periods_left(self._apart, wanted)
        if left <= least(self.place[0]):
            self._turn = self._count + max(math.ceil(left), 1)
            return None
        place, self._closest = self._nearest, None
        if has_words(self.system):
            self._turn = self._count + BETWEEN
            return self._closed(*place)
        self._turn = next((later for later in TRANSIENTS if later > self._count), PERIODS)
        return self._mapped(*place, wanted)

    def _closed(self, state: Array, algebraic: Array, modes: Sequence[int] | None) -> Place | None:
        """The beginning of an orbit near a place, with derivatives from its equations."""

        def motion(begin: Array) -> Orbit | None:
            return self._read(begin, algebraic, modes, Accuracy.STANDARD)

        def distance(begin: Array) -> float:
            return apart(self._followed(begin, algebraic, modes).state)

        found, off = Closing(self.method, self.system, motion, distance).nearest(state, CLOSE)
        return (found, algebraic, modes) if off < STILL else None

    def _mapped(
        self, state: Array, algebraic: Array, modes: Sequence[int] | None, wanted: float
    ) -> Place | None:
        """The same with derivatives by differences."""

        def follow(begin: Array) -> Array:
            return self._followed(begin, algebraic, modes).state

        try:
            found = ReturnMap(follow, wanted / 2, NEAR).fixed(state)
        except FAILURES:
            return None
        return None if found is None else (found, algebraic, modes)

    @property
    def _nearest(self) -> Place:
        """Where the closest return began; the present place where that was the last."""
        if self._closest is None or self._closest[0] == self._apart[-1]:
            return self.place
        return self._closest[1]


def least(state: Array) -> int:
    """Return the fewest periods of Newton's method: one as it is, one beside for each state, and a step."""
    return len(state) + 2


def apart(path: Array) -> float:
    """Return how far a motion over a period is from coming back, as a part of its peak to peak."""
    return float(np.abs(path[-1] - path[0]).max() / max(np.ptp(path, axis=0).max(), Accuracy.STANDARD))
