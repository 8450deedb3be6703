"""Changes of the pattern of contacts: a switch touches its level, an excursion ends, two events swap.

An excursion of depth d lasts about sqrt(d): its event nodes' phases have no derivative in the parameter where
it begins (Nordmark 1991). Without it the orbit is a smooth function of the parameter, with it of the
excursion's length; so a branch is followed without it up to the touch, where the extremum of the switch lies
on its level, and with it from a short excursion on. The other way round it is the same.

References
----------
Nordmark, J. Sound Vib. 145 (1991) 279. di Bernardo, Budd, Champneys & Kowalczyk, Piecewise-smooth Dynamical
Systems, 2008, chapter 7.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from periodic.events.sideconditions import Clearance, Length
from periodic.events.switchpolynomials import Dense, Extremum, exact, sliding
from periodic.events.rates import before as state_before
from periodic.events.rates import rate_before
from periodic.events.rewrites.turns import held, short_of, turns
from periodic.correction.change import Beyond, Change
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.redistribution import MIN_INTERVALS, density, redistribute, spread
from periodic.orbit.scheme import Array
from periodic.system import System, resets_of, slides_of

SHORT = (1e-2, 1e-3, 1e-4)
"""Lengths (rad) of the excursions at which patterns are exchanged, tried in turn."""

VANISHING = 0.5
"""An excursion of which a step would leave this part, by its tangent, may end within the step."""

SYMMETRIC = 1e-7
"""Switches this near to their levels, as a part of their largest values, touch at once."""

BRIEF = 2.0
"""Excursions at most so many times as long as one that ends end with it, or are about to."""

ALIKE = 1e-3
"""Excursions whose lengths differ by this part end at once."""


RIPPLES = 2.0
"""How far short of its level a switch is held that is the same all along the orbit, in its ripples."""

FLAT = 1e-5
"""A switch is the same all along an orbit where it changes by no more, as a part of its size."""


@dataclass(frozen=True)
class Birth:
    """A switch touches its level from `side` where the mesh has no event nodes: an excursion begins."""

    system: System
    extremum: Extremum
    side: int
    part: float
    shortest: float
    ripple: float = 0.0
    short_of: float = 0.0
    otherwise: Change | None = None

    touches = True
    strict = True
    final = True

    @property
    def condition(self) -> Clearance:
        """The touch; of all of the orbit at once just before it, where it still has a tangent."""
        level = max(self.ripple, self.short_of)
        return Clearance(self.extremum.switch, self.side, self.extremum.phase, level)

    @property
    def name(self) -> str:
        """Which switch touches."""
        return f"{self.system.switches[self.extremum.switch].name} is touched"

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield meshes with a short excursion where the switch touches, and where others do by symmetry.

        Where all of the orbit touches at once, as a circle does, it goes beyond at once, on the same mesh.
        """
        dense, k = Dense(system, orbit), self.extremum.switch
        at = dense.nearest(k, self.side, self.extremum.phase)
        if self.ripple:
            for depth in SHORT:
                held = Clearance(k, -self.side, at.phase, depth * dense.size(k))
                yield Beyond(orbit.mesh, orbit.phases, held, False)
            return
        others = [(e, side) for e, side in touching(system, orbit) if not _same(system, orbit, e, at)]
        for length in SHORT:
            for touches in ([(at, self.side), *others], [(at, self.side)])[: 2 if others else 1]:
                events, phases, segment = inserted(system, orbit, touches, length)
                mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
                yield Beyond(mesh, phases, Length(segment, length), False)


@dataclass(frozen=True)
class Meeting:
    """Two neighbouring event nodes come as near as `length`: an excursion ends, or they change places.

    Or an excursion with an impact in its midst ends.
    """

    system: System
    segment: int
    events: tuple[EventNode, EventNode]
    length: float
    part: float
    shortest: float

    touches = False
    strict = False
    otherwise = None

    @property
    def final(self) -> bool:
        """Whether events are never looked at nearer to each other."""
        return self.length <= SHORT[-1]

    @property
    def condition(self) -> Length:
        """How near they come."""
        return Length(self.segment, self.length)

    @property
    def name(self) -> str:
        """Which switches meet their levels at once."""
        names = [self.system.switches[event.switch].name for event in self.events]
        return f"the events {' and '.join(dict.fromkeys(names))} meet"

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield the mesh without the excursion, or with the two events the other way round."""
        k, (first, second) = len(orbit.phases), self.events
        i, j = self.segment, (self.segment + 1) % len(orbit.phases)
        begin, end = orbit.phases[i], orbit.phases[j] + (orbit.mesh.period if j < i else 0.0)
        around = _around(self.system, orbit, self.segment)
        if first.switch == second.switch:
            condition = Clearance(first.switch, second.direction, (begin + end) / 2)
            for ended in dict.fromkeys((self._as_short(orbit), (i, j))):
                yield self._without(orbit, ended, condition)
            return
        if around is not None:
            last = orbit.mesh.events[around[1]]
            yield self._without(orbit, around, Clearance(last.switch, last.direction, (begin + end) / 2))
            return
        others = [(orbit.mesh.events[m], orbit.phases[m]) for m in range(k) if m not in (i, j)]
        early, impacts = (begin + end - self.length) / 2, resets_of(self.system)
        if first.switch in impacts or second.switch in impacts:  # whose state before it is that of its phase
            early = begin - self.length if first.switch in impacts else end
        pair = [(second, early), (first, early + self.length)]
        events, phases = ordered([*others, *pair], orbit)
        mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
        yield Beyond(mesh, phases, Length(index_of(events, phases, pair[0], orbit), self.length), False)

    def _without(self, orbit: Orbit, ended: tuple[int, ...], condition: Clearance) -> Beyond:
        """The mesh without some event nodes."""
        kept = [m for m in range(len(orbit.phases)) if m not in ended]
        events, phases = ordered([(orbit.mesh.events[m], orbit.phases[m]) for m in kept], orbit)
        gone = MIN_INTERVALS * (len(orbit.mesh.events) - len(events)) // 2  # of excursions that are no more
        wanted = np.where(self._brief(orbit), 0.0, density(orbit))  # derivatives within them are rounding
        wanted *= (orbit.mesh.ntst - gone) / float(wanted @ orbit.grid.width)
        return Beyond(spread(orbit, wanted, events, phases, self.shortest), phases, condition, True)

    def _brief(self, orbit: Orbit) -> NDArray[np.bool_]:
        """Which intervals are those of excursions about as short as this one."""
        brief = orbit.mesh.segment_lengths(orbit.phases) < BRIEF * self.length
        return np.repeat(brief, [len(breaks) - 1 for breaks in orbit.mesh.breaks])

    def _as_short(self, orbit: Orbit) -> tuple[int, ...]:
        """Return the event nodes of all excursions as short as this one: by symmetry several end at once."""
        events, length = orbit.mesh.events, orbit.mesh.segment_lengths(orbit.phases)
        k, ended = len(events), [self.segment, (self.segment + 1) % len(events)]
        for i in range(k):
            pair = (i, (i + 1) % k)
            alike = abs(length[i] / self.length - 1) < ALIKE and events[i].switch == events[pair[1]].switch
            if alike and not set(pair) & set(ended):
                ended += pair
        return tuple(ended)


def touching(system: System, orbit: Orbit) -> list[tuple[Extremum, int]]:
    """Return where switches touch their levels, the mesh having no event nodes there, and from which side."""
    dense, found = Dense(system, orbit), list[tuple[Extremum, int]]()
    for k in exact(system):
        sides = dense.expected(k, dense.side(k))
        near = SYMMETRIC * float(np.abs(dense.knots[:, :, k]).max())
        for side in np.unique(sides):
            low = [e for e in dense.minima(k, int(side)) if sides[e.interval] == side and e.theta < 1.0]
            for e in low:
                if abs(e.value) < near and not any(_same(system, orbit, e, other) for other, _ in found):
                    found.append((e, int(side)))
    return found


def _same(system: System, orbit: Orbit, one: Extremum, other: Extremum) -> bool:
    """Whether two touches are one: a switch may stay there for a while."""
    begin, end = held(system, orbit, one.switch, one.phase)
    apart = np.mod(other.phase - begin + SHORT[0], orbit.mesh.period)
    return one.switch == other.switch and bool(apart <= end - begin + 2 * SHORT[0])


def ordered(both: list[tuple[EventNode, float]], orbit: Orbit) -> tuple[tuple[EventNode, ...], Array]:
    """Return event nodes and their phases in order, the first phase in [0, period)."""
    period = orbit.mesh.period
    wrapped = sorted(
        ((float(np.mod(phase, period)), event) for event, phase in both), key=lambda pair: pair[0]
    )
    return tuple(event for _, event in wrapped), np.array([phase for phase, _ in wrapped])


def index_of(
    events: tuple[EventNode, ...], phases: Array, pair: tuple[EventNode, float], orbit: Orbit
) -> int:
    """Return the index of an event node."""
    place = np.mod(pair[1], orbit.mesh.period)
    return next(i for i, event in enumerate(events) if event == pair[0] and phases[i] == place)


def inserted(
    system: System, orbit: Orbit, touches: list[tuple[Extremum, int]], length: float
) -> tuple[tuple[EventNode, ...], Array, int]:
    """Return event nodes and phases with excursions about points, and the segment that is the first one.

    Where friction holds a switch at its level they lie before and after that, the latter as the third root of
    their depth: from there it sets out without acceleration.
    """
    every = list(zip(orbit.mesh.events, map(float, orbit.phases), strict=True))
    for at, side in touches:
        begin, end = held(system, orbit, at.switch, at.phase)
        before, after = (length / 2, length / 2) if begin == end else (length, length ** (2 / 3))
        every.append((EventNode(at.switch, -side), begin - before))
        every.append((EventNode(at.switch, side), end + after))
    events, phases = ordered(every, orbit)
    first = every[len(orbit.phases)]
    return events, phases, index_of(events, phases, first, orbit)


def pattern(system: System, orbit: Orbit) -> tuple[EventNode, ...] | None:
    """Return the event nodes of switches at whose level the equations change, sorted.

    None where the orbit passes such a level elsewhere too, or not there.
    """
    dense, own = Dense(system, orbit), [*exact(system), *resets_of(system)]
    if any(dense.unseen(k, dense.side(k)) for k in own):
        return None
    for jump, pair in slides_of(system).items():
        own += [jump, *pair]
    tied = [event for event in orbit.mesh.events if event.switch in own]
    return tuple(sorted(tied, key=lambda event: (event.switch, event.direction)))


def change(system: System, before: Orbit, after: Orbit, shortest: float) -> Change | None:
    """Return the first change of pattern between two orbits on one mesh, where there is one.

    `after` may be a guess, its event nodes out of order. A touch is told before events that meet: an orbit
    beyond it is none of the system, on this mesh.
    """
    return _birth(system, before, after, shortest) or _meeting(system, before, after, shortest)


def or_meeting(system: System, birth: Birth, before: Orbit, after: Orbit, short: float) -> Birth:
    """Return a touch, and if it may be that of an excursion which ends, that one's end as another way.

    short: length (rad) of the excursions of which that is believed. In a guess depth goes before length.
    """
    meeting = _meeting(system, before, after, birth.shortest)
    if meeting is None or not _within(after, meeting, birth):
        return birth
    length = before.mesh.segment_lengths(before.phases)[meeting.segment]
    return replace(birth, otherwise=meeting) if length < short else birth


def _within(orbit: Orbit, meeting: Meeting, birth: Birth) -> bool:
    """Whether a touch may be that of an excursion which ends."""
    begin, switch = orbit.phases[meeting.segment], birth.extremum.switch
    length = orbit.mesh.segment_lengths(orbit.phases)[meeting.segment]
    inside = bool(np.mod(birth.extremum.phase - begin, orbit.mesh.period) <= length)
    return inside and all(event.switch == switch for event in meeting.events)


def _meeting(system: System, before: Orbit, after: Orbit, shortest: float) -> Meeting | None:
    impacts = resets_of(system)
    if not before.mesh.events:
        return None
    own = [*exact(system), *impacts, *(k for pair in slides_of(system).items() for k in (pair[0], *pair[1]))]
    now, then = before.mesh.segment_lengths(before.phases), after.mesh.segment_lengths(after.phases)
    found, about = [], {i for turn in turns(system, before) for i in (turn.begin, turn.inside[-1])}
    for i, first in enumerate(before.mesh.events):
        second = before.mesh.events[(i + 1) % len(now)]
        same = first.switch == second.switch
        if first.switch not in own or second.switch not in own or _slide(system, first, second):
            continue
        struck = _reversed(system, before, i)
        if i in about or struck and (_around(system, before, i) is None or now[i] <= SHORT[-1]):
            continue
        half = VANISHING * float(now[i])
        nearest = next((length for length in SHORT if length < half), half)
        if then[i] > (max(half, nearest) if same else nearest):
            continue
        shorter = now[i] - then[i]
        part = (now[i] ** 2 - nearest**2) / (2 * now[i] * shorter) if same else (now[i] - nearest) / shorter
        found.append(Meeting(system, i, (first, second), nearest, min(float(part), 1.0), shortest))
    return min(found, key=lambda meeting: meeting.part, default=None)


def _reversed(system: System, orbit: Orbit, segment: int) -> bool:
    """Whether an impact at an end of a segment reverses the switch at the other end: they do not swap."""
    ends = segment, (segment + 1) % len(orbit.phases)
    for node, other in (ends, ends[::-1]):
        if orbit.mesh.events[node].switch in resets_of(system):
            switch, start = orbit.mesh.events[other].switch, orbit.mesh.starts[node]
            _, x, phase = state_before(orbit, node)
            states = np.concatenate([x, orbit.nodes[start : start + 1]])
            rates = np.array([rate_before(orbit, node), orbit.node_rates[start]])
            by_state, by_phase, _ = system.switch_gradient(states, phase.repeat(2), orbit.parameter)
            slopes = by_phase[:, switch] + np.einsum("in,in->i", by_state[:, switch], rates)
            if slopes[0] * slopes[1] <= 0:
                return True
    return False


def _around(system: System, orbit: Orbit, segment: int) -> tuple[int, int] | None:
    """The ends of an excursion in the midst of which there is an impact, at an end of a segment, if it is so.

    The impact reverses the switch; the excursion ends in a corner, and all three events meet.
    """
    events, k = orbit.mesh.events, len(orbit.phases)
    if not _reversed(system, orbit, segment):
        return None
    for m in (segment, (segment + 1) % k):
        before, after = (m - 1) % k, (m + 1) % k
        turns = events[before].direction != events[after].direction
        same = events[before].switch == events[after].switch != events[m].switch
        if events[m].switch in resets_of(system) and same and turns:
            return before, after
    return None


def _slide(system: System, first: EventNode, second: EventNode) -> bool:
    """Whether two event nodes are those of one jump: see `periodic.events.rewrites.slide`."""
    jump = sliding(system, first.switch)
    return jump is not None and sliding(system, second.switch) == jump


def _birth(system: System, before: Orbit, after: Orbit, shortest: float) -> Birth | None:
    if not bool((after.mesh.segment_lengths(after.phases) > 0).all()):
        return None
    dense, base, found = Dense(system, after), Dense(system, before), []
    for k in exact(system):
        otherwise = base.side(k)
        sides = dense.expected(k, otherwise)
        for extremum in dense.unseen(k, otherwise):
            side = int(sides[extremum.interval])
            nearest = base.nearest(k, side, extremum.phase).value
            gone = abs(nearest) / (abs(nearest) + abs(extremum.value))
            ripple = RIPPLES * float(np.ptp(base.knots[:, :, k])) if base.flat(k, FLAT) else 0.0
            left = short_of(system, after, k, extremum.phase)
            found.append(Birth(system, extremum, side, float(gone), shortest, ripple, left))
    return min(found, key=lambda birth: birth.part, default=None)
