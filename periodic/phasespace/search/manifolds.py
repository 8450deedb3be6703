"""Where the unstable manifolds of unstable orbits lead: from beside each of them, to either side."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from periodic.orbit.scheme import Array
from periodic.phasespace.orbits.known import Known
from periodic.phasespace.search.settle import Settling

BESIDE = 1e-4
"""How far from an orbit motions start, in units of the states."""

SHORTER = 4
"""By how much shorter they are followed: those that go round on attractors without a period are known."""

DIRECTIONS = 2
"""Along how many of its most unstable directions, to either side."""


@dataclass(frozen=True, eq=False)
class Manifolds:
    """The search for attractors on the unstable manifolds of the known orbits of a search."""

    settling: Settling

    def run(self) -> str:
        """Add the attractors to the orbits known; return what was tried, in words."""
        unstable = [one for one in self.settling.orbits.each if not one.stable]
        starts = [state for one in unstable for state in self._beside(one)]
        before = len(self.settling.orbits.each)
        if starts:
            counts = [one.starts for one in self.settling.orbits.each]
            y = self.settling.crowd.begin(np.array(starts))
            other = replace(self.settling, y=y, longest=self.settling.longest // SHORTER)
            other.run()
            for one, count in zip(self.settling.orbits.each, counts, strict=False):
                one.starts = count
            for one in self.settling.orbits.each[before:]:
                one.starts, one.found = 0, one.found or "beside an unstable one"
        found = len(self.settling.orbits.each) - before
        return f"motions from beside {len(unstable)} unstable orbits, to either side: {found} more orbits"

    def _length(self, one: Known) -> float:
        """The period of an orbit in tau, a stretch for an equilibrium."""
        if one.periods == 0 or one.point is None:
            return self.settling.clock.stretch
        return self.settling.clock.period(one.point)

    def _beside(self, one: Known) -> list[Array]:
        """States beside an orbit, along the eigenvectors of its map that grow."""
        settling, n = self.settling, self.settling.n
        y = settling.crowd.begin(one.sections[:1])
        tangents = settling.crowd.tangents(y)
        path = settling.crowd.run(y, 1, self._length(one), tangents=tangents, raw=True)
        slope = path.tangents[0, :, :n].T
        if not np.isfinite(slope).all():
            return []
        values, vectors = np.linalg.eig(slope)
        order = np.argsort(-np.abs(values))[:DIRECTIONS]
        growing = [vectors[:, k].real for k in order if abs(values[k]) > 1]
        steps = [BESIDE * v / np.abs(v / settling.unit).max() for v in growing if np.abs(v).max() > 0]
        return [one.sections[0] + side * step for step in steps for side in (-1, 1)]
