"""Slips that begin before an event at which a jump of the force tears the joint off, the other way.

Friction c between two masses holds, and at a, where one of them turns, its force jumps: c is torn off to one
side. If c reaches its limit on the other side before that, it slips there for a time L, at a rate that grows
to r' L, so that its guard is r' L^2 / 2 away at a; thrown back it passes 0 soon after. What passed 0 with a,
as c held, does so by itself then, at b:

    (a b -c)    and    c a b -c    or    c b a -c

L is as long as c would be past its limit at a, over r'. So is the slip where it is torn off the same way, but
then it does not pass 0 again.
"""

from __future__ import annotations

from dataclasses import replace

from periodic.events.modes import mode_after, surface_of
from periodic.events.rewrites.intersections import joined
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import TEARING
from periodic.events.rewrites.twins import by_itself, parted
from periodic.events.sideconditions import Limit
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import AT_LEVEL
from periodic.events.twinguards import holding
from periodic.events.violations import largest
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import Kind, SurfaceLike, System


def before_torn(
    system: System, orbit: Orbit, surface: SurfaceLike, node: int, switch: int, side: int, value: float
) -> Site:
    """Return the site of a slip that begins before an event node at which the joint is torn off."""
    event, phase, guard = orbit.mesh.events[node], float(orbit.phases[node]), surface.switch
    others = parted(system, orbit, event, node, guard)
    kept = tuple(pair for pair in event.modes if pair not in others and pair[0] != guard)
    added, back = [Added(EventNode(switch, -side), phase, -1.0)], _back(system, orbit, surface, node, switch)
    if others:  # halfway, as far as the order goes
        other = by_itself(system, orbit, node, guard, others)
        signs = holding(system, guard, [event.switch, other.switch])
        first = -side * signs.get(other.switch, 1) == other.direction
        added.append(Added(other, phase, -back / 2 if first else back / 2, 2.0))
    if mode_after(surface, event) == side:
        added.append(Added(EventNode(guard, side), phase, back, 2.0))
    assert surface.releases is not None
    left = AT_LEVEL * largest(SwitchPolynomials(system, orbit), *surface.releases)
    held, rest = Limit(node, switch, side, left), replace(event, modes=kept)
    return Site(TEARING, switch, node, held, value, tuple(added), (), ((node, rest),))


def _back(system: System, orbit: Orbit, surface: SurfaceLike, node: int, switch: int) -> float:
    """How long after the event the guard is 0 again, over L^2: r' / 2 over its rate then."""
    dense, start = SwitchPolynomials(system, orbit), int(orbit.mesh.starts[node])
    scheme, width = orbit.mesh.scheme, orbit.grid.width[start - 1]
    slope = scheme.end @ (scheme.differentiation @ dense.knots[start - 1, :, switch]) / width
    assert surface.releases is not None
    (other,) = {*surface.releases} - {switch}
    rate = float(abs(dense.knots[start, 0, other]))
    return float(abs(slope)) / (2 * rate) if rate else 1.0


def thrown_back(system: System, orbit: Orbit, begin: int) -> tuple[int, ...]:
    """Return the event nodes in such a slip that begins at one and is thrown back; () if it is none.

    They are one or two at which guards pass 0, friction at one of them, that the joint held together.
    """
    events, count = orbit.mesh.events, len(orbit.phases)
    surface = surface_of(system, events[begin].switch)
    if surface.kind != Kind.SLIDING or events[begin].switch == surface.switch:
        return ()
    back = next((m for m in (2, 3) if mode_after(surface, events[(begin + m) % count]) is not None), 0)
    inner = tuple((begin + m) % count for m in range(1, back))
    last, guards = events[(begin + back) % count], [events[j].switch for j in inner]
    passes = last.switch == surface.switch and mode_after(surface, last) == -events[begin].direction
    if not passes or back >= count or surface.switch in guards:
        return ()
    own = [surface_of(system, k) for k in guards]
    plain = all(each.releases is not None and each.switch == k for each, k in zip(own, guards, strict=True))
    jumps = any(each.kind == Kind.SLIDING for each in own)
    together = len(guards) == 1 or bool(holding(system, surface.switch, guards))
    return inner if plain and jumps and together else ()


def torn_off(system: System, orbit: Orbit, begin: int) -> Site:
    """Return the site where such a slip ends: the joint is held until it is torn off."""
    events, inner = orbit.mesh.events, thrown_back(system, orbit, begin)
    end, first = (inner[-1] + 1) % len(events), events[begin]
    guard = surface_of(system, first.switch).switch
    both, held = joined([events[j] for j in inner]), Limit(inner[0], first.switch, -first.direction)
    assert both is not None
    torn = replace(
        both, modes=(*both.modes, (guard, events[end].direction), *events[end].modes_beside(guard))
    )
    return Site(TEARING, first.switch, inner[0], held, 0.0, (), (begin, *inner[1:], end), ((inner[0], torn),))
