"""Stops of two joints that become one where friction holds both masses: then their guards are the same.

If friction between two masses sticks earlier, two joints on them that stopped just before now stop
simultaneously just after. If it is released earlier, two joints that stopped simultaneously stop in turn.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from periodic.events.impacts import tied
from periodic.events.modes import surface_of
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import MERGING
from periodic.events.sideconditions import Lengths
from periodic.events.twinguards import held_at, held_throughout, twins
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, System


@dataclass(frozen=True)
class Meeting:
    """Neighbouring event nodes: where friction sticks or is released, and the stops of two joints.

    node: the first of them. friction: the node of friction. stops: the nodes of the stops, two, or one for
    both. alike: the guards that are the same function where friction holds, with their signs. groups: those
    that stop, in two groups that are each the same function anyway, as of sliders in parallel.
    """

    node: int
    friction: int
    stops: tuple[int, ...]
    alike: dict[int, int]
    groups: tuple[tuple[int, ...], ...]

    @property
    def segments(self) -> tuple[int, ...]:
        """The segments between them, by their first nodes."""
        own = (self.friction, *self.stops)
        return own[:-1] if self.friction == self.node else (*self.stops,)


def merging(system: System, orbit: Orbit, node: int) -> Meeting | None:
    """Return the neighbouring event nodes, the first of them `node`, at which stops merge or part, if any."""
    events, count = orbit.mesh.events, len(orbit.phases)
    always = held_throughout(system, orbit.mesh.modes)
    for size in (2, 3) if count > 2 else ():
        nodes = [(node + m) % count for m in range(size)]
        if set(nodes) & set(tied(system, orbit)):
            return None
        for friction, stops in ((nodes[-1], nodes[:-1]), (nodes[0], nodes[1:])):
            own = surface_of(system, events[friction].switch)
            sticks = events[friction].modes == ((own.switch, STUCK),)
            held_last = (friction == nodes[-1]) == (size == 3)
            if own.kind != Kind.SLIDING or sticks != held_last or (not sticks and events[friction].modes):
                continue
            held = [k for k in held_at(system, events, stops[0], always) if k != own.switch]
            guards = _stopped(events, stops)
            groups = _groups(system, guards, held)
            alike = twins(system, guards[0], [*held, own.switch]) if len(groups) == 2 else {}
            if len(groups) == 2 and set(guards) <= set(alike):
                return Meeting(node, friction, tuple(stops), alike, groups)
    return None


def _groups(system: System, guards: Sequence[int], held: Sequence[int]) -> tuple[tuple[int, ...], ...]:
    """The guards by what is the same function."""
    left, found = list(guards), list[tuple[int, ...]]()
    while left:
        alike = twins(system, left[0], held)
        found.append(tuple(k for k in left if k in alike))
        left = [k for k in left if k not in alike]
    return tuple(found)


def _stopped(events: Sequence[EventNode], stops: Sequence[int]) -> list[int]:
    """The guards of two joints that stop at event nodes where nothing else happens; [] if there is more."""
    each = [events[j] for j in stops]
    found = [k for event in each for k, mode in event.modes if mode == STUCK]
    plain = all(event.switch in dict(event.modes) for event in each)
    alone = len(found) == sum(len(event.modes) for event in each)
    return found if plain and alone else []


def merged(system: System, orbit: Orbit, node: int) -> Iterator[Site]:
    """Yield the sites at which the stops have merged, or have parted, in either order."""
    found = merging(system, orbit, node)
    assert found is not None
    events, begin = orbit.mesh.events, float(orbit.phases[node])
    friction, removed = events[found.friction], (found.friction, *found.stops)
    last = found.friction != node
    for stops in _other(system, [events[j] for j in found.stops], found):
        each = [friction, *stops] if last else [*stops, friction]
        added = tuple(Added(event, begin, float(k)) for k, event in enumerate(each))
        held = Lengths(found.segments, 0.0)
        yield Site(MERGING, friction.switch, node, held, 0.0, added, removed)


def _other(system: System, stops: Sequence[EventNode], found: Meeting) -> Iterator[list[EventNode]]:
    """Yield one event node for two stops, or two for one of both, in either order."""
    if len(stops) == 2:
        first = next((e for e in stops if surface_of(system, e.switch).kind == Kind.SLIDING), stops[0])
        others = [event for event in stops if event is not first]
        yield [replace(first, modes=(*first.modes, *(pair for e in others for pair in e.modes)))]
        return
    (event,) = stops
    way = found.alike[event.switch] * event.direction
    each = [_stop(system, group, found.alike, way) for group in found.groups]
    yield each
    yield each[::-1]


def _stop(system: System, group: Sequence[int], alike: dict[int, int], way: int) -> EventNode:
    """The event node at which joints of one guard stop: that of friction among them, if there is any."""
    first = next((k for k in group if surface_of(system, k).kind == Kind.SLIDING), group[0])
    return EventNode(first, alike[first] * way, modes=tuple((k, STUCK) for k in group))
