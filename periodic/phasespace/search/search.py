"""A search for all motions of a system at given parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.checks import positive, whole
from periodic.conditions.phase import PhaseCondition, excited
from periodic.correction.condition import Condition
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.box import Box, box_of
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.following.values import parameters
from periodic.phasespace.motion import Motion, Sort, interval
from periodic.phasespace.orbits.clocks import Clock, Forced, Free
from periodic.phasespace.orbits.completion import Completion
from periodic.phasespace.orbits.known import Known, Orbits
from periodic.phasespace.search.settle import Settling
from periodic.system import System, check_system, frequency_of

FINER = 100.0
"""How many times finer than orbits motions are integrated,"""

FINEST, COARSEST = 1e-12, 1e-8
"""... between these tolerances."""

WIDER = 3.0
"""How many times wider than the motion from rest the box is by default."""

LEAST = 1e-3
"""Least half width of that motion's ranges, in its largest state, or in scales where that is less."""

FROM_REST = 200
"""Periods after which that motion's ranges are taken."""

SAMPLES = 64
"""Samples of its last period."""


def search_of(
    system: System,
    values: Mapping[str, float] | None,
    box: Mapping[str, tuple[float, float]] | None,
    periods: int,
    starts: int,
    settle: int,
    places: int,
    seed: int,
    tol: float,
) -> Search:
    """Return a search as `motions` describes it. Raises ValueError."""
    check_system(system)
    for name, number, least in (("periods", periods, 1), ("starts", starts, 1), ("settle", settle, 1)):
        whole(name, number, least)
    for name, number in (("places", places), ("seed", seed)):
        whole(name, number, 0)
    parameter = parameters(system, values)
    crowd = Crowd(system, parameter, float(np.clip(positive("tol", tol) / FINER, FINEST, COARSEST)))
    where = box_of(system, parameter, box, _around(crowd))
    return Search(crowd, where, periods, starts, settle, places, seed, tol)


@dataclass(frozen=True, eq=False)
class Search:
    """A search for all motions: see `motions`."""

    crowd: Crowd
    box: Box
    periods: int
    starts: int
    settle: int
    places: int
    seed: int
    tol: float

    def settling(self, y: Array) -> Settling:
        """Return motions from y (S, w), not followed yet."""
        clock, unit = self.clock, self.box.width
        longest = int(np.ceil(self.settle * FORCED / clock.stretch))
        orbits = Orbits(unit, lambda first, second, near: clock.same(first, second, unit, near))
        return Settling(self.crowd, clock, y, orbits, longest)

    @cached_property
    def frequency(self) -> str:
        """The parameter that is 2 pi / period of a system that is not excited, else ""."""
        system = self.crowd.system
        if excited(system, self.crowd.parameter):
            return ""
        names = frequency_of(system)
        if len(names) != 1:
            raise ValueError("the system is not excited, and no one parameter is its omega; one must be")
        return names[0]

    @property
    def determined(self) -> dict[str, Condition]:
        """How the phase of an orbit of a system that is not excited is determined."""
        return {self.frequency: PhaseCondition()} if self.frequency else {}

    @cached_property
    def clock(self) -> Clock:
        """When motions are looked at."""
        completion = Completion(self.crowd, self.tol, self.frequency)
        if not self.frequency:
            return Forced(completion, self.periods)
        some = self.box.draw(1, self.seed, self.crowd.system, self.crowd.parameter)
        return Free(completion, self.crowd, self.crowd.begin(some))

    def motion(self, one: Known, of: int) -> Motion:
        """Return an orbit as it is given, with its share of a number of starts."""
        return Motion(
            Sort.PERIODIC if one.periods else Sort.EQUILIBRIUM,
            one.stable,
            one.periods,
            one.found or (f"by {one.starts} of the starts" if one.starts else "beside a start on its way"),
            one.sections,
            one.point,
            one.starts,
            one.starts / of,
            interval(one.starts, of),
            why=one.why,
        )


def _around(crowd: Crowd) -> Array:
    """Ranges (2, n) of the motion from rest, wider: the box by default."""
    rest = np.asarray(crowd.system.rest(crowd.parameter)[0], dtype=float)
    settled = crowd.run(crowd.begin(rest[None]), FROM_REST, FORCED)
    path = crowd.run(settled.ends, SAMPLES, FORCED / SAMPLES, modes=settled.modes, keep=True)
    assert path.sections is not None
    states = path.sections[0, :, : len(rest)]
    if not np.isfinite(states).all():
        return np.array([rest - WIDER, rest + WIDER])
    low, high = states.min(axis=0), states.max(axis=0)
    middle, least = (low + high) / 2, LEAST * max(1.0, float(np.abs(states).max()))
    half = np.maximum((high - low) / 2, least)
    return np.array([middle - WIDER * half, middle + WIDER * half])
