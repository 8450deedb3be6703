"""Changes of the pattern of sticking and slipping: sliding bifurcations of dry friction (Filippov).

With s the sliding speed, its rate is up by the equations of the side s > 0 and down by those of s < 0;
motions stick where up < 0 < down. On the whole orbit, and however short what begins or ends,

    s touches 0 from one side while it slips: beyond, it stops for a moment       (grazing-sliding)
    up or down touches 0 while it sticks: beyond, it slips for a moment           (adding-sliding)
    a passage through s = 0 comes where up or down is 0: beyond, it stops         (crossing-sliding)
    a stop begins where up or down is 0: beyond, it slips past s = 0 and returns  (switching-sliding)

and the reverse. At the first one the multipliers jump; at the others they are continuous.

References
----------
di Bernardo, Budd, Champneys & Kowalczyk, Piecewise-smooth Dynamical Systems, 2008, chapter 8.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from periodic.events.sideconditions import Clearance, Length, Limit
from periodic.events.switchpolynomials import Dense, Extremum, sliding
from periodic.events.modes import group, sticks
from periodic.events.rewrites.touch import index_of, ordered
from periodic.correction.change import Beyond
from periodic.correction.condition import SideCondition
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.redistribution import redistribute
from periodic.system import System, slides_of

NOISE = 1e-10
"""How near to 0 a rate of the sliding speed may be on either side of it, as a part of its largest value."""

SYMMETRIC = 1e-7
"""What is as near to its change, as a part of its largest value, changes at once."""

ALIKE = 1e-3
"""Stretches whose lengths differ by this part end at once."""

SHORT_OF = 1e-9
"""How far from the end of a stretch the orbit without it is held, in the same part: rounding decides."""

SHORT = (1e-2, 1e-3, 1e-4)
"""Lengths (rad) of stretches of sticking at which patterns are exchanged, tried in turn."""

LINEAR = (*SHORT, 1e-5, 1e-6)
"""The same where the length grows in proportion to the parameter."""

BRIEF = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
"""The same of slips between two stretches of sticking, whose size falls as the cube of their length."""

LAST = 1e-2
"""Length (rad) of the last slips of a motion that will not slip any more."""

VANISHING = 0.5
"""A stretch of which a step would leave this part, by its tangent, may end within the step."""


@dataclass(frozen=True)
class Place:
    """Where the pattern of an orbit may change: `value` is positive as long as it does not.

    `at` is an extremum of a switch, or an event node. `new` are the event nodes beyond, with their places in
    lengths from there.
    """

    jump: int
    at: Extremum | int
    condition: Clearance | Limit
    value: float
    new: tuple[tuple[EventNode, float], ...]

    @property
    def touches(self) -> bool:
        """Whether the sliding speed touches 0."""
        return isinstance(self.at, Extremum) and self.at.switch == self.jump

    @property
    def kind(self) -> tuple[bool, bool]:
        """Whether it is an extremum, and whether it is one of the sliding speed."""
        return isinstance(self.at, Extremum), self.touches

    @property
    def lengths(self) -> tuple[float, ...]:
        """Lengths of the new stretch that are tried."""
        if not isinstance(self.at, Extremum):
            return LINEAR
        return SHORT if self.touches else BRIEF

    def inserted(self, orbit: Orbit, length: float) -> list[tuple[EventNode, float]]:
        """The first event node of the new stretch, be it there or new, and those that are new."""
        if isinstance(self.at, Extremum):
            added = [(event, self.at.phase + part * length) for event, part in self.new]
            return [added[0], *added]
        phase = float(orbit.phases[self.at])
        own = (orbit.mesh.events[self.at], phase)
        return [own, *((event, phase + part * length) for event, part in self.new)]


@dataclass(frozen=True)
class Beginning:
    """A stretch of sticking or slipping begins: beyond, orbits on the same mesh are none of the system."""

    system: System
    place: Place
    part: float
    shortest: float

    final = True
    strict = True
    otherwise = None

    @property
    def condition(self) -> SideCondition:
        """What is 0 there."""
        return self.place.condition

    @property
    def touches(self) -> bool:
        """Whether the sliding speed touches 0."""
        return self.place.touches

    @property
    def name(self) -> str:
        """What begins."""
        name, place = self.system.switches[self.place.jump].name, self.place
        if isinstance(place.at, Extremum):
            return f"{name} is touched" if place.touches else f"a slip begins while {name} holds"
        return f"a stop at {name} begins or is broken"

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield meshes with a short stretch there, and where others begin by symmetry."""
        near = [p for p in _places(system, orbit) if abs(p.value) <= SYMMETRIC and p.kind == self.place.kind]
        own = min(near, key=lambda place: self._apart(place, orbit), default=None)
        if own is None:
            return
        others = [place for place in near if place is not own]
        for length in self.place.lengths:
            for places in ([own, *others], [own])[: 2 if others else 1]:
                old = zip(orbit.mesh.events, map(float, orbit.phases), strict=True)
                added = [place.inserted(orbit, length) for place in places]
                events, phases = ordered([*old, *(pair for _, *pairs in added for pair in pairs)], orbit)
                mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
                segment = index_of(events, phases, added[0][0], orbit)
                yield Beyond(mesh, phases, Length(segment, length), False)

    def _apart(self, place: Place, orbit: Orbit) -> float:
        """How far another place is from this one, infinite where it is of another kind."""
        one, other = self.place.at, place.at
        if isinstance(one, Extremum) and isinstance(other, Extremum) and one.switch == other.switch:
            return abs(_wrapped(one.phase - other.phase, orbit.mesh.period))
        return 0.0 if one == other else np.inf


@dataclass(frozen=True)
class Ending:
    """A stretch of sticking or slipping becomes as short as `length`: beyond it is gone.

    name: what ends. final: whether stretches are never looked at when shorter. strict: whether the motion
    does not slip at all beyond, where it is not followed.
    """

    segment: int
    length: float
    name: str
    final: bool
    strict: bool
    part: float
    shortest: float

    touches = False
    otherwise = None

    @property
    def condition(self) -> SideCondition:
        """How short it becomes."""
        return Length(self.segment, self.length)

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield the mesh without the stretch, and without those as short, held where it ends."""
        own = _end(system, orbit, self.segment)
        if own is None:
            return
        ended, length = [own.removed], orbit.mesh.segment_lengths(orbit.phases)
        for i in range(len(orbit.phases)):
            other = _end(system, orbit, i)
            alike = abs(length[i] / self.length - 1) < ALIKE
            if other is not None and alike and not {*other.removed} & {j for each in ended for j in each}:
                ended.append(other.removed)
        for gone in dict.fromkeys((tuple(j for each in ended for j in each), own.removed)):
            kept = [j for j in range(len(orbit.phases)) if j not in gone]
            pairs = [(orbit.mesh.events[j], float(orbit.phases[j])) for j in kept]
            events, phases = ordered(pairs, orbit)
            mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
            condition, up_down = own.condition, slides_of(system)[own.jump]
            left = 0.0 if own.touches else SHORT_OF * _most(Dense(system, orbit), [*up_down])
            if isinstance(condition, Limit):
                pair = orbit.mesh.events[condition.node], float(orbit.phases[condition.node])
                condition = replace(condition, node=index_of(events, phases, pair, orbit))
            yield Beyond(mesh, phases, replace(condition, level=left), own.touches)


@dataclass(frozen=True)
class End:
    """How a stretch vanishes: the event nodes that go, and what is 0 there on the mesh without them.

    rooted: whether its length is the root of how far that is.
    """

    jump: int
    removed: tuple[int, ...]
    condition: Clearance | Limit
    touches: bool
    rooted: bool
    lengths: tuple[float, ...] = SHORT


def _end(system: System, orbit: Orbit, segment: int) -> End | None:
    """How the stretch between an event node and the next one vanishes; None where it cannot."""
    i, j = segment, (segment + 1) % len(orbit.phases)
    first, second = orbit.mesh.events[i], orbit.mesh.events[j]
    jump = sliding(system, first.switch)
    if jump is None or sliding(system, second.switch) != jump or i == j:
        return None
    up, down = slides_of(system)[jump]
    middle = float(orbit.phases[i]) + float(orbit.mesh.segment_lengths(orbit.phases)[i]) / 2
    onward = up if first.direction > 0 else down
    stuck, then = (sticks(system, orbit.mesh, jump, n) is not None for n in (i, j))
    if stuck and second.direction == first.direction:
        return End(jump, (j,), Limit(i, onward, first.direction), False, False)
    if stuck:
        return End(jump, (i, j), Clearance(jump, second.direction, middle), True, True)
    if first.switch != jump and then:
        return End(jump, (i, j), Clearance(first.switch, -first.direction, middle), False, True, BRIEF)
    if first.switch == jump and second.switch == jump and then:
        return End(jump, (j,), Limit(i, onward, -first.direction), False, False)
    return None


def _places(system: System, orbit: Orbit) -> list[Place]:
    """All places at which the pattern may change, with values in parts of the largest."""
    dense, found = Dense(system, orbit), list[Place]()
    for jump, pair in slides_of(system).items():
        for k in (jump, *pair):
            side = dense.side(k)
            sides, most = dense.expected(k, side), _most(dense, [k])
            for way in (int(way) for way in np.unique(sides) if way):
                low = dense.minima(k, way)
                found += [_turn(system, jump, e, way, way * dense.value(e), most) for e in low]
        found += _limits(system, orbit, jump)
    return found


def _turn(system: System, jump: int, at: Extremum, side: int, value: float, most: float) -> Place:
    """The place of an extremum on a given side of 0, its value and the largest one along the orbit."""
    up, down = slides_of(system)[jump]
    if at.switch == jump:
        release = EventNode(up if side > 0 else down, side)
        condition = Clearance(at.switch, side, at.phase)
        return Place(jump, at, condition, value / most, ((EventNode(jump, -side), -1.0), (release, 0.0)))
    new = (EventNode(at.switch, -side), -1 / 3), (EventNode(jump, side), 2 / 3)
    condition = Clearance(at.switch, side, at.phase, SHORT_OF * most)
    return Place(jump, at, condition, value / most, new)


def _limits(system: System, orbit: Orbit, jump: int) -> list[Place]:
    """The places at event nodes of a jump: passages that may begin to stick, and stops that may break."""
    up, down = slides_of(system)[jump]
    found, own = list[Place](), group(system, orbit.mesh, jump)
    nodes = [j for j in own if orbit.mesh.events[j].switch == jump]
    if not nodes:
        return []
    values = system.switch(orbit.nodes[orbit.mesh.starts[nodes]], orbit.phases[nodes], orbit.parameter)
    most = _most(Dense(system, orbit), [up, down])
    for j, value in zip(nodes, values, strict=True):
        d = orbit.mesh.events[j].direction
        onward, stuck = up if d > 0 else down, sticks(system, orbit.mesh, jump, j) is not None
        side, new = (-d, EventNode(jump, -d)) if stuck else (d, EventNode(onward, d))
        condition = Limit(j, onward, side, SHORT_OF * most)
        found.append(Place(jump, j, condition, side * float(value[onward]) / most, ((new, 1.0),)))
    return found


def _most(dense: Dense, switches: list[int]) -> float:
    """The largest value of switches along an orbit."""
    return float(np.abs(dense.knots[:, :, switches]).max()) or 1.0


def wrong(system: System, orbit: Orbit, otherwise: Orbit | None = None) -> list[Place]:
    """Return where an orbit slips that should stick, or the reverse, on the whole of it.

    Without event nodes of a jump it is on the side of `otherwise`, by default of its own farthest point.
    """
    dense, found = Dense(system, orbit), list[Place]()
    base = Dense(system, otherwise or orbit)
    for jump, pair in slides_of(system).items():
        limits = [place for place in _limits(system, orbit, jump) if place.value < -NOISE]
        found += limits
        for k in (jump, *pair) if not limits else ():  # past a limit the motion turns back at once
            side = base.side(k)
            sides, most = dense.expected(k, side), _most(dense, [k])
            for e in dense.unseen(k, side):
                way = int(sides[e.interval])
                found.append(_turn(system, jump, e, way, way * dense.value(e), most))
    return found


def change(system: System, before: Orbit, after: Orbit, shortest: float) -> Beginning | Ending | None:
    """Return the first change between two orbits on one mesh, where there is one; `after` may be a guess."""
    if not slides_of(system):
        return None
    ends = _ending(system, before, after, shortest)
    if ends or not bool((after.mesh.segment_lengths(after.phases) > 0).all()):
        return min(ends, key=lambda end: end.part, default=None)
    begun = [
        Beginning(system, place, _share(system, before, place), shortest)
        for place in wrong(system, after, before)
        if not _at_rest(system, before, place.jump)
    ]
    return min(begun, key=lambda each: each.part, default=None)


def _at_rest(system: System, orbit: Orbit, jump: int) -> bool:
    """Whether nothing slides all along an orbit, as at a rest that friction holds: it has no neighbours."""
    return not Dense(system, orbit).knots[:, :, jump].any()


def _share(system: System, before: Orbit, place: Place) -> float:
    """At which part of the way to an orbit that is past a change the change lies, about."""
    past = abs(place.value)
    if isinstance(place.at, Extremum):
        dense, side = Dense(system, before), place.condition.side
        if not dense.minima(place.at.switch, side):
            return 0.0
        nearest = dense.nearest(place.at.switch, side, place.at.phase)
        clear = abs(nearest.value) / _most(dense, [place.at.switch])
    else:
        every = _limits(system, before, place.jump)
        clear = next(abs(other.value) for other in every if other.at == place.at)
    return clear / (clear + past)


def _ending(system: System, before: Orbit, after: Orbit, shortest: float) -> list[Ending]:
    """The stretches that become short between two orbits."""
    if not before.mesh.events:
        return []
    now, then = before.mesh.segment_lengths(before.phases), after.mesh.segment_lengths(after.phases)
    found = []
    for i in range(len(now)):
        end = _end(system, before, i)
        if end is None:
            continue
        half = VANISHING * float(now[i])
        whole = end.lengths is BRIEF and _longest_slip(system, before, end.jump) <= 2 * now[i]
        nearest = next((length for length in end.lengths if length < half), half)
        nearest = LAST if whole else nearest
        if then[i] > (max(half, nearest) if end.rooted and not whole else nearest):
            continue
        part = (now[i] ** 2 - nearest**2) / (2 * now[i] * (now[i] - then[i]))
        if not end.rooted:
            part = (now[i] - nearest) / (now[i] - then[i])
        final, name = whole or nearest <= end.lengths[-1], system.switches[end.jump].name
        told = (
            f"{name} holds all along, at a place that is not determined"
            if whole
            else f"a stop at {name} ends"
        )
        found.append(Ending(i, nearest, told, final, whole, min(float(part), 1.0), shortest))
    return found


def _longest_slip(system: System, orbit: Orbit, jump: int) -> float:
    """Length of the longest stretch without sticking."""
    own = group(system, orbit.mesh, jump)
    pairs = zip(own, [*own[1:], *own[:1]], strict=True)
    slips = [(i, j) for i, j in pairs if sticks(system, orbit.mesh, jump, i) is None]
    return max((float((orbit.phases[j] - orbit.phases[i]) % orbit.mesh.period) for i, j in slips), default=0)


def _wrapped(phase: float, period: float) -> float:
    return float(np.mod(phase + period / 2, period) - period / 2)
