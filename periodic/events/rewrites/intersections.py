"""Event nodes about the intersection of surfaces: the orbit goes round it on the other side.

Where two guards a and b vanish at once, so does every combination c of them, as the difference of two speeds.
In the plane of a and b the surfaces are three lines through the origin, six rays, and an orbit near it
crosses those between the sector that it comes from and the one that it leaves to. On one side of the origin
these are m rays, on the other the 6 - m others, in the opposite order:

    a b c      and  c b a
    a b        and  c b a c
    a          and  c b a c b

so that c, which is not crossed at all on one side, is crossed twice on the other. An orbit that is held at a
line from there on leaves along a ray, not into a sector; the ray is reached from either side. If it is held
at the line on the near side of the origin already, it passes the origin along the line, on which both other
guards are the same, and may be let go there:

    a b c0     and  c b a c0        c0: c is held from there on
    a b0       and  c b0 (a c)      (a c): both are crossed as one
    a b        and  c0 (a b) -c     -c: it is let go there

Sliders along a line that are strained where it is crossed first are so on either side. Where it is crossed
twice they slip on once their strain is back where it was, soon after; on the other side they slip all along:

    a b        and  c b a c s       s: sliders along c, strained where it is crossed first, slip on

The second crossing is no event node where there are sliders alone along c.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from periodic.events.modes import column, of_held, release, sides, surface_of
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import SWAP
from periodic.events.sideconditions import Length
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import LONGEST
from periodic.events.twinguards import holding, twins
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import HELD, STUCK, Kind, System

LINES = 3
"""Surfaces that meet: two whose guards vanish, and one whose guard is a combination of these."""

RAYS = 2 * LINES


def intersections(system: System, orbit: Orbit, segment: int) -> list[Site]:
    """Return the sites where the orbit passes on the other side of an intersection about a segment.

    Those come first of which more event nodes are near each other.
    """
    lengths, found = orbit.mesh.segment_lengths(orbit.phases), list[tuple[tuple[bool, int, float], Site]]()
    for nodes in _windows(len(orbit.phases), segment):
        longest = float(lengths[list(nodes[:-1])].max())
        order = longest > LONGEST, -len(nodes) if longest <= LONGEST else 0, longest
        found += [(order, site) for site in _sites(system, orbit, segment, nodes)]
    return [site for _, site in sorted(found, key=lambda each: each[0])]


def at_intersection(system: System, orbit: Orbit, segment: int) -> bool:
    """Whether the event nodes at the ends of a segment may be about an intersection of surfaces."""
    ends = (orbit.mesh.events[j % len(orbit.phases)] for j in (segment, segment + 1))
    return all(_line(system, event) is not None for event in ends) and bool(
        intersections(system, orbit, segment)
    )


def _windows(count: int, segment: int) -> Iterator[tuple[int, ...]]:
    """Yield the neighbouring event nodes among which the two at the ends of a segment are."""
    for size in range(2, min(RAYS + LINES - 1, count)):
        for before in range(size - 1):
            yield tuple((segment - before + m) % count for m in range(size))


def _sites(system: System, orbit: Orbit, segment: int, nodes: tuple[int, ...]) -> Iterator[Site]:
    """Yield the sites at which event nodes give way to those on the other side."""
    near = [orbit.mesh.events[j] for j in nodes]
    length = float(orbit.mesh.segment_lengths(orbit.phases)[segment])
    for events in _others(system, orbit, nodes):
        begin, parts = float(orbit.phases[nodes[0]]), _parts(orbit, nodes, len(events))
        added = tuple(Added(event, begin, part) for event, part in zip(events, parts, strict=True))
        yield Site(SWAP, near[1].switch, segment, Length(segment, length), 0.0, added, nodes)


def _parts(orbit: Orbit, nodes: Sequence[int], count: int) -> list[float]:
    """Where event nodes lie, in parts of the first gap: as far apart as others in reverse, or evenly."""
    if count != len(nodes):
        return [float(k) for k in range(count)]
    gaps = orbit.mesh.segment_lengths(orbit.phases)[list(nodes[:-1])][::-1]
    return [0.0, *(float(part) for part in np.cumsum(gaps / gaps[0]))]


def _others(system: System, orbit: Orbit, nodes: tuple[int, ...]) -> Iterator[list[EventNode]]:
    """Yield the event nodes on the other side; none where event nodes are about no intersection."""
    every = [orbit.mesh.events[j] for j in nodes]
    count = len(every) - _slipping_on(system, every)
    nodes, events, again = nodes[:count], every[:count], every[count:]
    along = _along(system, events)
    lines = [_line(system, event) for event in (events[:-1] if along else events)]
    lines += [] if along else _passed(system, again)
    own = list(dict.fromkeys(line for line in lines if line is not None))
    if len(nodes) < 2 or None in lines or not (1 if along else 2) <= len(own) <= LINES:
        return
    each = [own] if len(own) == LINES else _completed(system, orbit, nodes, own)
    for cycle in each:
        if any(line != cycle[k % LINES] for k, line in enumerate(lines)):
            continue
        plane = _plane(system, orbit, nodes, cycle, len(lines))
        if plane is not None and _let_go(system, plane.again(system, plane.way)) == _let_go(system, again):
            yield from (plane.word(system, way) for way in plane.others())


def _slipping_on(system: System, events: Sequence[EventNode]) -> int:
    """How many of some event nodes, at their end, are releases of sliders that one before strains."""
    strained = {k for event in events for k, mode in event.modes if mode == STUCK}
    count = 0
    for event in events[:0:-1]:
        surface = surface_of(system, event.switch)
        if surface.kind != Kind.SLIDER or event.switch == surface.switch or surface.switch not in strained:
            break
        count += 1
    return count


def _passed(system: System, again: Sequence[EventNode]) -> list[int]:
    """The lines with sliders alone that slip on: they have been crossed again, at no event node."""
    lines = [twins(system, surface_of(system, event.switch).switch) for event in again]
    return [min(line) for line in lines if all(surface_of(system, k).kind != Kind.SLIDING for k in line)]


def _let_go(system: System, events: Sequence[EventNode]) -> set[tuple[int, int]]:
    """The guards of sliders that slip on at event nodes, with their modes."""
    own = {(surface_of(system, event.switch).switch, event.direction) for event in events}
    return own | {pair for event in events for pair in event.modes}


def _along(system: System, events: Sequence[EventNode]) -> bool:
    """Whether the last of some event nodes lies on a line along which the one before it is held."""
    return len(events) > 1 and _stops(system, events[-2])


def _stops(system: System, event: EventNode) -> bool:
    """Whether friction holds from an event node on that is none of a slider."""
    return any(mode == STUCK and surface_of(system, k).kind == Kind.SLIDING for k, mode in event.modes)


def _line(system: System, event: EventNode) -> int | None:
    """The guard, the first of its twins, that vanishes at an event node; None where it is no such event."""
    surface = surface_of(system, event.switch)
    if surface.releases is None or event.switch != surface.switch:
        return None
    return min(twins(system, event.switch))


def _completed(system: System, orbit: Orbit, nodes: tuple[int, ...], own: list[int]) -> Iterator[list[int]]:
    """Yield lines in the order in which they are crossed, with those that no event node crosses."""
    lines = {min(twins(system, k)) for k in of_held(system)} - set(own)
    if len(own) == 2:
        yield from ([*own, k] for k in lines if holding(system, k, own))
        return
    last = surface_of(system, orbit.mesh.events[nodes[-1]].switch).switch
    changed = [last, *(k for k, _ in orbit.mesh.events[nodes[-1]].modes)]
    others = {min(twins(system, k)) for k in changed} - set(own)
    pairs = (
        {one, k} for one in sorted(others) for k in sorted(lines - {one}) if holding(system, k, [*own, one])
    )
    for one, k in dict.fromkeys(tuple(sorted(pair)) for pair in pairs):
        yield from ([*own, one, k], [*own, k, one])


@dataclass(frozen=True)
class _Line:
    """A line: its guards' signs, friction along it, the sliders strained where it is first crossed, and
    the side on which the orbit comes.
    """

    signs: dict[int, int]
    friction: int | None
    strained: tuple[int, ...]
    side: int

    def node(self, count: int, stops: bool) -> EventNode | None:
        """The event node where it has been crossed `count` times before; None where nothing changes then."""
        strained = self.strained if count == 0 else ()
        held = (self.friction,) if stops and self.friction is not None else ()
        guard = self.friction if self.friction is not None else next(iter(strained), None)
        if guard is None:
            return None
        side = self.side if count % 2 == 0 else -self.side
        return EventNode(
            guard, -side * self.signs[guard], modes=tuple((k, STUCK) for k in (*held, *strained))
        )

    def again(self, system: System) -> EventNode | None:
        """The event node at which the sliders slip on; None where none has been strained."""
        modes = self.carried()
        if not modes:
            return None
        (guard, way), *others = modes
        return EventNode(release(surface_of(system, guard), way), way, modes=tuple(others))

    def carried(self) -> tuple[tuple[int, int], ...]:
        """The modes of the sliders on the side on which the orbit comes, where they slip."""
        return tuple((k, self.side * self.signs[k]) for k in self.strained)


@dataclass(frozen=True)
class _Way:
    """A way past the intersection: the lines crossed, and the one held then, if any.

    along: whether it is held through the intersection, at which the others are crossed as one. released: the
    side to which it is let go there, 0 where it is held on.
    """

    crossed: tuple[int, ...]
    held: int | None = None
    along: bool = False
    released: int = 0


@dataclass(frozen=True)
class _Plane:
    """Three lines in the order in which event nodes cross them, and the way that these go."""

    lines: dict[int, _Line]
    cycle: list[int]
    way: _Way

    def others(self) -> Iterator[_Way]:
        """Yield the ways on the other side."""
        back = tuple(self.cycle[-1 - k % LINES] for k in range(RAYS))
        own, held = len(self.way.crossed), self.way.held
        if held is None:
            yield _Way(back[: RAYS - own])
            for k in range(max(LINES - 1 - own, 0), LINES - own + 1):
                if self.lines[back[k]].friction is not None:
                    yield _Way(back[:k], back[k], along=True, released=self._side_after(self.way, back[k]))
            return
        until = back[: back.index(held)]
        if self.way.released:
            each = (_Way(back[: LINES - own - k]) for k in range(2) if LINES - own - k > 0)
            yield from (way for way in each if self._side_after(way, held) == self.way.released)
        elif self.way.along:
            yield _Way(until, held)
        else:
            yield _Way(back[: RAYS - 1 - own], held)
            yield _Way(until, held, along=True)

    def _side_after(self, way: _Way, line: int) -> int:
        side = self.lines[line].side
        return side if way.crossed.count(line) % 2 == 0 else -side

    def again(self, system: System, way: _Way) -> list[EventNode]:
        """The event nodes at which sliders along lines that are crossed twice slip on."""
        crossed = [*way.crossed, *(line for line in self.cycle if way.along and line != way.held)]
        twice = (line for line in self.cycle if crossed.count(line) == 2)
        each = (self.lines[line].again(system) for line in twice)
        return [node for node in each if node is not None]

    def word(self, system: System, way: _Way) -> list[EventNode]:
        """The event nodes of a way."""
        found, counts = list[EventNode | None](), dict.fromkeys(self.cycle, 0)
        for line in way.crossed:
            found.append(self.lines[line].node(counts[line], stops=False))
            counts[line] += 1
        if way.held is not None:
            found.append(self.lines[way.held].node(counts[way.held], stops=True))
        if way.along:
            found.append(self._at_once(way, counts))
        return [node for node in [*found, *self.again(system, way)] if node is not None]

    def _at_once(self, way: _Way, counts: dict[int, int]) -> EventNode | None:
        """The event node at which the two lines beside the one held are crossed as one."""
        each = (self.lines[line].node(counts[line], stops=False) for line in self.cycle if line != way.held)
        both = joined([node for node in each if node is not None])
        if both is None or not way.released:
            return both
        assert way.held is not None
        line = self.lines[way.held]
        assert line.friction is not None
        freed = line.friction, line.signs[line.friction] * way.released
        onward = line.carried() if way.released == line.side else ()
        return replace(both, modes=(*both.modes, freed, *onward))


def joined(nodes: Sequence[EventNode]) -> EventNode | None:
    """Return one event node for those at which friction and sliders of one guard change; None for none."""
    if len(nodes) < 2:
        return nodes[0] if nodes else None
    first, second = sorted(nodes, key=lambda node: node.switch in dict(node.modes))
    own = () if second.switch in dict(second.modes) else ((second.switch, second.direction),)
    return replace(first, modes=(*first.modes, *own, *second.modes))


def _plane(
    system: System, orbit: Orbit, nodes: tuple[int, ...], cycle: list[int], count: int
) -> _Plane | None:
    """The lines of event nodes, of which so many are crossed or held in turn.

    None where their guards are independent, or friction holds at one before.
    """
    events = [orbit.mesh.events[j] for j in nodes]
    if len(cycle) != LINES or not holding(system, cycle[-1], cycle[:-1]):
        return None
    stops = [k for k, event in enumerate(events) if _stops(system, event)]
    along = _along(system, events)
    if (stops and stops != [len(events) - 1 - along]) or _line(system, events[-1]) not in cycle:
        return None
    held = [cycle[stops[0] % LINES]] if stops else []
    found = {line: _found(system, orbit, nodes, line, held) for line in cycle}
    lines = {line: own for line, own in found.items() if own is not None}
    changed = {k for event in events for k, _ in event.modes}
    if len(lines) < LINES or changed - {k for own in lines.values() for k in own.signs}:
        return None
    crossed = tuple(cycle[k % LINES] for k in range(count - len(stops)))
    if not held:
        return _Plane(lines, cycle, _Way(crossed))
    if lines[held[0]].friction is None:  # friction that stops there is that of another line
        return None
    return _Plane(lines, cycle, _Way(crossed, held[0], along, _freed(lines[held[0]], events[-1])))


def _freed(line: _Line, event: EventNode) -> int:
    """The side of a line to which friction along it is let go at an event node; 0 where it is not."""
    assert line.friction is not None
    mode = dict(event.modes).get(line.friction, STUCK)
    return 0 if mode == STUCK else line.signs[line.friction] * mode


def _found(
    system: System, orbit: Orbit, nodes: tuple[int, ...], line: int, held: Sequence[int]
) -> _Line | None:
    """A line near event nodes; None where friction holds along it before, or only sliders that do not slip.

    Sliders that slip there all along are strained where it is crossed.
    """
    signs = twins(system, line)
    friction = [k for k in signs if surface_of(system, k).kind == Kind.SLIDING]
    strained, side = tuple[int, ...](), 0
    for event in (orbit.mesh.events[j] for j in nodes):
        own = [k for k, mode in event.modes if k in signs and k not in friction and mode == STUCK]
        strained = strained or tuple(own)
        side = side or -_way(system, event, line, held)
    if not side:
        slips = {k: _side(system, orbit, nodes, k) for k in signs}
        strained = strained or tuple(k for k, way in slips.items() if k not in friction and way)
        first = next(iter((*friction, *strained)), None)
        side = 0 if first is None else signs[first] * slips[first]
    if not side or not (friction or strained):
        return None
    return _Line(dict(signs), friction[0] if friction else None, strained, side)


def _side(system: System, orbit: Orbit, nodes: tuple[int, ...], guard: int) -> int:
    """The side of a guard on which an orbit is at event nodes that do not change it; 0 where it is held."""
    first, last = (int(orbit.mesh.starts[j]) for j in nodes[:2])
    mode = int(sides(system, orbit)[first, column(system, guard)])
    between = np.arange(first, last if last > first else last + orbit.mesh.ntst) % orbit.mesh.ntst
    values = SwitchPolynomials(system, orbit).knots[between][:, :, guard]
    return 0 if mode in (STUCK, HELD) else int(np.sign(values.sum()))


def _way(system: System, event: EventNode, line: int, held: Sequence[int]) -> int:
    """The direction in which a guard passes 0 at an event node; 0 where it does not.

    held: friction that makes other guards the same.
    """
    own = twins(system, line)
    if event.switch in own:
        return own[event.switch] * event.direction
    alike = twins(system, event.switch, held)
    changed = next((k for k, _ in event.modes if k in own and k in alike), None)
    return 0 if changed is None else own[changed] * alike[changed] * event.direction
