"""Sites where a part of the word of an orbit begins: the rows of the table read from left to right."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from periodic.events.modes import group, held_all_along, mode_after, release, surface_of, torn
from periodic.events.rewrites.heldback import after
from periodic.events.rewrites.meetings import begun
from periodic.events.rewrites.reversals import held, short_of
from periodic.events.rewrites.sites import Added, Site, apart
from periodic.events.rewrites.steadyforce import turning_back
from periodic.events.rewrites.strikes import first_impact
from periodic.events.rewrites.table import (
    ADDING_ABOUT,
    ADDING_SLIDING,
    CROSSING_SLIDING,
    FIRST_DEPARTURES,
    FIRST_SLIPS,
    GRAZING,
    GRAZING_SLIDING,
    IMPACT,
    LIMIT_GRAZING,
    RELAY,
    SWITCHING_SLIDING,
    TEARING,
    Row,
)
from periodic.events.rewrites.tornoff import before_torn
from periodic.events.rewrites.twins import leading, parted, slipping_together, with_twins
from periodic.events.sideconditions import Clearance, Limit
from periodic.events.switchpolynomials import Extremum, SwitchPolynomials
from periodic.events.thresholds import AT_LEVEL, SLOW_CROSSING, TOGETHER
from periodic.events.violations import Breach, Violation, largest, limits
from periodic.orbit.mesh import EventNode, wrapped
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System, surfaces_of


def begins(system: System, orbit: Orbit, violation: Violation) -> Site | None:
    """Return the site where an orbit violates its word; None where no row of the table is for it."""
    surface = surface_of(system, violation.switch)
    if violation.breach not in (Breach.EXCURSION, Breach.MODE):
        return None
    if isinstance(violation.at, Extremum):
        return _at_extremum(system, orbit, surface, violation.at, violation.side, -violation.depth)
    return _limit(system, orbit, surface, violation)


def at_once(system: System, orbit: Orbit, own: Site, within: float = TOGETHER) -> list[Site]:
    """Return a site as it is on the orbit where it begins, and those of its row that begin there too.

    Those are within a distance of being reached. Empty where there is no such site on that orbit.
    """
    near = [site for site in sites_of(system, orbit, own.row.name) if abs(site.value) <= within]
    if isinstance(own.at, Extremum) and own.row in (GRAZING, IMPACT):
        assert isinstance(own.held, Clearance)
        at = SwitchPolynomials(system, orbit).nearest(own.switch, own.held.side, own.held.phase)
        first: Site | None = _at_extremum(
            system, orbit, surface_of(system, own.switch), at, own.held.side, own.value
        )
    else:
        first = min(near, key=lambda site: _distance(own, site, orbit), default=None)
    if first is None:
        return []
    found, guard = [first], surface_of(system, own.switch).switch
    if own.row is FIRST_SLIPS:  # a joint that slips one way alone would drift
        back = (site for site in sites_of(system, orbit, own.row.name) if site.switch != own.switch)
        other = (site for site in back if surface_of(system, site.switch).switch == guard)
        near = [*near, *sorted(other, key=lambda site: abs(site.value))[:1]]
    for site in near:
        if site is not first and not any(_same(system, orbit, site, other) for other in found):
            found.append(site)
    return slipping_together(system, orbit, [turning_back(system, orbit, site) for site in found])


def sites_of(
    system: System, orbit: Orbit, row: str, surfaces: Sequence[SurfaceLike] | None = None
) -> Iterator[Site]:
    """Yield all sites of a row on an orbit, with how far each is from being reached.

    surfaces: at which they are, by default any.
    """
    dense = SwitchPolynomials(system, orbit)
    for surface in surfaces_of(system):
        if surfaces is not None and surface not in surfaces:
            continue
        for switch in (surface.switch, *(surface.releases or ())):
            if row_of(orbit, surface, switch) == row:
                yield from _extrema(dense, surface, switch)
            before = row in (ADDING_ABOUT.name, TEARING.name) and switch != surface.switch
            if before and surface.kind == Kind.SLIDING:
                yield from (s for s in _before_events(dense, surface, switch) if s.row.name == row)
        if surface.releases is not None:
            each = (_limit(system, orbit, surface, limit) for limit in limits(system, orbit, surface))
            yield from (site for site in each if site is not None and site.row.name == row)


def row_of(orbit: Orbit, surface: SurfaceLike, switch: int) -> str:
    """Return the name of the row for an extremum of a switch."""
    if surface.kind in (Kind.KINK, Kind.JUMP):
        return GRAZING.name
    if surface.kind == Kind.IMPACT:
        return IMPACT.name
    if surface.kind == Kind.RELAY:
        return RELAY.name
    if surface.releases is not None:
        return (GRAZING_SLIDING if switch == surface.switch else _slip(orbit, surface)).name
    return ""


def _slip(orbit: Orbit, surface: SurfaceLike) -> Row:
    """The row of a slip at a surface that holds motions."""
    if held_all_along(orbit.mesh, surface):
        return FIRST_DEPARTURES if surface.place is None else FIRST_SLIPS
    return LIMIT_GRAZING if surface.kind == Kind.SLIDER else ADDING_SLIDING


def _extrema(dense: SwitchPolynomials, surface: SurfaceLike, switch: int) -> Iterator[Site]:
    """The sites at extrema of a switch on its expected sides, away from its own event nodes."""
    sides = dense.expected(switch, dense.side(switch))
    most = largest(dense, switch)
    for side in (int(side) for side in np.unique(sides) if side):
        for e in dense.minima(switch, side):
            if sides[e.interval] == side and not beside_node(dense, e):
                yield _at_extremum(dense.system, dense.orbit, surface, e, side, side * e.value / most)


def beside_node(dense: SwitchPolynomials, at: Extremum) -> bool:
    """Return whether an extremum is rounding beside an event node at which its switch is at its level.

    If the switch leaves its level in between, the extremum is one of a short segment.
    """
    system, orbit, surface = dense.system, dense.orbit, surface_of(dense.system, at.switch)
    if surface.releases is None and surface.kind != Kind.RELAY:
        return False
    along, level = dense.along(at.switch, everywhere=True), TOGETHER * largest(dense, at.switch)
    for tau in map(float, orbit.phases[group(system, orbit.mesh, at.switch)]):
        way = wrapped(at.phase - tau, orbit.mesh.period)
        if abs(way) < SLOW_CROSSING:
            between = np.mod(np.sign(way) * (along.phase - tau), orbit.mesh.period) <= abs(way)
            if np.abs(along.value[between]).max(initial=0.0) <= level:
                return True
    return False


def _at_extremum(
    system: System, orbit: Orbit, surface: SurfaceLike, at: Extremum, side: int, value: float
) -> Site:
    """The site of an extremum on a given side of its level."""
    k = at.switch
    if surface.kind == Kind.IMPACT:
        return first_impact(system, orbit, at, side, value)
    if surface.kind == Kind.RELAY:
        return Site(RELAY, k, at, Clearance(k, side, at.phase), value)
    if surface.releases is None:
        return _grazing(system, orbit, at, side, value)
    if k == surface.switch:
        surface, sign = leading(system, orbit, surface, at.interval)
        k, side = surface.switch, sign * side
        at = replace(at, switch=k, value=sign * at.value)
        let_go = EventNode(release(surface, side), side)
        early, late = (-1 / 3, 2 / 3) if surface.kind == Kind.SLIDER else (-1.0, 0.0)
        new = (EventNode(k, -side, modes=((k, STUCK),)), early), (let_go, late)
        row, left = GRAZING_SLIDING, 0.0
    elif (node := _jumped_at(system, orbit, surface, at)) is not None:
        return _before_event(system, orbit, surface, node, k, side, value)
    else:
        early, late = (-1.0, 0.0) if surface.kind == Kind.SLIDER else (-1 / 3, 2 / 3)
        guard = surface.switch
        stop = EventNode(guard, side, modes=((guard, STUCK),))
        new = (EventNode(k, -side), early), (stop, late)
        row, left = _slip(orbit, surface), AT_LEVEL * largest(SwitchPolynomials(system, orbit), k)
    added = tuple(Added(event, at.phase, part) for event, part in new)
    held_at = Clearance(k, side, at.phase, left)
    return with_twins(system, orbit, Site(row, k, at, held_at, value, added))


def _jumped_at(system: System, orbit: Orbit, surface: SurfaceLike, at: Extremum) -> int | None:
    """The event node of another surface just before which an extremum lies, if any: the force jumps there."""
    if at.theta < 1.0 or surface.kind != Kind.SLIDING or held_all_along(orbit.mesh, surface):
        return None
    node = next(
        (j for j, start in enumerate(orbit.mesh.starts) if start == (at.interval + 1) % orbit.mesh.ntst), None
    )
    return None if node is None or not _jumps(system, surface, orbit.mesh.events[node]) else node


def _jumps(system: System, surface: SurfaceLike, event: EventNode) -> bool:
    """Whether the force on friction that holds jumps at an event of another surface, and may tear it off."""
    return mode_after(surface, event) is None or torn(system, surface, event)


def _before_event(
    system: System, orbit: Orbit, surface: SurfaceLike, node: int, switch: int, side: int, value: float
) -> Site:
    """The site of a slip that begins before an event of another surface, at which the force on it falls back.

    Joints that stopped at the event because this one held stop with it then.
    """
    event, phase, guard = orbit.mesh.events[node], float(orbit.phases[node]), surface.switch
    if torn(system, surface, event):
        return before_torn(system, orbit, surface, node, switch, side, value)
    apart_now = parted(system, orbit, event, node, guard)
    rest = replace(event, modes=tuple(pair for pair in event.modes if pair not in apart_now))
    stop = EventNode(guard, side, modes=((guard, STUCK), *apart_now))
    later = after(SwitchPolynomials(system, orbit), node, switch, side)
    added = Added(EventNode(switch, -side), phase, -1.0), Added(stop, phase, *later)
    left = AT_LEVEL * _largest_release(system, orbit, surface)
    replaced = ((node, rest),) if apart_now else ()
    return Site(ADDING_ABOUT, switch, node, Limit(node, switch, side, left), value, added, (), replaced)


def _before_events(dense: SwitchPolynomials, surface: SurfaceLike, switch: int) -> Iterator[Site]:
    """The sites of slips that begin before events of other surfaces."""
    system, orbit, most = dense.system, dense.orbit, largest(dense, switch)
    sides = dense.expected(switch, dense.side(switch))
    for node, event in enumerate(orbit.mesh.events):
        interval = int(orbit.mesh.starts[node]) - 1
        side = int(sides[interval])
        if side and _jumps(system, surface, event) and not held_all_along(orbit.mesh, surface):
            at = Limit(node, switch, side).linearise(system, orbit, ())
            yield _before_event(system, orbit, surface, node, switch, side, at.value / most)


def _grazing(system: System, orbit: Orbit, at: Extremum, side: int, value: float) -> Site:
    """A short excursion about an extremum.

    Where friction holds the motion at the extremum the event nodes lie before and after the sticking. The
    later one is as far off as the third root of the depth, as the motion sets out without acceleration.
    """
    k, (begin, end) = at.switch, held(system, orbit, at.switch, at.phase)
    out, back = EventNode(k, -side), EventNode(k, side)
    added = (Added(out, begin, -0.5), Added(back, end, 0.5))
    if begin != end:
        added = (Added(out, begin, -1.0), Added(back, end, 1.0, 2 / 3))
    left = short_of(system, orbit, k, at.phase)
    return Site(GRAZING, k, at, Clearance(k, side, at.phase, left), value, added)


def _limit(system: System, orbit: Orbit, surface: SurfaceLike, limit: Violation) -> Site | None:
    """The site at an event node where a passage may begin to be held, or a stop may break."""
    assert isinstance(limit.at, int)
    if surface_of(system, orbit.mesh.events[limit.at].switch).kind == Kind.IMPACT:
        return begun(system, orbit, surface, limit)
    node, event, guard = limit.at, orbit.mesh.events[limit.at], surface.switch
    phase, most = float(orbit.phases[node]), _largest_release(system, orbit, surface)
    others = event.modes_beside(guard)
    if mode_after(surface, event) == STUCK:
        passes = replace(event, modes=others)
        stop = EventNode(guard, -event.direction, modes=((guard, STUCK),))
        row, changed, new = SWITCHING_SLIDING, passes, stop
    else:
        stops = replace(event, modes=((guard, STUCK), *others))
        row, changed, new = CROSSING_SLIDING, stops, EventNode(limit.switch, event.direction)
    held_at = Limit(node, limit.switch, limit.side, AT_LEVEL * most)
    value = -limit.depth
    return Site(row, limit.switch, node, held_at, value, (Added(new, phase, 1.0),), (), ((node, changed),))


def _largest_release(system: System, orbit: Orbit, surface: SurfaceLike) -> float:
    return largest(SwitchPolynomials(system, orbit), *(surface.releases or ()))


def _distance(own: Site, site: Site, orbit: Orbit) -> float:
    """How far another site is from one, infinite where it is of another kind."""
    if isinstance(own.at, Extremum) and isinstance(site.at, Extremum) and own.switch == site.switch:
        return apart(own.at.phase, site.at.phase, orbit)
    return 0.0 if own.at == site.at and own.switch == site.switch else np.inf


def _same(system: System, orbit: Orbit, one: Site, other: Site) -> bool:
    """Whether two sites are one."""
    if one.switch != other.switch or isinstance(one.at, Extremum) != isinstance(other.at, Extremum):
        return False
    if not (isinstance(one.at, Extremum) and isinstance(other.at, Extremum)):
        return one.at == other.at
    if one.row is not GRAZING:
        turns = [[node for node, _ in site.replaced] for site in (one, other)]
        held_there = bool(turns[0]) and turns[0] == turns[1]  # at its greatest value all along
        return held_there or apart(one.at.phase, other.at.phase, orbit) < SLOW_CROSSING
    begin, end = held(system, orbit, one.switch, one.at.phase)
    later = np.mod(other.at.phase - begin + SLOW_CROSSING, orbit.mesh.period)
    return bool(later <= end - begin + 2 * SLOW_CROSSING)
