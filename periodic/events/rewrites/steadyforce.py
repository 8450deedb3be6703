"""Stops that break while the force that holds the joint stays as it is, until an event at another joint.

A mass at rest on another one that is at rest is held by a force that nothing changes before one of them is
torn off. Where that force exceeds its limit by d, the joint slips on with an acceleration that is as d, and
turns back only from the other event on: it stops after a further time that is as d^1/2. So the length of the
slip begins at that of the rest, and its amplitude, and its length beyond the event, at 0.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.events.modes import group, mode_after, modes_in, release, releases, surface_of
from periodic.events.rates import before, rate_before
from periodic.events.rewrites.sites import Site
from periodic.events.rewrites.table import SWITCHING_ABOUT, SWITCHING_SLIDING
from periodic.events.sideconditions import Limit
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import AT_LEVEL
from periodic.events.violations import largest
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, System, guards_gradient


def turning_back(system: System, orbit: Orbit, site: Site) -> Site:
    """Return a site where a stop breaks, with the new stop after the event that turns the joint back."""
    back = _comes_back(system, orbit, site) if site.row is SWITCHING_SLIDING else None
    if back is None:
        return site
    about, (stop,) = (back, orbit.mesh.events[back]), site.added
    added = (replace(stop, phase=float(orbit.phases[back])),)
    return replace(site, row=SWITCHING_ABOUT, added=added, replaced=(about, *site.replaced))


def _comes_back(system: System, orbit: Orbit, site: Site) -> int | None:
    """The event node of another surface from which the force on a joint comes back from its limit.

    None where it does so from the stop on, or not before the joint is released.
    """
    surface, limit, mesh = surface_of(system, site.switch), site.held, orbit.mesh
    assert isinstance(limit, Limit)
    own = group(system, mesh, surface.switch)
    end = own[(own.index(limit.node) + 1) % len(own)]
    first, last = int(mesh.starts[limit.node]), int(mesh.starts[end])
    inside = np.arange(first, last if last > first else last + mesh.ntst) % mesh.ntst
    dense = SwitchPolynomials(system, orbit)
    force = limit.side * dense.knots[inside][:, :, limit.switch]
    changed = (force - force[0, 0]) / largest(dense, *releases(system, surface.switch))
    moved = np.abs(changed) > AT_LEVEL
    if not moved.any():
        return None
    place = int(moved.any(axis=1).argmax())
    node = int(mesh.segments[0][inside[place]])
    back = changed[place][moved[place]][0] > 0
    return node if back and node != limit.node else None


def slipping_on(system: System, orbit: Orbit, segment: int) -> int | None:
    """Return the event node at which a joint passes, to slip on until it stops at the end of a segment.

    None where the segment does not begin with an event of another surface up to which the joint speeds up:
    joints that slow down may also stop before that event.
    """
    events, end = orbit.mesh.events, (segment + 1) % len(orbit.phases)
    surface, stop = surface_of(system, events[end].switch), events[end]
    if surface.kind != Kind.SLIDING or stop.switch != surface.switch or mode_after(surface, stop) != STUCK:
        return None
    own = group(system, orbit.mesh, surface.switch)
    begin = own[own.index(end) - 1]
    if segment in own or events[begin].switch != surface.switch:
        return None
    return begin if _slope(system, orbit, surface.switch, segment) * events[begin].direction > 0 else None


def _slope(system: System, orbit: Orbit, switch: int, node: int) -> float:
    """ds/dtau of a switch just before an event node."""
    interval, x, phase = before(orbit, node)
    side = modes_in(system, orbit, interval)
    d_state, d_phase, _ = guards_gradient(system, x, phase, orbit.parameter, side)
    return float(d_phase[0, switch] + d_state[0, switch] @ rate_before(orbit, node))


def stopped_again(system: System, orbit: Orbit, segment: int) -> Site:
    """Return the site where the joint stops for good at the event node at which it passes."""
    begin = slipping_on(system, orbit, segment)
    assert begin is not None
    first, end = orbit.mesh.events[begin], (segment + 1) % len(orbit.phases)
    surface = surface_of(system, first.switch)
    stops = replace(first, modes=((surface.switch, STUCK), *first.modes_beside(surface.switch)))
    onward = release(surface, first.direction)
    kept = (segment, orbit.mesh.events[segment]), (begin, stops)
    held = Limit(begin, onward, -first.direction)
    return Site(SWITCHING_ABOUT, onward, begin, held, 0.0, (), (end,), kept)
