"""A motion followed from event to event: pieces in the same modes, from one zero of a guard to the next.

A piece is integrated ahead, and the guards of its modes are evaluated along it. Where their enclosures do not
prove that they stay positive, the phases are refined until that is decided. Where a guard falls to 0 the
motion starts anew in the modes after the event, and is mapped at an impact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from symbolic.arrays import Array
from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.enclosures import Passed, Root, crossing, lowest, root
from symbolic.integration.modes import Event, Guard, Modes, Switching
from symbolic.interrupts import interruptible

LONGEST = math.pi / 32
"""Longest interval (rad) between two phases at which guards are evaluated."""

PERIOD = 2 * math.pi
"""Of the excitation, in tau: the longest stretch integrated before guards are checked along it."""

LEAST = 4
"""Fewest intervals that are integrated at once."""

PARTS = 16
"""Into how many an interval is cut in which a guard may fall to 0."""

SHORTEST = 1e-6
"""Intervals (rad) that are cut no more: an excursion within one is as deep as rounding."""

NOISE = 1e-12
"""A guard that is as near to 0, as a part of its largest value, is at it."""

SHARP = 1e-3
"""The same in tolerances of the integration."""

BESIDE = 1e-13
"""Distance of a guard from 0, as a part of its largest value, where a piece ends and the next begins."""

MOST_EVENTS = 1000
"""Most events in a period: after more they pile up in a point."""

Sweep = Callable[[Modes, Array, Array], Array]
"""Integrates in some modes from y (w,) at phase[0] to all of phase (K,): y at each, shape (K, w)."""

Look = Callable[[Modes, Array, Array], tuple[Array, Array]]
"""All switches and their derivatives in tau along a motion (K, w) in some modes, (K, switches) each."""


@dataclass(frozen=True)
class Passage:
    """An event: where a guard falls to 0, y and the modes after it, and whether y was mapped at an impact."""

    root: Root
    y: Array
    modes: Modes
    mapped: bool


@dataclass(frozen=True)
class Followed:
    """A motion at the given phases, (K, w), the events on its way, and the modes at its end."""

    values: Array
    passages: list[Passage]
    events: tuple[Event, ...]
    modes: Modes

    def with_impacts(self, phase: Array) -> tuple[Array, Array]:
        """Return phases and values with each impact twice, before and after it."""
        impacts = [p for p in self.passages if p.mapped]
        at = [p.root.before for p in impacts]
        places = np.repeat(np.searchsorted(phase, at), 2)
        each = np.reshape([y for p in impacts for y in (p.root.y_before, p.y)], (-1, self.values.shape[1]))
        return np.insert(phase, places, np.repeat(at, 2)), np.insert(self.values, places, each, axis=0)


@dataclass(frozen=True)
class Seen:
    """Guards and their derivatives along a piece, (K, guards) each, with phases (K,) and y (K, w)."""

    phase: Array
    y: Array
    guards: Array
    rates: Array

    def at(self, j: int, k: int, level: Array) -> Passed:
        """Return a guard less its level at a phase."""
        value, rate = self.guards[j, k] - level[k], self.rates[j, k]
        return Passed(float(self.phase[j]), self.y[j], float(value), float(rate))


@dataclass(eq=False)
class Follower:
    """Follows one motion of y = (x, z).

    Parameters
    ----------
    switching : Switching
        The modes of its system.
    sweep : callable
        (modes, y, phase) to y along phases; raises IntegrationError.
    look : callable
        (modes, values, phase) to all switches and their derivatives in tau.
    settle : callable
        (y, tau) to the nearest y that fulfils the constraints.
    states : int
        How many of y are states.
    """

    switching: Switching
    sweep: Sweep
    look: Look
    settle: Callable[[Array, float], Array]
    states: int
    _passages: list[Passage] = field(default_factory=list, init=False)
    _events: list[Event] = field(default_factory=list, init=False)

    def run(
        self, start: Array, phase: Array, modes: Modes | None = None, earlier: Modes | None = None
    ) -> Followed:
        """Integrate from phase[0] to all of `phase`, which rises. Raises IntegrationError.

        modes: those to begin with, by default as the state has them; earlier: those before, of which relays
        and friction that sticks keep theirs.
        """
        y = start
        if modes is None:
            state, modes = self.switching.begin(float(phase[0]), y[: self.states], earlier)
            y = self._with(y, state, float(phase[0]))
        self._most = MOST_EVENTS * math.ceil((phase[-1] - phase[0]) / PERIOD)
        self._enter(modes)
        with interruptible() as self._raised:
            values = self._all(y, phase)
        return Followed(values, self._passages, tuple(self._events), self._modes)

    def _all(self, y: Array, phase: Array) -> Array:
        """The motion at all phases."""
        if not self._guards:
            return self.sweep(self._modes, y, phase)
        every, wanted = _filled(phase)
        most = max(LEAST, math.ceil((len(every) - 1) * PERIOD / (every[-1] - every[0])))
        found, i, begun, ahead = [y[None]], 0, 0, most
        while i < len(every) - 1:
            values = self._ahead(found[-1][-1], every[i : i + ahead + 1])
            last, event = self._looked(values, every[i : i + len(values)])
            found.append(values[1 : last + 1])
            i += last
            if event is None:
                ahead = min(2 * ahead, most)
            else:  # the next piece may be as long as this one
                found.append(self._across(*event, every[i + 1])[None])
                i += 1
                ahead, begun = max(LEAST, _power_of_2((i - begun) // 2)), i
        return np.concatenate(found)[wanted]

    def _enter(self, modes: Modes) -> None:
        """Begin a piece in some modes."""
        self._modes, self._guards = modes, self.switching.guards(modes)
        self._places = [guard.switch for guard in self._guards]
        self._signs = np.array([guard.sign for guard in self._guards])
        self._size = np.zeros(len(self._guards))
        self._least: Array | None = None

    def _ahead(self, y: Array, phase: Array) -> Array:
        """The piece as far as integration succeeds: an event may come before the point of failure."""
        count = len(phase)
        while True:
            if self._raised:
                raise self._raised[0]
            try:
                return self.sweep(self._modes, y, phase[:count])
            except IntegrationError as error:
                if self._raised:  # an integrator took it for a failure of the equations
                    raise self._raised[0] from None
                reached = int((phase[:count] <= error.phase).sum())
                if not 1 < reached < count:
                    raise
                count = reached

    def _seen(self, values: Array, phase: Array) -> Seen:
        """The guards along a piece."""
        s, rate = self.look(self._modes, values, phase)
        return Seen(phase, values, s[:, self._places] * self._signs, rate[:, self._places] * self._signs)

    def _looked(self, values: Array, phase: Array) -> tuple[int, tuple[Array, float] | None]:
        """The last value of a piece before an event, and y and phase after that, None where there is none."""
        if not self._guards:
            return len(values) - 1, None
        seen = self._seen(values, phase)
        for j, fallen, certain in self._doubts(seen):
            before, left, right = len(self._passages), float(phase[j]), float(phase[j + 1])
            if right - left > SHORTEST and not certain:
                after = self._across(values[j], left, right), right
            elif len(fallen):
                after = self._event(seen, j, fallen)
            if len(self._passages) > before:
                return j, after
        return len(values) - 1, None

    def _doubts(self, seen: Seen) -> list[tuple[int, NDArray[np.int_], bool]]:
        """Intervals in which guards may fall to 0, those below 0 at the end, and whether no others may."""
        g = seen.guards
        self._size = np.maximum(self._size, np.abs(g).max(axis=0))
        if self._least is None:
            self._least = np.minimum(g[0], 0.0)
        below = lowest(g, seen.rates, seen.phase) < self._floor
        ends = below & (g[1:] < self._floor)
        at = np.flatnonzero(below.any(axis=1))
        return [(int(j), np.flatnonzero(ends[j]), bool((ends[j] == below[j]).all())) for j in at]

    @property
    def _floor(self) -> Array:
        """The levels that guards fall below at an event: 0, or where they begin, less rounding."""
        assert self._least is not None
        return np.asarray(self._least - NOISE * self._size - SHARP * self.switching.tolerance)

    def _across(self, y: Array, begin: float, end: float) -> Array:
        """y at the end of an interval, through all events in it."""
        while begin < end:
            phase = np.linspace(begin, end, (PARTS if end - begin > SHORTEST else 1) + 1)
            values = self._ahead(y, phase)
            last, event = self._looked(values, phase[: len(values)])
            y, begin = (values[last], float(phase[last])) if event is None else event
        return y

    def _event(self, seen: Seen, j: int, fallen: NDArray[np.int_]) -> tuple[Array, float]:
        """y after the first event in an interval, and where it is."""
        level = np.where(seen.guards[j] > 0, 0.0, self._floor)  # or where a guard begins, if it is below 0
        low, high = ({k: seen.at(i, k, level) for k in fallen} for i in (j, j + 1))
        found, earlier = None, list(fallen)
        while earlier:  # another may have fallen before the one whose cubic did first
            k = min(earlier, key=lambda k: crossing(low[k], high[k])) if len(earlier) > 1 else earlier[0]
            found = root(self._onward, self._above(k, level), low[k], high[k], BESIDE * float(self._size[k]))
            before = self._seen(found.y_before[None], np.array([found.before]))
            high = {k: before.at(0, k, level) for k in fallen}
            earlier = [k for k in fallen if high[k].value < 0 and found.before > low[k].phase]
        assert found is not None
        now = self._seen(found.y_after[None], np.array([found.after])).guards[0]
        return self._passed(found, [self._guards[k] for k in fallen if now[k] <= 0])

    def _onward(self, tau: float, y: Array, later: float) -> Array:
        return self.sweep(self._modes, y, np.array([tau, later]))[-1]

    def _above(self, k: int, level: Array) -> Callable[[float, Array], Passed]:
        """A guard less its level along a motion."""
        return lambda tau, y: self._seen(y[None], np.array([tau])).at(0, k, level)

    def _passed(self, found: Root, fallen: Sequence[Guard]) -> tuple[Array, float]:
        """Apply an event to the motion: y and the phase after it."""
        mapped, before = self.switching.maps(fallen), self._modes
        at, y = (found.before, found.y_before) if mapped else (found.after, found.y_after)
        if len(self._passages) == self._most:
            raise IntegrationError(f"events pile up at tau = {at:.6g}", at)
        state, after = self.switching.passed(fallen, before, at, y[: self.states])
        y = self._with(y, state, at)
        self._passages.append(Passage(found, y, after, mapped))
        self._events += self.switching.events(before, after, fallen, at)
        self._enter(after)
        return y, at

    def _with(self, y: Array, state: Array, at: float) -> Array:
        if np.array_equal(state, y[: self.states]):
            return y
        return self.settle(np.concatenate([state, y[self.states :]]), at)


def _power_of_2(number: int) -> int:
    """The largest power of 2 up to a number, so that few integrators are needed; 0 for 0."""
    return 1 << number.bit_length() >> 1


def _filled(phase: Array) -> tuple[Array, NDArray[np.int_]]:
    """Phases that are nowhere farther apart than LONGEST, and the indices of the given ones."""
    counts = np.maximum(np.ceil(np.diff(phase) / LONGEST), 1).astype(int)
    places = np.append(0, np.cumsum(counts))
    inner = np.arange(places[-1]) - np.repeat(places[:-1], counts)
    every = np.repeat(phase[:-1], counts) + np.repeat(np.diff(phase) / counts, counts) * inner
    return np.append(every, phase[-1]), places
