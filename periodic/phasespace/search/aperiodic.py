"""Attractors that no motion comes back to: tori and chaos, told apart and told from each other."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.lyapunov import SIGMAS, LyapunovError, exponents_of, rate_of
from periodic.phasespace.motion import Motion, Sort, interval
from periodic.phasespace.orbits.clocks import Clock
from periodic.phasespace.search.birkhoff import DIGITS, digits, rotation_number
from periodic.phasespace.search.settle import Settling
from periodic.system.ensembles import FOLLOWED

LENGTHS = (4000, 8000, 16000, 32000)
"""Periods of a motion from which it is told what it is: more where fewer do not show a torus."""

LYAPUNOV = 2000
"""Periods over which its exponent is averaged."""

POINTS = 400
"""Points of a motion that are looked for on another's attractor."""

SPACINGS = 4.0
"""How far from an attractor's points others are on it: in distances of 95 % of its points from the next."""

ALIKE = 1e-2
"""... or this part of the attractor's size: the points of a torus near a resonance leave gaps."""

SAME = 1e-6
"""How near rotation numbers of one torus are."""

SHARE = 0.9
"""Part of a motion's points that must be on an attractor on which it is."""


@dataclass(frozen=True, eq=False)
class Attractor:
    """What is known of one: sections (K, n) of a motion on it, what it is, exponent and rotation number."""

    sections: Array
    sort: Sort
    exponent: float
    rotation: float
    why: str = ""

    def has(self, sections: Array, unit: Array) -> bool:
        """Return whether a motion is on it; on one that was lost none is."""
        if not len(self.sections):
            return False
        tree = KDTree(self.sections / unit)
        own = np.asarray(tree.query(self.sections[-POINTS:] / unit, k=2)[0])[:, 1]
        size = float(np.ptp(self.sections / unit, axis=0).max())
        near = np.asarray(tree.query(sections[-POINTS:] / unit)[0])
        return bool((near < max(SPACINGS * np.quantile(own, 0.95), ALIKE * size)).mean() > SHARE)

    def alike(self, other: Attractor, unit: Array) -> bool:
        """Return whether another is the same torus, of which motions near a resonance show other points."""
        if not (self.sort == other.sort == Sort.TORUS and abs(self.rotation - other.rotation) < SAME):
            return False
        both = [one.sections / unit for one in (self, other)]
        near = ALIKE * float(np.ptp(both[0], axis=0).max())
        means, sizes = ([f(states, axis=0) for states in both] for f in (np.mean, np.ptp))
        return bool(max(np.abs(each[0] - each[1]).max() for each in (means, sizes)) < near)


@dataclass(frozen=True, eq=False)
class Attractors:
    """The attractors of motions that have not come back."""

    crowd: Crowd
    clock: Clock
    unit: Array
    found: list[Attractor] = field(default_factory=list)

    def sorted_of(self, settling: Settling) -> Any:
        """Return of each motion that is left on which of `found` it is; -1 of those that come back later."""
        labels = []
        for i, path in zip(settling.left, settling.sections, strict=True):
            mine = [k for k, one in enumerate(self.found) if one.has(path, self.unit)]
            if not mine:
                made = self._described(settling, int(i))
                if not isinstance(made, Attractor):
                    settling.arrived(int(i), made)
                    labels.append(-1)
                    continue
                mine = [k for k, one in enumerate(self.found) if one.alike(made, self.unit)]
                if not mine:
                    mine = [len(self.found)]
                    self.found.append(made)
            labels.append(mine[0])
        return np.array(labels, dtype=int)

    def add(self, motion: Motion) -> None:
        """Add an attractor that was found before."""
        self.found.append(
            Attractor(motion.sections, motion.sort, motion.exponent, motion.rotation, motion.why)
        )

    def on(self, sections: Array, those: Array) -> bool:
        """Return whether a motion is on the attractor that is known by those sections."""
        return any(one.has(sections, self.unit) for one in self.found if one.sections is those)

    def _described(self, settling: Settling, i: int) -> Attractor | int:
        """A motion on an attractor, followed further: chaotic where neighbours part, whatever averages say.

        Where it comes back after all, as after chaos for a while, the index of the orbit on which it settles.

        Chaos in bands that a motion visits in turn has averages as good as a torus'.
        """
        y, modes = settling.y[i][None], settling.modes[i][None]
        sections, smooth, targets = np.zeros((0, len(self.unit))), False, settling.orbits.targets()
        width = self.clock.stretch * self.clock.between
        for length in LENGTHS:
            path = self.crowd.run(y, length - len(sections), width, modes=modes, keep=True, targets=targets)
            assert path.sections is not None
            if path.label[0] >= 0:
                return int(path.label[0])
            sections = np.concatenate([sections, path.sections[0, 1:, : len(self.unit)]])
            if path.outcome[0] != FOLLOWED:
                why = "it was lost when followed further"
                return Attractor(sections[:0], Sort.OPEN, math.nan, math.nan, why)
            y, modes = path.ends, path.modes
            if (orbit := settling.settled(y[0], modes[0], sections)) is not None:
                return orbit
            size = np.ptp(sections, axis=0)
            smooth = digits(sections, np.where(size > 0, size, 1.0)) > DIGITS
            if smooth:
                break
        try:
            growth = exponents_of(self.crowd, y, modes, 1, LYAPUNOV)
        except LyapunovError as lost:
            return Attractor(sections, Sort.OPEN, math.nan, math.nan, str(lost))
        value, error = (float(rate_of(self.crowd) * each[0]) for each in (growth.mean, growth.error))
        if value > SIGMAS * error:
            return Attractor(sections, Sort.CHAOTIC, value, math.nan)
        if smooth:
            turns = rotation_number(sections, size) if self.clock.whole else math.nan
            return Attractor(sections, Sort.TORUS, value, turns)
        largest = f"largest Lyapunov exponent {value:.2g} +- {error:.1g} 1/s"
        return Attractor(
            sections, Sort.OPEN, value, math.nan, f"neither torus nor chaos is certain: {largest}"
        )

    def motion(self, k: int, starts: int, of: int) -> Motion:
        """Return one of them as it is given."""
        one = self.found[k]
        return Motion(
            one.sort,
            True,
            0,
            f"by {starts} of the starts",
            one.sections,
            None,
            starts,
            starts / of,
            interval(starts, of),
            one.exponent,
            one.rotation,
            one.why,
        )
