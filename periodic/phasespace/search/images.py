"""Images of the motions of a search under the symmetries of its equations."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from periodic.orbit.scheme import Array
from periodic.phasespace.motion import Motion
from periodic.phasespace.orbits.clocks import NEAR, PART
from periodic.phasespace.orbits.known import Known
from periodic.phasespace.search.aperiodic import Attractors
from periodic.phasespace.search.settle import Settling
from periodic.phasespace.search.symmetries import Symmetry


@dataclass(frozen=True, eq=False)
class Images:
    """The motions of a search beside each other under symmetries."""

    settling: Settling
    symmetries: tuple[Symmetry, ...]

    def run(self) -> str:
        """Add images of orbits that are not known; return what was tried, in words."""
        more, settling = 0, self.settling
        for one in list(settling.orbits.each):
            for symmetry in self.symmetries if one.point is not None and not one.held else ():
                states = symmetry.image(settling.crowd, one.sections)
                if np.isfinite(states).all() and not any(
                    self._same(states, other.sections, one.spacing + other.spacing)
                    for other in settling.orbits.each
                ):
                    more += self._added(one, states)
        told = "; ".join(symmetry.name for symmetry in self.symmetries)
        return f"images under symmetries of the equations ({told}): {more} more orbits"

    def marked(self, motions: tuple[Motion, ...], others: Attractors) -> tuple[Motion, ...]:
        """Return motions that know the indices of their images."""
        return tuple(replace(motion, images=self._indices(motion, motions, others)) for motion in motions)

    def _indices(self, motion: Motion, motions: tuple[Motion, ...], others: Attractors) -> tuple[int, ...]:
        found = set[int]()
        for symmetry in self.symmetries:
            states = symmetry.image(self.settling.crowd, motion.sections)
            if np.isfinite(states).all():
                alike = (k for k, other in enumerate(motions) if self._one(states, motion, other, others))
                found |= set(alike)
        return tuple(sorted(found))

    def _one(self, states: Array, motion: Motion, other: Motion, others: Attractors) -> bool:
        """Whether the image of a motion, by its states, is another."""
        if motion.sort != other.sort or motion.periods != other.periods:
            return False
        if not motion.comes_back:
            return others.on(states, other.sections)
        clock, unit = self.settling.clock, self.settling.unit
        spacing = sum(clock.again(each, unit).spacing for each in (motion, other))
        return self._same(states, other.sections, spacing)

    def _same(self, states: Array, other: Array, spacing: float) -> bool:
        return self.settling.clock.same(states, other, self.settling.unit, NEAR * PART + spacing)

    def _added(self, one: Known, states: Array) -> bool:
        """Complete the image of an orbit, by its states, and add it."""
        settling = self.settling
        assert one.point is not None
        y = settling.crowd.begin(states[:1])
        modes = settling.crowd.run(y, 0, settling.clock.stretch).modes[0]
        lag = -1.0 if not one.periods else settling.clock.period(one.point) / settling.clock.stretch
        point = settling.clock.complete(y[0], list(modes), round(lag) if settling.clock.whole else lag)
        return point is not None and settling.add(point, lag, "the image of another")
