"""Events of friction that meet an impact at which the sliding speed jumps.

Just before an impact friction may reverse, stick or be released. Just after the impact it may reverse or
stick, where it slides against a belt or another mass. Where such an event meets the impact, the impact
replaces it: the impact leads from the mode before both to the mode after both. A stop after the impact cannot
be replaced; it is reached from the other side instead.
"""

from __future__ import annotations

from dataclasses import replace

from periodic.events.impactmodes import thrown
from periodic.events.impacts import tied
from periodic.events.modes import mode_after, modes_in, sides, surface_of
from periodic.events.rates import before
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import (
    AFTER_IMPACT,
    BEFORE_IMPACT,
    CAUGHT,
    RELEASE_AT_IMPACT,
    Row,
)
from periodic.events.sideconditions import Length, Limit
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import AT_LEVEL
from periodic.events.violations import Violation, largest
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import STUCK, Kind, SurfaceLike, System, guards


def meeting(system: System, orbit: Orbit, segment: int) -> Row | None:
    """Return the row of a segment between an impact and an event of a surface whose guard jumps there."""
    i, j, impacts = segment, (segment + 1) % len(orbit.phases), tied(system, orbit)
    if (i in impacts) == (j in impacts):
        return None
    impact, own = (i, j) if i in impacts else (j, i)
    event = orbit.mesh.events[own]
    surface = surface_of(system, event.switch)
    if surface.releases is None or any(k != surface.switch for k, _ in event.modes):
        return None
    if impact not in thrown(system, orbit, surface):
        return None
    if impact == j:
        return BEFORE_IMPACT if event.switch == surface.switch else RELEASE_AT_IMPACT
    if event.switch != surface.switch or surface.kind != Kind.SLIDING:
        return None
    return CAUGHT if mode_after(surface, event) == STUCK else AFTER_IMPACT


def met(system: System, orbit: Orbit, row: Row, segment: int) -> Site:
    """Return the site where the event nodes at the ends of a segment meet."""
    i, j = segment, (segment + 1) % len(orbit.phases)
    first, second = orbit.mesh.events[i], orbit.mesh.events[j]
    if row in (BEFORE_IMPACT, RELEASE_AT_IMPACT):
        surface = surface_of(system, first.switch)
        earlier = -first.direction if first.switch == surface.switch else STUCK
        later = mode_after(surface, second) or mode_after(surface, first)
        assert later is not None
        changed = leading(second, surface, earlier, later)
        held = Limit(j, first.switch, -first.direction, arriving=True)
        return Site(row, first.switch, j, held, 0.0, (), (i,), ((j, changed),))
    surface, way = surface_of(system, second.switch), second.direction
    earlier = _mode_before(system, orbit, surface, i)
    if row is AFTER_IMPACT:
        changed = leading(first, surface, earlier, way)
        return Site(row, second.switch, i, Limit(i, second.switch, way), 0.0, (), (j,), ((i, changed),))
    changed, stop = leading(first, surface, earlier, way), replace(second, direction=-way)
    length = float(orbit.mesh.segment_lengths(orbit.phases)[i])
    return Site(row, second.switch, i, Length(i, length), 0.0, (), (), ((i, changed), (j, stop)))


def leading(impact: EventNode, surface: SurfaceLike, earlier: int, later: int) -> EventNode:
    """Return an impact that takes a surface from one mode to another."""
    others = impact.modes_beside(surface.switch)
    own = ((surface.switch, later),) if later != earlier else ()
    return replace(impact, modes=(*own, *others))


def _mode_before(system: System, orbit: Orbit, surface: SurfaceLike, node: int) -> int:
    assert surface.column is not None
    mode = int(sides(system, orbit)[before(orbit, node)[0], surface.column])
    return mode or SwitchPolynomials(system, orbit).side(surface.switch)


def begun(system: System, orbit: Orbit, surface: SurfaceLike, limit: Violation) -> Site | None:
    """Return the site at an impact where an event before or after it begins.

    None where the guard comes from its level: there an event ends instead.
    """
    assert isinstance(limit.at, int)
    return (_before if limit.arriving else _after)(system, orbit, surface, limit, limit.at)


def _before(system: System, orbit: Orbit, surface: SurfaceLike, limit: Violation, node: int) -> Site | None:
    """The site where friction reverses, sticks or is released just before an impact; None as in `begun`."""
    k, way, event = surface.switch, -limit.side, orbit.mesh.events[node]
    earlier = _mode_before(system, orbit, surface, node)
    later = mode_after(surface, event) or earlier
    modes: tuple[tuple[int, int], ...] = ()
    row = RELEASE_AT_IMPACT
    if limit.switch == k:
        interval, x, _ = before(orbit, node)
        leaving, entering = _slopes(system, orbit, surface, node, x, interval, limit.side)
        if way * leaving <= 0:
            return None
        modes, row = ((k, STUCK),) if way * entering < 0 else (), BEFORE_IMPACT
    new = EventNode(limit.switch, way, modes=modes)
    changed = leading(event, surface, STUCK if modes else way, later)
    held = Limit(node, limit.switch, limit.side, _left(system, orbit, limit.switch), arriving=True)
    added = (Added(new, float(orbit.phases[node]), -1.0),)
    return Site(row, limit.switch, node, held, -limit.depth, added, (), ((node, changed),))


def _after(system: System, orbit: Orbit, surface: SurfaceLike, limit: Violation, node: int) -> Site | None:
    """The site where friction reverses just after an impact; None as in `begun`."""
    k, way, event = surface.switch, limit.side, orbit.mesh.events[node]
    start = int(orbit.mesh.starts[node])
    if way * _slopes(system, orbit, surface, node, orbit.nodes[start][None], start, way)[0] <= 0:
        return None
    changed = leading(event, surface, _mode_before(system, orbit, surface, node), -way)
    held = Limit(node, k, way, _left(system, orbit, k))
    added = (Added(EventNode(k, way), float(orbit.phases[node]), 1.0),)
    return Site(AFTER_IMPACT, k, node, held, -limit.depth, added, (), ((node, changed),))


def _slopes(
    system: System, orbit: Orbit, surface: SurfaceLike, node: int, state: Array, interval: int, side: int
) -> tuple[float, float]:
    """ds/dtau of a guard at an impact by the equations of one side, and of the other."""
    assert surface.releases is not None
    modes, phase = modes_in(system, orbit, interval), orbit.phases[node : node + 1]
    up, down = guards(system, state, phase, orbit.parameter, modes)[0, list(surface.releases)]
    return (float(up), float(down)) if side > 0 else (float(down), float(up))


def _left(system: System, orbit: Orbit, switch: int) -> float:
    return AT_LEVEL * largest(SwitchPolynomials(system, orbit), switch)
