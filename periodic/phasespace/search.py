"""A search for all motions of a system at given parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.checks import named, positive, whole
from periodic.conditions.phase import PhaseCondition, excited
from periodic.correction.condition import Condition
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.aperiodic import Attractors
from periodic.phasespace.box import Box, box_of
from periodic.phasespace.clocks import Clock, Forced, Free
from periodic.phasespace.crowd import Crowd
from periodic.phasespace.images import Images
from periodic.phasespace.known import Known, Orbits
from periodic.phasespace.manifolds import Manifolds
from periodic.phasespace.motion import Motion, Motions, Sort, interval
from periodic.phasespace.orbits import Completion
from periodic.phasespace.round import Round
from periodic.phasespace.settle import Settling
from periodic.phasespace.symmetries import symmetries_of
from periodic.phasespace.unexcited import Unexcited
from periodic.phasespace.unstable import Unstable
from periodic.phasespace.values import parameters
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

    def run(self, along: Mapping[str, tuple[float, float]], say: Callable[[str], None]) -> Motions:
        """Return what is found."""
        settling = self.settled()
        say(f"{len(settling.orbits)} orbits from {self.starts} starts")
        tried = [
            f"{self.starts} motions from random places in the box, for {self.settle} periods at the most"
        ]
        others = Attractors(self.crowd, settling.clock, settling.unit)
        labels = others.sorted_of(settling)
        say(f"{len(others.found)} other attractors")
        if self.places:
            tried += [self._unstable(settling), Manifolds(settling).run()]
            say(f"{len(settling.orbits)} orbits with unstable ones")
        for name, bounds in named("along", along, "ranges of parameters").items():
            tried.append(Round(settling, name, bounds, self.tol, self._determined).run())
        images = Images(settling, symmetries_of(self.crowd, self.box, self.seed, not self.frequency))
        if images.symmetries:
            tried.append(images.run())
        made = [self.motion(one, self.starts) for one in settling.orbits.each]
        made += [others.motion(k, int((labels == k).sum()), self.starts) for k in range(len(others.found))]
        undecided = self.starts - len(settling.gone) - sum(motion.starts for motion in made)
        names = [p.name for p in self.crowd.system.parameters]
        made.sort(key=lambda motion: (not motion.stable, -motion.starts, motion.periods))
        return Motions(
            images.marked(tuple(made), others),
            dict(zip(names, self.crowd.parameter.tolist(), strict=True)),
            self.box.ranges,
            self.starts,
            len(settling.gone),
            undecided,
            tuple(tried),
        )

    def settled(self) -> Settling:
        """Return motions from all starts, followed to their ends."""
        system, parameter = self.crowd.system, self.crowd.parameter
        y = self.crowd.begin(self.box.draw(self.starts, self.seed, system, parameter))
        settling = self.settling(y)
        settling.run()
        return settling

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
    def _determined(self) -> dict[str, Condition]:
        return {self.frequency: PhaseCondition()} if self.frequency else {}

    @cached_property
    def clock(self) -> Clock:
        """When motions are looked at."""
        completion = Completion(self.crowd, self.tol, self.frequency)
        if not self.frequency:
            return Forced(completion, self.periods)
        some = self.box.draw(1, self.seed, self.crowd.system, self.crowd.parameter)
        return Free(completion, self.crowd, self.crowd.begin(some))

    def _unstable(self, settling: Settling) -> str:
        """Add unstable orbits, or equilibria and cycles; what was tried, in words."""
        if self.frequency:
            return Unexcited(settling, self.box, self.places, self.seed).run()
        return Unstable(settling, self.box, self.periods, self.places, self.seed).run()

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
