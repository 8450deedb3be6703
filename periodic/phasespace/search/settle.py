"""Where motions from many starts lead: those that come back are completed, the others told apart later."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.orbits.clocks import NEAR, PART, Clock
from periodic.phasespace.orbits.known import Known, Orbits
from periodic.results.point import Point
from periodic.system import STUCK, surfaces_of
from periodic.system.ensembles import DIVERGED, FOLLOWED

SETTLED = 1e-9
"""Distance between a motion and itself a period later at which it is an orbit, whether or not completed."""

ALIKE = 1e-2
"""Distance between two motions, in units of the states, that may settle to the same orbit."""

SPIRALS = 0.1
"""A motion that comes nearer to an orbit throughout ends there, from this distance on,"""

NEARER = 0.7
"""... where it has come nearer by this factor."""

LIMIT = 0.1
"""... and where the limit of its distance is no more than this part of the last one."""

KEPT = 32
"""Blocks as long as the first whose states are kept."""

LOOKS = 256
"""States of a motion by which it is told whether it comes nearer to an orbit."""

LONGER = 4
"""How many times as long those are followed that nearly come back when all others are done."""

COMPLETIONS = 24
"""Most motions that are completed after a block."""


@dataclass(eq=False)
class Settling:
    """Motions from y (S, w), followed until they end at an orbit, diverge, or have been followed long enough.

    orbits: those known so far. left: the indices of motions without an end, sections (left, K, n) their last
    states, held what friction holds in each. y, modes: where all are. early: states on their way. gone: the
    indices of motions that have grown beyond all bounds.
    """

    crowd: Crowd
    clock: Clock
    y: Array
    orbits: Orbits
    longest: int
    label: Any = field(init=False)
    modes: Any = field(default=None, init=False)
    gone: list[int] = field(default_factory=list, init=False)
    early: Array | None = field(default=None, init=False)
    sections: Array = field(default_factory=lambda: np.zeros((0, 0, 0)), init=False)
    held: list[frozenset[int]] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        self.label = np.full(len(self.y), -1)
        self.left = np.flatnonzero(np.isfinite(self.y).all(axis=1))

    @property
    def n(self) -> int:
        """Number of states."""
        return len(self.crowd.system.states)

    @property
    def unit(self) -> Array:
        """Of distances between states."""
        return self.orbits.unit

    def run(self) -> None:
        """Follow all motions to their ends."""
        done, block = 0, self.clock.first
        while len(self.left) and done < self.longest:
            self._follow(min(block, max(self.longest - done, self.clock.first)))
            done, block = done + block, 2 * block
            self._complete()
            self._spirals()
        self.clock, usual = self.clock.patient(), self.clock
        self._arrive()
        self._wait()
        self.clock = usual

    def _arrive(self) -> None:
        """Complete what comes back, and let others arrive there, until that adds no more."""
        before = -1
        while len(self.left) and len(self.orbits) != before:
            before = len(self.orbits)
            self._complete()
            if len(self.orbits) != before:
                self._follow(min(KEPT * self.clock.first, self.longest))

    def _wait(self) -> None:
        """Follow those further that nearly come back: they may settle slowly, or lock."""
        slow = np.array([self.clock.nearly(path) for path in self.sections], dtype=bool)
        if not slow.any():
            return
        rest, paths = self.left[~slow], self.sections[~slow]
        held = [held for held, one in zip(self.held, slow, strict=True) if not one]
        self.left, self.sections = self.left[slow], self.sections[slow]
        self._follow(LONGER * self.longest)
        self._arrive()
        self._spirals()
        kept = min(paths.shape[1], self.sections.shape[1]) if len(self.left) else paths.shape[1]
        self.left = np.concatenate([rest, self.left])
        last = self.sections[:, self.sections.shape[1] - kept :].reshape(-1, kept, self.n)
        self.sections = np.concatenate([paths[:, paths.shape[1] - kept :], last])
        self.held = held + self.held

    def _follow(self, count: int) -> None:
        """Follow what is left for some stretches; those that arrive at a stable orbit, or diverge, are done.

        The states of the last ones are kept.
        """
        kept = min(count, KEPT * self.clock.first)
        for some, keep in ((count - kept, False), (kept, True)):
            if not some or not len(self.left):
                continue
            found = self.crowd.run(
                self.y[self.left],
                some,
                self.clock.stretch,
                modes=None if self.modes is None else self.modes[self.left],
                keep=keep,
                targets=self.orbits.targets(),
            )
            if self.modes is None:
                self.modes = np.zeros((len(self.y), found.modes.shape[1]), dtype=np.intc)
            self.y[self.left], self.modes[self.left] = found.ends, found.modes
            self.gone += self.left[found.outcome == DIVERGED].tolist()
            self.held = [self.holds(*both) for both in zip(found.modes, found.changes, strict=True)]
            self.sections = np.zeros((len(self.left), 0, self.n))
            if found.sections is not None:
                self.sections = found.sections[:, :, : self.n]
            if self.early is None:
                self.early = self.sections[:, 1:].reshape(-1, self.n)
            self._end(found.label, found.outcome == FOLLOWED)

    def holds(self, modes: Any, changes: Any) -> frozenset[int]:
        """Return the surfaces that have been held for the whole of the last stretch."""
        each = enumerate(surfaces_of(self.crowd.system))
        loose = [i for i, s in each if s.releases is not None and not s.alone]
        return frozenset(i for i in loose if modes[i] == STUCK and not changes[i])

    def _end(self, ended: Any, going: Any = True) -> None:
        """Let motions end at orbits, -1 for those that go on where they are going."""
        for k, one in enumerate(self.orbits.each):
            mine = self.left[ended == k]
            self.label[mine] = k
            one.starts += len(mine)
        on = (ended < 0) & going
        self.held = [held for held, goes in zip(self.held, on, strict=True) if goes]
        self.left, self.sections = self.left[on], self.sections[on]

    def _complete(self) -> None:
        """Complete motions that come back to orbits, one of each group that are alike."""
        lags = [self.clock.lag(path, self.unit) for path in self.sections]
        both = zip(self.sections, lags, strict=True)
        off = [self.clock.off(path, lag, self.unit) if lag else np.inf for path, lag in both]
        order = sorted((k for k, lag in enumerate(lags) if lag), key=lambda k: off[k])
        tried: list[Array] = []
        ended = np.full(len(self.left), -1)
        for k in order:
            if not (self.clock.whole or lags[k] < 0):
                self.held[k] = frozenset()
            ended[k] = self.orbits.family(self.held[k], max(int(lags[k]), 0))
            own = self.sections[k][-max(round(lags[k]), 1) :]
            if ended[k] >= 0 or any(self.clock.same(own, other, self.unit, ALIKE) for other in tried):
                continue
            if len(tried) == COMPLETIONS:
                break
            tried.append(own)
            if not self.orbits.near(own[-1], NEAR):
                motion = int(self.left[k])
                ended[k] = self._one(self.y[motion], self.modes[motion], own, self.held[k], lags[k], off[k])
        self._end(ended)

    def settled(self, y: Array, modes: Any, path: Array) -> int | None:
        """Return on which orbit a motion at y (w,) with states (K, n) has settled; a new one is completed."""
        clock = self.clock.patient()
        lag = clock.lag(path, self.unit) if clock.whole else 0.0
        if not lag:
            return None
        states = path[-round(lag) :]
        self._one(y, modes, states, frozenset(), lag, clock.off(path, lag, self.unit))
        near = NEAR * PART
        alike = (clock.same(one.sections, states, self.unit, near) and one.stable for one in self.orbits.each)
        return next((k for k, same in enumerate(alike) if same), None)

    def arrived(self, motion: int, orbit: int) -> None:
        """Let a motion end at an orbit."""
        self.label[motion] = orbit
        self.orbits.each[orbit].starts += 1

    def _one(self, y: Array, modes: Any, states: Array, held: frozenset[int], lag: float, off: float) -> int:
        """Complete one motion; where that fails one that has settled is known by its simulation.

        Returns which of the orbits it is if there is no doubt: where friction holds something; else -1.
        """
        point, added = self.clock.complete(y, list(modes), lag), False
        if point is not None:
            added = self.add(point, lag, "", held)
        if off < SETTLED and not (held or (point is not None and self._is(point, lag, states))):
            why = "seen in simulations; no orbit was found beside it"
            added = self.orbits.add(Known(states, max(int(lag), 0), None, "", why=why, held=held), ALIKE)
        return len(self.orbits) - 1 if held and added else -1

    def _is(self, point: Point, lag: float, states: Array) -> bool:
        """Whether an orbit is the motion from which it was completed, by its states; not one nearby."""
        if not self.clock.whole:
            return True
        return self.clock.same(self.clock.known(point, lag, self.unit, "").sections, states, self.unit, NEAR)

    def add(self, point: Point, lag: float, found: str, held: frozenset[int] = frozenset()) -> bool:
        """Add an orbit unless it is known; whether it was added."""
        made = self.clock.known(point, lag, self.unit, found)
        if held:
            names = [surfaces_of(self.crowd.system)[i].name for i in sorted(held)]
            made.held, made.why = held, f"a family: {' and '.join(names)} held all along, wherever it is"
        return self.orbits.add(made, NEAR * PART)

    def _spirals(self) -> None:
        """Let motions end that come nearer to a stable orbit throughout, slowly."""
        ended = np.full(len(self.left), -1)
        for i, path in enumerate(self.sections):
            each = enumerate(self.orbits.each)
            ended[i] = next((k for k, one in each if one.stable and self._nears(path, one)), -1)
        self._end(ended)

    def _nears(self, path: Array, one: Known) -> bool:
        """Whether a motion is near an orbit, comes nearer in each third of its path, and will reach it.

        Three distances that shrink by a factor have the limit that Aitken's formula gives: 0, not beside it.
        """
        if one.apart(path[-1], self.unit) > SPIRALS:
            return False
        every = max(1, len(path) // LOOKS // max(one.periods, 1)) * max(one.periods, 1)
        tree = KDTree(one.sections / self.unit)
        away = np.asarray(tree.query(path[::-every][::-1] / self.unit, p=np.inf)[0])
        third = len(away) // 3
        a, b, c = (float(part.mean()) for part in np.split(away[-3 * third :], 3))
        if not (c < b < a and c < NEARER * a):
            return False
        bend = a - 2 * b + c
        return bend > 0 and abs(c - (b - c) ** 2 / bend) < LIMIT * c
