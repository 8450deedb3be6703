"""When motions are looked at, and how it is told that they come back: excited systems, and free ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.spatial import KDTree

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.motion import Motion
from periodic.phasespace.orbits.completion import Completion
from periodic.phasespace.orbits.known import Known
from periodic.phasespace.orbits.recurrence import apart, period, return_time, same
from periodic.results.point import Point

NEAR = 1e-3
"""Distance between a motion and itself some periods later, in units of the states, that may be an orbit."""

PART = 0.1
"""Part of it at which two states of a completed orbit are one."""

RETURNS = 0.05
"""The same between a free motion and itself a period later, in its own size."""

NEARLY = 0.1
"""The same of a motion that may settle slowly."""

LONGEST = 64
"""Most periods after which a motion is found to come back that was followed to the end."""

STILL = 1e-7
"""Range of a motion, in units of the states, that is at rest."""

ALONG = 400
"""Places along a cycle, at equal distances."""

PER_TURN = 40
"""Looks at a free motion while it goes once to and fro."""

SAMPLES, LONGER = 2048, 6
"""Looks that tell how fast it does, and how often they are made longer where it hardly does."""

TURNS = 6
"""Fewest crossings of its mean by which that is told."""


class Clock(Protocol):
    """How a search looks at motions: each `stretch` (rad), in a first block of `first` of them.

    between: stretches between looks at a motion that never comes back. whole: whether a stretch is a period.
    """

    @property
    def completion(self) -> Completion: ...
    @property
    def stretch(self) -> float: ...
    @property
    def first(self) -> int: ...
    @property
    def between(self) -> int: ...
    @property
    def whole(self) -> bool: ...

    def lag(self, path: Array, unit: Array) -> float:
        """After how many looks a motion (K, n) comes back: -1 for one at rest, 0 where it does not."""

    def nearly(self, path: Array) -> bool:
        """Whether it nearly comes back, measured by its own range."""

    def patient(self) -> Clock:
        """The same for motions that have been followed to the end, and may come back after longer."""

    def off(self, path: Array, lag: float, unit: Array) -> float:
        """How far it then is from where it was."""

    def complete(self, y: Array, modes: Sequence[int], lag: float) -> Point | None:
        """The orbit near a motion from y."""

    def known(self, point: Point, lag: float, unit: Array, found: str) -> Known:
        """An orbit as a search keeps it."""

    def period(self, point: Point) -> float:
        """The period of an orbit in the crowd's tau."""

    def again(self, motion: Motion, unit: Array) -> Known:
        """An orbit that was found before as a search keeps it."""

    def same(self, first: Array, second: Array, unit: Array, near: float) -> bool:
        """Whether two orbits, by their states, are one to a distance."""


@dataclass(frozen=True, eq=False)
class Forced:
    """Once in each period of the excitation; orbits of up to `periods` of them."""

    completion: Completion
    periods: int
    stretch = FORCED
    first = 32
    between = 1
    whole = True

    def lag(self, path: Array, unit: Array) -> float:
        """See `Clock`."""
        return period(path, self.periods, unit, NEAR)

    def nearly(self, path: Array) -> bool:
        """See `Clock`."""
        return period(path, self.periods, _range(path), NEARLY) > 0

    def patient(self) -> Clock:
        """See `Clock`."""
        return Patient(self.completion, self.periods)

    def off(self, path: Array, lag: float, unit: Array) -> float:
        """See `Clock`."""
        return apart(path, int(lag), unit)

    def complete(self, y: Array, modes: Sequence[int], lag: float) -> Point | None:
        """See `Clock`."""
        return self.completion.forced(y, modes, int(lag))

    def known(self, point: Point, lag: float, unit: Array, found: str) -> Known:
        """See `Clock`; of a number of periods that is not the least the least is taken."""
        periods = round(self.period(point) / FORCED)
        sections = point.orbit.state(FORCED * np.arange(periods, dtype=float))
        shifts = (k for k in range(1, periods + 1) if periods % k == 0)
        least = next(
            k for k in shifts if np.abs((np.roll(sections, k, 0) - sections) / unit).max() < NEAR * PART
        )
        return Known(sections[:least], least, point, found)

    def again(self, motion: Motion, unit: Array) -> Known:
        """See `Clock`."""
        return Known(motion.sections, motion.periods, motion.point, _how(motion), why=motion.why)

    def period(self, point: Point) -> float:
        """See `Clock`."""
        return float(point.orbit.mesh.period)

    def same(self, first: Array, second: Array, unit: Array, near: float) -> bool:
        """See `Clock`."""
        return same(first, second, unit, near)


@dataclass(frozen=True, eq=False)
class Patient(Forced):
    """The same, for orbits of up to LONGEST periods that motions have settled on, measured by their range."""

    def lag(self, path: Array, unit: Array) -> float:
        """See `Clock`."""
        return period(path, LONGEST, np.minimum(unit, _range(path)), NEAR)


@dataclass(frozen=True, eq=False)
class Free:
    """Often in each turn of a motion of a system that is not excited; y: where one is, (1, w)."""

    completion: Completion
    crowd: Crowd
    y: Array
    first = 2048
    between = 8
    whole = False

    @cached_property
    def stretch(self) -> float:
        """A fortieth of the time in which the fastest state goes to and fro."""
        n, width = len(self.crowd.system.states), FORCED / 64
        for _ in range(LONGER):
            path = self.crowd.run(self.y, SAMPLES, width, keep=True)
            assert path.sections is not None
            states = path.sections[0, SAMPLES // 2 :, :n]
            above = states > states.mean(axis=0)
            crossings = int((above[1:] != above[:-1]).sum(axis=0).max())
            if crossings >= TURNS:
                return 2 * width * len(states) / crossings / PER_TURN
            width *= 4
        return FORCED / PER_TURN

    def lag(self, path: Array, unit: Array) -> float:
        """See `Clock`."""
        last = path[-self.first // 2 :]
        if np.abs(np.ptp(last, axis=0) / unit).max() < STILL:
            return -1.0
        time = return_time(path[-self.first :], np.maximum(np.ptp(last, axis=0), STILL * unit), RETURNS)
        return 0.0 if math.isnan(time) else time

    def nearly(self, path: Array) -> bool:
        """See `Clock`."""
        last = path[-self.first :]
        return not math.isnan(return_time(last, _range(last), NEARLY))

    def patient(self) -> Clock:
        """See `Clock`."""
        return self

    def off(self, path: Array, lag: float, unit: Array) -> float:
        """See `Clock`."""
        return 0.0 if lag < 0 else apart(path, round(lag), unit)

    def complete(self, y: Array, modes: Sequence[int], lag: float) -> Point | None:
        """See `Clock`."""
        if lag < 0:
            n = len(self.crowd.system.states)
            return self.completion.equilibrium(y[:n], y[n:])
        return self.completion.free(y, modes, lag * self.stretch)

    def known(self, point: Point, lag: float, unit: Array, found: str) -> Known:
        """See `Clock`."""
        orbit = point.orbit
        if lag < 0:
            return Known(orbit.state(np.zeros(1)), 0, point, found)
        fine = self.completion.unscaled(orbit, np.linspace(0, FORCED, 20 * ALONG + 1))
        length = np.append(0.0, np.cumsum(np.abs(np.diff(fine, axis=0) / unit).max(axis=1)))
        at = np.searchsorted(length, np.linspace(0, length[-1], ALONG, endpoint=False))
        return Known(fine[at], 1, point, found, spacing=float(length[-1]) / ALONG)

    def again(self, motion: Motion, unit: Array) -> Known:
        """See `Clock`."""
        steps = np.abs(np.diff(motion.sections, axis=0, append=motion.sections[:1]) / unit)
        spacing = float(steps.max()) if motion.periods else 0.0
        return Known(motion.sections, motion.periods, motion.point, _how(motion), spacing, why=motion.why)

    def period(self, point: Point) -> float:
        """See `Clock`."""
        return self.completion.period(point.orbit)

    def same(self, first: Array, second: Array, unit: Array, near: float) -> bool:
        """See `Clock`."""
        if (len(first) == 1) != (len(second) == 1):
            return False
        one, other = first / unit, second / unit
        return all(
            float(np.max(KDTree(a).query(b, p=np.inf)[0])) < near for a, b in ((one, other), (other, one))
        )


def _range(path: Array) -> Array:
    """The range of each state of a motion (K, n), 1 where it does not change."""
    size = np.ptp(path, axis=0)
    return np.where(size > 0, size, 1.0)


def _how(motion: Motion) -> str:
    """How a motion was found, but for the starts that led to it: others are counted anew."""
    return "" if motion.starts else motion.found
