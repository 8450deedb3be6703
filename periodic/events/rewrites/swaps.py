"""Events of different surfaces that come together and change places."""

from __future__ import annotations

from collections.abc import Sequence

from periodic.events.impacts import tied
from periodic.events.modes import mode_after, of_kind, surface_of
from periodic.events.rewrites.corners import reversed_by_impact
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import SWAP
from periodic.events.sideconditions import Length
from periodic.events.twinguards import held_at, held_throughout, holding, twins
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System, surfaces_of


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
    always = held_throughout(system, orbit.mesh.modes)
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
    begin = float(orbit.phases[i])
    early = begin - length if i in impacts else begin + length if j in impacts else begin
    added = Added(second, early, 0.0), Added(first, early, 1.0)
    return Site(SWAP, second.switch, i, Length(i, length), 0.0, added, (i, j))
