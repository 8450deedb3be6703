"""The modes of a system's surfaces along a motion: what ends a piece of it, and the modes of the next.

A surface is on a side of its guard, PLUS or MINUS, or STUCK: friction that sticks, a slider that is held,
a mass that rests on a wall after complete chatter. A relay is on or off, PLUS or MINUS, and has a different
guard in either mode.
Which joints stick where several come to rest or tear off at once is a linear complementarity problem: each
sticks where up < 0 < down, slips up where up >= 0, down where down <= 0, given the modes of the others. It is
solved by Murty's least-index rule, which terminates if the matrix of the problem is a P-matrix.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.equations.surfaces import MINUS, PLUS, STUCK, Kind, Surface
from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.field import VectorField

Modes = tuple[int, ...]
"""The mode of every surface of a system, in their order; 0 of surfaces that have none."""

LOW = 0.1
"""Height of a bounce, in tolerances, up to which the motion rests."""

NONE = 1e-8
"""Relative residual up to which a slider's guard is a combination of friction's guards: half the digits."""

PIVOTS = 1000
"""Most changes of a mode until all are consistent."""


class Switched(Protocol):
    """The members of a system that is integrated from event to event."""

    @property
    def expressions(self) -> Expressions: ...
    @property
    def surfaces(self) -> Sequence[Surface]: ...
    @property
    def field(self) -> VectorField: ...
    def switch(self, state: Array, phase: Array, parameter: Array, side: Array | None = None) -> Array: ...
    def switch_gradient(
        self, state: Array, phase: Array, parameter: Array, side: Array | None = None
    ) -> tuple[Array, Array, Array]: ...
    def reset(self, switch: int, state: Array, phase: Array, parameter: Array) -> Array: ...
    def rest(self, parameter: Array) -> tuple[Array, Array]: ...


@dataclass(frozen=True)
class Event:
    """A change of mode along a motion.

    Parameters
    ----------
    surface : int
        Index of the surface among those of the system.
    before, after : int
        Its modes; the same at an impact.
    phase : float
        tau.
    modes : tuple of int
        Those of all surfaces afterwards.
    """

    surface: int
    before: int
    after: int
    phase: float
    modes: Modes


@dataclass(frozen=True)
class Guard:
    """A function that is positive as long as a surface keeps its mode: a switch, times a sign."""

    surface: int
    switch: int
    sign: int


@dataclass(frozen=True, eq=False)
class Switching:
    """The modes along motions of a system at some parameters.

    Parameters
    ----------
    system : Switched
        The system.
    parameter : ndarray, shape (p,)
        SI.
    tolerance : float
        Values of guards up to this count as 0.
    """

    system: Switched
    parameter: Array
    tolerance: float

    @property
    def surfaces(self) -> Sequence[Surface]:
        """Those of the system."""
        return self.system.surfaces

    def side(self, modes: Modes) -> Array:
        """Return the sides of the equations' jumps, (columns,); 0 in columns without a surface."""
        found = np.zeros(self._columns)
        for surface, mode in zip(self.surfaces, modes, strict=True):
            if surface.column is not None:
                found[surface.column] = mode
        return found

    @cached_property
    def _columns(self) -> int:
        return int(self.system.expressions.sided.side.numel())

    @staticmethod
    def _rests(surface: Surface, mode: int) -> bool:
        """Whether something is at rest on a wall."""
        return surface.kind == Kind.IMPACT and mode == STUCK

    def guards(self, modes: Modes) -> list[Guard]:
        """Return the functions that are positive as long as surfaces keep some modes."""
        found = []
        for i, (surface, mode) in enumerate(zip(self.surfaces, modes, strict=True)):
            if mode == STUCK and surface.releases is not None:
                up, down = surface.releases
                found += [Guard(i, up, -1), Guard(i, down, 1)]
            elif mode == STUCK and surface.leaves is not None:
                found.append(Guard(i, surface.leaves, -1))
            elif mode:
                found.append(Guard(i, surface.switch, mode))
        return found

    def begin(self, tau: float, state: Array, earlier: Modes | None = None) -> tuple[Array, Modes]:
        """Return the modes at the beginning of a motion, and the state projected on them.

        earlier: modes before it, in which relays, and friction that sticks, stay where they may.
        """
        values = self._at((0,) * len(self.surfaces), tau, state)
        modes = [self._first(surface, values) for surface in self.surfaces]
        if earlier is not None:
            each = zip(self.surfaces, modes, earlier, strict=True)
            modes = [before if _stays(surface, before) else mode for surface, mode, before in each]
        lying = (self._settles(surface, values, tau, state) for surface in self.surfaces)
        modes = [STUCK if lies else mode for mode, lies in zip(modes, lying, strict=True)]
        return self.consistent(tuple(self._relayed(modes, tau, state)), tau, state)

    def _relayed(self, modes: list[int], tau: float, state: Array) -> list[int]:
        """The modes with relays switched whose threshold has been passed, one that others depend on first."""
        found = list(modes)
        for i, surface in enumerate(self.surfaces):
            if (
                surface.kind == Kind.RELAY
                and found[i] * self._at(tuple(found), tau, state)[surface.switch] < 0
            ):
                found[i] = -found[i]
        return found

    def _first(self, surface: Surface, values: Array) -> int:
        """The mode of a surface as its guard has it."""
        if surface.kind == Kind.MARKER:
            return 0
        if surface.kind == Kind.IMPACT:
            return PLUS
        rate = values[surface.switch]
        way = PLUS if rate >= 0 else MINUS
        if surface.kind == Kind.SLIDER and surface.releases is not None:
            up, down = (values[k] for k in surface.releases)
            slips = up >= -self.tolerance and rate > 0 or down <= self.tolerance and rate < 0
            return way if slips else STUCK
        return STUCK if surface.kind == Kind.SLIDING and abs(rate) <= self.tolerance else way

    def maps(self, fallen: Sequence[Guard]) -> bool:
        """Return whether an event at which some guards have fallen to 0 is an impact, or more than one."""
        return any(self.struck(guard) for guard in fallen)

    def passed(self, fallen: Sequence[Guard], modes: Modes, tau: float, state: Array) -> tuple[Array, Modes]:
        """Return state and modes after an event at which some guards have fallen to 0."""
        new, tossed = list(modes), set()
        for guard in fallen:
            surface, mode = self.surfaces[guard.surface], modes[guard.surface]
            if surface.kind == Kind.IMPACT and mode == STUCK:
                new[guard.surface] = PLUS
            elif surface.kind == Kind.IMPACT:
                state = self.system.reset(surface.switch, state[None], np.array([tau]), self.parameter)[0]
                new = self._turned(new, tau, state)
                if self._settles(surface, self._at(tuple(new), tau, state), tau, state):
                    new[guard.surface] = STUCK
            elif surface.kind in (Kind.KINK, Kind.JUMP, Kind.RELAY):
                new[guard.surface] = -mode
            else:
                new[guard.surface] = -guard.sign if mode == STUCK else STUCK
                tossed |= {guard.surface} if mode == STUCK else set()
        return self.consistent(tuple(self._relayed(new, tau, state)), tau, state, tossed)

    def _settles(self, surface: Surface, values: Array, tau: float, state: Array) -> bool:
        """Whether a mass on a wall comes to rest: it is pressed to the wall, and its bounce is negligible.

        A mass behind the wall, as by the error of a guess, is put on the wall if it would not come out again.
        """
        if surface.leaves is None or values[surface.leaves] >= 0:
            return False
        own, at = self.system.expressions.resting[surface.switch], np.array([tau])
        slope = self.system.switch_gradient(state[None], at, self.parameter)[0][0, surface.switch]
        height = (slope[own.position] * state[own.velocity]) ** 2 / (-2 * values[surface.leaves])
        return bool(values[surface.switch] + height <= LOW * self.tolerance)

    def _turned(self, modes: list[int], tau: float, state: Array) -> list[int]:
        """The modes after an impact, which may turn what slips and tear off what is held."""
        values, found = self._at(tuple(modes), tau, state), list(modes)
        for i, surface in enumerate(self.surfaces):
            rate = values[surface.switch]
            if surface.kind == Kind.SLIDING:
                slips = abs(rate) > self.tolerance
                found[i] = (PLUS if rate > 0 else MINUS) if slips else STUCK
            elif surface.kind == Kind.SLIDER and modes[i] != STUCK and modes[i] * rate < 0:
                found[i] = STUCK
        return self._relayed(found, tau, state)

    def consistent(
        self, modes: Modes, tau: float, state: Array, tossed: Collection[int] = ()
    ) -> tuple[Array, Modes]:
        """Return consistent modes, in which joints at rest stick or begin to slip, and the state projected.

        tossed: surfaces that have just begun to slip. Raises IntegrationError where no modes are consistent.
        """
        for _ in range(PIVOTS):
            values, changed = self._at(modes, tau, state), None
            for i, surface in enumerate(self.surfaces):
                if surface.kind != Kind.SLIDING or i in tossed or changed is not None:
                    continue
                if modes[i] == STUCK or abs(values[surface.switch]) <= self.tolerance:
                    wanted = _mode(surface, values, modes[i])
                    changed = (i, wanted) if wanted != modes[i] else None
            if changed is None:
                state = self._placed(modes, tau, state)
                return state, self._held_by_friction(modes, tau, state)
            modes = (*modes[: changed[0]], changed[1], *modes[changed[0] + 1 :])
        raise IntegrationError(f"no joints were found that stick after tau = {tau:.6g}", tau)

    def _held_by_friction(self, modes: Modes, tau: float, state: Array) -> Modes:
        """The modes with those sliders held whose strain is kept constant by friction that sticks.

        Their guards are combinations of friction's, and 0: on a moving belt a stuck mass strains one further.
        """
        stuck = self._having(modes, Kind.SLIDING, (STUCK,))
        carried = self._having(modes, Kind.SLIDER, (PLUS, MINUS))
        if not stuck or not carried:
            return modes
        gradient = self.system.switch_gradient(state[None], np.array([tau]), self.parameter)[0][0]
        along = gradient[[self.surfaces[i].switch for i in stuck]]
        rows = gradient[[self.surfaces[i].switch for i in carried]]
        left = np.abs(rows - rows @ np.linalg.pinv(along) @ along).max(axis=1)
        rates = np.abs(self._at(modes, tau, state)[[self.surfaces[i].switch for i in carried]])
        still = (left <= NONE * np.abs(rows).max(axis=1)) & (rates <= self.tolerance)
        held = {i for i, none in zip(carried, still, strict=True) if none}
        return tuple(STUCK if i in held else mode for i, mode in enumerate(modes))

    def _having(self, modes: Modes, kind: Kind, those: Collection[int]) -> list[int]:
        """The surfaces of a kind that are in some of the modes."""
        each = enumerate(zip(self.surfaces, modes, strict=True))
        return [i for i, (surface, mode) in each if surface.kind == kind and mode in those]

    def _placed(self, modes: Modes, tau: float, state: Array) -> Array:
        """The nearest state at which friction that sticks is at rest, and carried sliders at limits."""
        rows, state = [], self._laid(modes, tau, state)
        for surface, mode in zip(self.surfaces, modes, strict=True):
            if surface.kind == Kind.SLIDING and mode == STUCK:
                rows.append(surface.switch)
            elif surface.kind == Kind.SLIDER and mode != STUCK and surface.releases is not None:
                rows.append(surface.releases[0 if mode == PLUS else 1])
        if not rows:
            return state
        side, at = self.side(modes)[None], np.array([tau])
        value = self._at(modes, tau, state)[rows]
        gradient = self.system.switch_gradient(state[None], at, self.parameter, side)[0][0, rows]
        for row, k in enumerate(rows):  # a limit is reached by a change of its slider alone
            for held in self.system.expressions.sliders.values():
                if k in held.releases:
                    own = gradient[row, held.place]
                    gradient[row], gradient[row, held.place] = 0.0, own
        return np.asarray(state - np.linalg.pinv(gradient) @ value)

    def _laid(self, modes: Modes, tau: float, state: Array) -> Array:
        """The state with masses that rest on walls just on them, without speed."""
        state = state.copy()
        for surface, mode in zip(self.surfaces, modes, strict=True):
            if self._rests(surface, mode):
                own, at = self.system.expressions.resting[surface.switch], np.array([tau])
                slope = self.system.switch_gradient(state[None], at, self.parameter)[0][0, surface.switch]
                state[own.position] -= self._at(modes, tau, state)[surface.switch] / slope[own.position]
                state[own.velocity] = 0.0
        return state

    def _at(self, modes: Modes, tau: float, state: Array) -> Array:
        return self._switches(modes, np.array([tau]), state[None])[0]

    def _switches(self, modes: Modes, phase: Array, state: Array) -> Array:
        side = np.repeat(self.side(modes)[None], len(phase), axis=0)
        return self.system.switch(state, phase, self.parameter, side)

    def struck(self, guard: Guard) -> bool:
        """Whether a guard's fall to 0 is an impact."""
        surface = self.surfaces[guard.surface]
        return surface.kind == Kind.IMPACT and guard.switch == surface.switch

    def events(self, before: Modes, after: Modes, fallen: Sequence[Guard], tau: float) -> list[Event]:
        """Return the events at the surfaces: changes of mode, and impacts."""
        struck = {guard.surface for guard in fallen if self.struck(guard)}
        each = enumerate(zip(before, after, strict=True))
        return [Event(i, a, b, tau, after) for i, (a, b) in each if a != b or i in struck]


def modes_along(phase: Array, events: Sequence[Event], last: Modes) -> list[Modes]:
    """Return the modes at phases along a motion, from its events in order, and those at its end."""
    if not events:
        return [last] * len(phase)
    first = list(events[0].modes)
    for event in events:
        if event.modes == events[0].modes and event.phase == events[0].phase:
            first[event.surface] = event.before
    each = [tuple(first), *(event.modes for event in events)]
    at = [event.phase for event in events]
    passed = np.searchsorted(at, phase, side="right")
    struck = np.append(np.diff(phase) == 0, False)  # of an impact's two points the first is before it
    return [each[k] for k in np.where(struck, np.searchsorted(at, phase), passed)]


def _stays(surface: Surface, before: int) -> bool:
    """Whether a surface begins in the mode in which it was."""
    return surface.kind == Kind.RELAY and before != 0 or surface.kind == Kind.SLIDING and before == STUCK


def _mode(surface: Surface, values: Array, mode: int) -> int:
    """The mode of a joint at rest, by its releases; unchanged where it is consistent."""
    assert surface.releases is not None
    up, down = (values[k] for k in surface.releases)
    if up < 0 < down:
        return STUCK
    if mode == PLUS and up >= 0 or mode == MINUS and down <= 0:
        return mode
    return PLUS if up >= 0 else MINUS
