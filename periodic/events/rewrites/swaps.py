"""Events of different surfaces that come together and change places."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from periodic.events.impacts import tied
from periodic.events.modes import mode_after, of_held, of_kind, surface_of
from periodic.events.rewrites.corners import reversed_by_impact
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import SWAP
from periodic.events.sideconditions import Length
from periodic.events.twinguards import held_at, holding, twins
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import HELD, STUCK, Kind, SurfaceLike, System, surfaces_of


def swaps(system: System, orbit: Orbit, segment: int) -> bool:
    """Whether the event nodes at the ends of a segment are of different surfaces, and may change places."""
    first, second = (orbit.mesh.events[j % len(orbit.phases)] for j in (segment, segment + 1))
    marked = {surface.switch for surface in of_kind(system, Kind.MARKER)}
    if {first.switch, second.switch} & marked or len(orbit.phases) < 2:
        return False
    one, other = (surface_of(system, event.switch) for event in (first, second))
    if one.switch == other.switch or _bound(system, orbit, segment):
        return False
    return not reversed_by_impact(system, orbit, segment)


def _bound(system: System, orbit: Orbit, segment: int) -> bool:
    """Whether friction on which the change at one event node depends begins or ceases to hold at the other.

    Joints stop simultaneously, or are not strained, only while that friction holds.
    """
    events, count = orbit.mesh.events, len(orbit.phases)
    ends = segment, (segment + 1) % count
    always = [switch for switch, mode in orbit.mesh.modes if mode == HELD]
    for node, other, beyond in ((*ends, (ends[1] + 1) % count), (*ends[::-1], (ends[0] - 1) % count)):
        friction = [s.switch for s in _changed(system, events[node]) if _held_beside(s, events, node)]
        if not friction:
            continue
        held = held_at(system, events, other, always)
        held = [k for k in held if k not in friction]
        for k in (s.switch for s in _changed(system, events[other])):
            if holding(system, k, [*held, *friction]) and not holding(system, k, held):
                return True
        stopped = _stopped(events[other])
        near = {*stopped, *(_stopped(events[beyond]) if beyond != node else ())}
        for k in stopped:
            alike = set(twins(system, k, [*held, *friction])) - set(twins(system, k, held))
            if alike & near:
                return True
    return False


def _held_beside(surface: SurfaceLike, events: Sequence[EventNode], node: int) -> bool:
    """Whether friction holds before an event node that changes it, or after it."""
    if surface.kind != Kind.SLIDING:
        return False
    modes = (mode_after(surface, events[(node - m) % len(events)]) for m in range(1, len(events) + 1))
    before = next((mode for mode in modes if mode is not None), None)
    return STUCK in (before, mode_after(surface, events[node]))


def _stopped(event: EventNode) -> list[int]:
    """The guards that are held from an event node on."""
    return [k for k, mode in event.modes if mode == STUCK]


def _changed(system: System, event: EventNode) -> list[SurfaceLike]:
    """The surfaces at which motions may be held whose modes an event node changes."""
    each = (surface for surface in surfaces_of(system) if surface.releases is not None)
    return [surface for surface in each if mode_after(surface, event) is not None]


def swapped(system: System, orbit: Orbit, segment: int) -> Site:
    """Return the site where the event nodes at the ends of a segment are the other way round.

    An impact keeps its phase, so that its state fits; the other event goes to the far side of it.
    """
    i, j = segment, (segment + 1) % len(orbit.phases)
    first, second = orbit.mesh.events[i], orbit.mesh.events[j]
    length, impacts = float(orbit.mesh.segment_lengths(orbit.phases)[i]), tied(system, orbit)
    begin, nodes = float(orbit.phases[i]), _with_third(system, orbit, segment)
    if len(nodes) > 2:
        added = _reversed(orbit, nodes)
    else:
        early = begin - length if i in impacts else begin + length if j in impacts else begin
        added = Added(second, early, 0.0), Added(first, early, 1.0)
    return Site(SWAP, second.switch, i, Length(i, length), 0.0, added, nodes)


def _with_third(system: System, orbit: Orbit, segment: int) -> tuple[int, ...]:
    """The event nodes at the ends of a segment, and a neighbour that meets them at once, if there is one.

    Its guard is a combination of theirs, as the difference of two speeds is of these; the nearer of two.
    """
    events, count = orbit.mesh.events, len(orbit.phases)
    i, j = segment, (segment + 1) % count
    pair, guards, lengths = (i, j), set(of_held(system)), orbit.mesh.segment_lengths(orbit.phases)
    before, after = (i - 1) % count, (j + 1) % count
    near = sorted([(lengths[j], after, (*pair, after)), (lengths[before], before, (before, *pair))])
    for _, third, nodes in near if count > 3 else ():
        own, switch = [events[k].switch for k in pair], events[third].switch
        if switch not in own and {*own, switch} <= guards and holding(system, switch, own):
            return nodes
    return pair


def _reversed(orbit: Orbit, nodes: Sequence[int]) -> tuple[Added, ...]:
    """Three event nodes in reverse order, as far apart as they were but that the first gap is the size."""
    lengths = orbit.mesh.segment_lengths(orbit.phases)[[nodes[1], nodes[0]]]
    parts = np.array([0.0, 1.0, 1.0 + lengths[1] / lengths[0]])
    begin = float(orbit.phases[nodes[0]])
    each = zip(reversed(nodes), parts, strict=True)
    return tuple(Added(orbit.mesh.events[k], begin, float(part)) for k, part in each)
