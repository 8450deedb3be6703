"""Events of different surfaces that come together and change places."""

from __future__ import annotations

from periodic.events.impacts import tied
from periodic.events.modes import of_kind, surface_of, twins
from periodic.events.rewrites.corners import reversed_by_impact
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import SWAP
from periodic.events.sideconditions import Length
from periodic.orbit.orbit import Orbit
from periodic.system import Kind, SurfaceLike, System


def swaps(system: System, orbit: Orbit, segment: int) -> bool:
    """Whether the event nodes at the ends of a segment are of different surfaces, and may change places."""
    first, second = (orbit.mesh.events[j % len(orbit.phases)] for j in (segment, segment + 1))
    marked = {surface.switch for surface in of_kind(system, Kind.MARKER)}
    if {first.switch, second.switch} & marked or len(orbit.phases) < 2:
        return False
    one, other = (surface_of(system, event.switch) for event in (first, second))
    if one.switch == other.switch or _bound(system, one, other):
        return False
    return not reversed_by_impact(system, orbit, segment)


def _bound(system: System, one: SurfaceLike, other: SurfaceLike) -> bool:
    """Whether two surfaces are friction and a slider beside it, which is not strained where it holds."""
    both = {one.kind, other.kind} == {Kind.SLIDING, Kind.SLIDER}
    return both and other.switch in twins(system, one.switch)


def swapped(system: System, orbit: Orbit, segment: int) -> Site:
    """Return the site where the event nodes at the ends of a segment are the other way round.

    The state before an impact is that of its phase: there the other one goes to the far side of it.
    """
    i, j = segment, (segment + 1) % len(orbit.phases)
    first, second = orbit.mesh.events[i], orbit.mesh.events[j]
    length, impacts = float(orbit.mesh.segment_lengths(orbit.phases)[i]), tied(system, orbit)
    begin = float(orbit.phases[i])
    early = begin - length if i in impacts else begin + length if j in impacts else begin
    added = Added(second, early, 0.0), Added(first, early, 1.0)
    return Site(SWAP, second.switch, i, Length(i, length), 0.0, added, (i, j))
