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
from dataclasses import dataclass

import numpy as np

from periodic.collocation.dense import Dense, Extremum, exact, sliding
from periodic.correction.change import Beyond, Change
from periodic.orbit.gradients import Points, Slopes, gathered
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.redistribution import redistribute
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, resets_of, slides_of

SHORT = (1e-2, 1e-3, 1e-4)
"""Lengths (rad) of the excursions at which patterns are exchanged, tried in turn."""

VANISHING = 0.5
"""An excursion of which a step would leave this part, by its tangent, may end within the step."""

SYMMETRIC = 1e-7
"""Switches this near to their levels, as a part of their largest values, touch at once."""

ALIKE = 1e-3
"""Excursions whose lengths differ by this part end at once."""


RIPPLES = 2.0
"""How far short of its level a switch is held that is the same all along the orbit, in its ripples."""

FLAT = 1e-5
"""A switch is the same all along an orbit where it changes by no more, as a part of its size."""


@dataclass(frozen=True)
class Clearance:
    """Side condition: the extremum of a switch nearest a phase lies at `level`, min of side * s."""

    switch: int
    side: int
    phase: float
    level: float = 0.0

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return the clearance side * s at the extremum, and its gradient, that at a fixed place."""
        at = Dense(system, orbit).nearest(self.switch, self.side, self.phase)
        row = clearance(system, orbit, at, self.side, free)
        return Row(row.value - self.level, row.nodes, row.outer, row.stages)


def clearance(system: System, orbit: Orbit, at: Extremum, side: int, free: tuple[int, ...]) -> Row:
    """Return side * s at a point of an orbit as a row."""
    phase = np.array([at.phase])
    basis = orbit.mesh.scheme.basis(np.array([at.theta]))
    state = basis @ orbit.knots[at.interval]
    points = Points(
        np.array([at.interval]),
        np.array([at.theta]),
        phase,
        basis @ orbit.knot_rates[at.interval],
        state,
        np.zeros((1, orbit.algebraic.shape[2])),
    )
    d_state, d_phase, d_parameter = (
        side * g[:, at.switch] for g in system.switch_gradient(state, phase, orbit.parameter)
    )
    slopes = Slopes(np.zeros_like(state), d_state, np.zeros((1, 0)), d_phase, d_parameter[0, list(free)])
    row = gathered(system, orbit, points, slopes, free)
    value = side * float(system.switch(state, phase, orbit.parameter)[0, at.switch])
    return Row(value, row.nodes, row.outer, row.stages)


@dataclass(frozen=True)
class Length:
    """Side condition: the segment that begins at an event node has a given length (rad)."""

    segment: int
    length: float

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return its length less the given one."""
        k = len(orbit.phases)
        outer = np.zeros(k + len(free))
        outer[self.segment] -= 1.0
        outer[(self.segment + 1) % k] += 1.0
        value = float(orbit.mesh.segment_lengths(orbit.phases)[self.segment]) - self.length
        return Row(value, np.zeros_like(orbit.nodes), outer)


@dataclass(frozen=True)
class Birth:
    """A switch touches its level from `side` where the mesh has no event nodes: an excursion begins."""

    system: System
    extremum: Extremum
    side: int
    part: float
    shortest: float
    ripple: float = 0.0

    touches = True
    strict = True
    final = True

    @property
    def condition(self) -> Clearance:
        """The touch; of all of the orbit at once just before it, where it still has a tangent."""
        return Clearance(self.extremum.switch, self.side, self.extremum.phase, self.ripple)

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
        others = [(e, side) for e, side in touching(system, orbit) if not _same(e, at, orbit.mesh.period)]
        for length in SHORT:
            for touches in ([(at, self.side), *others], [(at, self.side)])[: 2 if others else 1]:
                events, phases, segment = inserted(orbit, touches, length)
                mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
                yield Beyond(mesh, phases, Length(segment, length), False)


@dataclass(frozen=True)
class Meeting:
    """Two neighbouring event nodes come as near as `length`: an excursion ends, or they change places."""

    system: System
    segment: int
    events: tuple[EventNode, EventNode]
    length: float
    part: float
    shortest: float

    touches = False
    strict = False

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
        if first.switch == second.switch:
            condition = Clearance(first.switch, second.direction, (begin + end) / 2)
            for ended in dict.fromkeys((self._as_short(orbit), (i, j))):
                kept = [m for m in range(k) if m not in ended]
                events, phases = ordered([(orbit.mesh.events[m], orbit.phases[m]) for m in kept], orbit)
                mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
                yield Beyond(mesh, phases, condition, True)
            return
        others = [(orbit.mesh.events[m], orbit.phases[m]) for m in range(k) if m not in (i, j)]
        middle = (begin + end) / 2
        pair = [(second, middle - self.length / 2), (first, middle + self.length / 2)]
        events, phases = ordered([*others, *pair], orbit)
        mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
        yield Beyond(mesh, phases, Length(index_of(events, phases, pair[0], orbit), self.length), False)

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
    dense, found = Dense(system, orbit), []
    for k in exact(system):
        sides = dense.expected(k, dense.side(k))
        near = SYMMETRIC * float(np.abs(dense.knots[:, :, k]).max())
        for side in np.unique(sides):
            low = [e for e in dense.minima(k, int(side)) if sides[e.interval] == side and e.theta < 1.0]
            found += [(e, int(side)) for e in low if abs(e.value) < near]
    return found


def _same(one: Extremum, other: Extremum, period: float) -> bool:
    apart = np.mod(one.phase - other.phase + period / 2, period) - period / 2
    return one.switch == other.switch and bool(abs(apart) <= SHORT[0])


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
    orbit: Orbit, touches: list[tuple[Extremum, int]], length: float
) -> tuple[tuple[EventNode, ...], Array, int]:
    """Return event nodes and phases with excursions about points, and the segment that is the first one."""
    every = list(zip(orbit.mesh.events, map(float, orbit.phases), strict=True))
    for at, side in touches:
        every.append((EventNode(at.switch, -side), at.phase - length / 2))
        every.append((EventNode(at.switch, side), at.phase + length / 2))
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

    `after` may be a guess, its event nodes out of order.
    """
    return _meeting(system, before, after, shortest) or _birth(system, before, after, shortest)


def _meeting(system: System, before: Orbit, after: Orbit, shortest: float) -> Meeting | None:
    own = [*exact(system), *(k for pair in slides_of(system).items() for k in (pair[0], *pair[1]))]
    if not before.mesh.events:
        return None
    now, then = before.mesh.segment_lengths(before.phases), after.mesh.segment_lengths(after.phases)
    found = []
    for i, first in enumerate(before.mesh.events):
        second = before.mesh.events[(i + 1) % len(now)]
        same = first.switch == second.switch
        if first.switch not in own or second.switch not in own or _slide(system, first, second):
            continue
        half = VANISHING * float(now[i])
        nearest = next((length for length in SHORT if length < half), half)
        if then[i] > (max(half, nearest) if same else nearest):
            continue
        part = (now[i] ** 2 - nearest**2) / (2 * now[i] * (now[i] - then[i])) if same else 1.0
        if not same:
            part = (now[i] - nearest) / (now[i] - then[i])
        found.append(Meeting(system, i, (first, second), nearest, min(float(part), 1.0), shortest))
    return min(found, key=lambda meeting: meeting.part, default=None)


def _slide(system: System, first: EventNode, second: EventNode) -> bool:
    """Whether two event nodes are those of one jump: see `periodic.collocation.jumping.slide`."""
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
            found.append(Birth(system, extremum, side, float(gone), shortest, ripple))
    return min(found, key=lambda birth: birth.part, default=None)
