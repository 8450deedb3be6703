"""Joints side by side: their guards are one function, so those that slip stop together, at one event node.

Where they are let go together is said by `together`.
"""

from __future__ import annotations

from dataclasses import replace

from periodic.events.modes import mode_after, surface_of, twins
from periodic.events.rewrites.sites import Added, Site, apart
from periodic.events.rewrites.table import GRAZING_SLIDING
from periodic.events.switchpolynomials import Extremum
from periodic.events.thresholds import BESIDE_EXTREMUM
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System


def with_twins(system: System, orbit: Orbit, site: Site) -> Site:
    """Return where a joint begins to slip, or to be held, with what its twins do at the same event nodes.

    A slider that begins to slip where the strain turns stops where the others do; where the strain turns back
    for a while all that slip are held together, and let go together.
    """
    assert isinstance(site.at, Extremum)
    guard = surface_of(system, site.switch).switch
    both = [k for k in twins(system, guard) if k != guard]
    if not both:
        return site
    if site.row is GRAZING_SLIDING:
        return _grazing(system, orbit, site, guard, both)
    if surface_of(system, guard).kind != Kind.SLIDER:
        return site
    release, stop = site.added
    for j, event in enumerate(orbit.mesh.events):
        if event.switch in both and apart(float(orbit.phases[j]), site.at.phase, orbit) < BESIDE_EXTREMUM:
            joined = replace(event, modes=(*event.modes, (guard, STUCK)))
            site = replace(site, added=(release,), replaced=((j, joined),))
            break
    return site


def leading(system: System, surface: SurfaceLike) -> SurfaceLike:
    """Return the surface whose grazing-sliding that of another one is: of dry friction beside sliders its."""
    each = (surface_of(system, k) for k in twins(system, surface.switch))
    return next((own for own in each if own.kind == Kind.SLIDING), surface)


def _grazing(system: System, orbit: Orbit, site: Site, guard: int, both: list[int]) -> Site:
    """All that slip about the turn are held for a while."""
    assert isinstance(site.at, Extremum)
    stop, release = site.added
    slipping = [k for k in both if _mode(system, orbit, k, site.at.interval) == release.event.direction]
    stuck = tuple((k, STUCK) for k in slipping)
    onward = tuple((k, release.event.direction) for k in slipping)
    first = Added(replace(stop.event, modes=(*stop.event.modes, *stuck)), stop.phase, stop.part)
    last = Added(replace(release.event, modes=onward), release.phase, release.part)
    return replace(site, added=(first, last))


def _mode(system: System, orbit: Orbit, switch: int, interval: int) -> int:
    """The mode of a surface in an interval; 0 where no event node says it."""
    surface, mesh = surface_of(system, switch), orbit.mesh
    each = zip(mesh.starts, mesh.events, strict=True)
    changes = [(int(j), mode_after(surface, event)) for j, event in each]
    known = [(j, mode) for j, mode in changes if mode is not None]
    before = [mode for j, mode in known if j <= interval] or [mode for _, mode in known]
    return before[-1] if before else 0
