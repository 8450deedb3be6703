"""Grazing of an impact whose rebound reverses the sliding of the mass: friction's events at grazing.

The speed of a mass that grazes a wall is 0 there, and so is its sliding speed: the orbit without the
impact has an event node of friction at grazing. On the orbit with the impact, the impact takes the guard to
its other side; where friction held the mass at grazing, it stops the mass again after the rebound.
"""

from __future__ import annotations

from periodic.events.modes import mode_after, surface_of
from periodic.events.rewrites.sites import Added, Site, apart
from periodic.events.rewrites.table import IMPACT
from periodic.events.sideconditions import Clearance
from periodic.events.switchpolynomials import Extremum
from periodic.events.thresholds import AT_EXTREMUM
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, System, surfaces_of

SOON = 0.3
"""A stop that follows an impact within so many rad may be brought about by its rebound."""


def first_impact(system: System, orbit: Orbit, at: Extremum, side: int, value: float) -> Site:
    """Return the site where an impact begins: the event nodes of friction at grazing give way to it."""
    modes, removed, added = list[tuple[int, int]](), list[int](), list[Added]()
    for j, event in enumerate(orbit.mesh.events):
        surface = surface_of(system, event.switch)
        own = surface.releases is not None and event.switch == surface.switch
        if not own or apart(float(orbit.phases[j]), at.phase, orbit) > AT_EXTREMUM:
            continue
        removed.append(j)
        modes.append((surface.switch, event.direction))
        if mode_after(surface, event) == STUCK:
            back = EventNode(surface.switch, -event.direction, modes=((surface.switch, STUCK),))
            added.append(Added(back, at.phase, 1.0))
    impact = EventNode(at.switch, -side, modes=tuple(modes))
    held = Clearance(at.switch, side, at.phase)
    each = (Added(impact, at.phase, 0.0), *added)
    return Site(IMPACT, at.switch, at, held, value, each, tuple(removed))


def last_impact(system: System, orbit: Orbit, index: int) -> list[Site]:
    """Return the sites where an impact ends: guards that it reversed pass their level instead, or stop."""
    event, phase = orbit.mesh.events[index], float(orbit.phases[index])
    held, found = Clearance(event.switch, -event.direction, phase), list[Site]()
    crossing = [Added(EventNode(k, mode), phase, 0.0) for k, mode in event.modes]
    found.append(Site(IMPACT, event.switch, index, held, 0.0, tuple(crossing), (index,)))
    stopping, gone = list[Added](), [index]
    for k, mode in event.modes:
        after = _stop_after(system, orbit, index, k)
        stops = () if after is None else ((k, STUCK),)
        stopping.append(Added(EventNode(k, mode, modes=stops), phase, 0.0))
        gone += [] if after is None else [after]
    if len(gone) > 1:
        found.insert(0, Site(IMPACT, event.switch, index, held, 0.0, tuple(stopping), tuple(gone)))
    return found


def _stop_after(system: System, orbit: Orbit, index: int, switch: int) -> int | None:
    """The event node at which a guard that an impact has reversed is held soon after, if it is."""
    surface = next(s for s in surfaces_of(system) if s.switch == switch)
    for m in range(1, len(orbit.phases)):
        j = (index + m) % len(orbit.phases)
        mode = mode_after(surface, orbit.mesh.events[j])
        if mode is not None:
            soon = (orbit.phases[j] - orbit.phases[index]) % orbit.mesh.period < SOON
            return j if mode == STUCK and soon else None
    return None
