"""Joints in parallel: their guards are the same function, so those that slip stop at one event node.

Which of them are released together is decided by `together`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from periodic.events.modes import column, sides, sticks, surface_of
from periodic.events.rewrites.sites import Added, Site, apart
from periodic.events.rewrites.table import GRAZING_SLIDING, LIMIT_GRAZING
from periodic.events.switchpolynomials import Extremum
from periodic.events.thresholds import BESIDE_EXTREMUM
from periodic.events.twinguards import held_at, held_in, held_throughout, holding, twins
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System


def with_twins(system: System, orbit: Orbit, site: Site) -> Site:
    """Return a site where a joint begins to slip, or to be held, with its twins at the same event nodes.

    A slider that begins to slip where the strain turns stops where the others do. Where the strain turns back
    for a while, all sliders that slip are held together, and released together.
    """
    assert isinstance(site.at, Extremum)
    guard = surface_of(system, site.switch).switch
    alike, stopping = _alike(system, orbit, guard, site.at.interval)
    both = {k: sign for k, sign in alike.items() if k != guard}
    if site.row is GRAZING_SLIDING:
        return _grazing(system, orbit, site, guard, both) if both else site
    if surface_of(system, guard).kind != Kind.SLIDER:
        return site
    turn = _turn(system, orbit, site.at, both | stopping)
    if turn is None:
        return site
    joined = replace(orbit.mesh.events[turn], modes=(*orbit.mesh.events[turn].modes, (guard, STUCK)))
    release = replace(site.added[0], phase=float(orbit.phases[turn]))
    return replace(site, added=(release,), replaced=((turn, joined),))


def _alike(system: System, orbit: Orbit, guard: int, interval: int) -> tuple[dict[int, int], dict[int, int]]:
    """The twins of a guard in an interval, with their signs, and friction that stops its motion there.

    The strain of a slider is greatest from where friction stops the motion.
    """
    held = held_in(system, orbit, interval)
    stopping = holding(system, guard, held)
    return twins(system, guard, [k for k in held if k not in stopping]), stopping


def parted(
    system: System, orbit: Orbit, event: EventNode, node: int, guard: int
) -> tuple[tuple[int, int], ...]:
    """Return the modes that change at an event node only because friction at a guard holds there."""
    always = held_throughout(system, orbit.mesh.modes)
    held = held_at(system, orbit.mesh.events, node, always)
    own = surface_of(system, event.switch).switch
    alone = twins(system, own, [k for k in held if k != guard])
    both = twins(system, own, [*held, guard])
    return tuple(pair for pair in event.modes if pair[0] in both and pair[0] not in alone)


def by_itself(
    system: System, orbit: Orbit, node: int, guard: int, pairs: Sequence[tuple[int, int]]
) -> EventNode:
    """Return the event node of what changes at another one only because friction at a guard holds there."""
    event = orbit.mesh.events[node]
    held = [*held_at(system, orbit.mesh.events, node, held_throughout(system, orbit.mesh.modes)), guard]
    alike = twins(system, event.switch, held)
    first = next((k for k, _ in pairs if surface_of(system, k).kind == Kind.SLIDING), pairs[0][0])
    stops = tuple((k, mode) for k, mode in pairs if mode == STUCK)
    return EventNode(first, alike[first] * event.direction, modes=stops)


def slipping_together(system: System, orbit: Orbit, sites: Sequence[Site]) -> list[Site]:
    """Return sites with those as one at which sliders of one guard reach their limits at one phase.

    They were held from one turn of the strain on, so that all of them slip where it comes back to that.
    """
    found = list[Site]()
    for site in sites:
        each = (k for k, other in enumerate(found) if _one_slip(system, orbit, other, site))
        k = next(each, None)
        if k is None:
            found.append(site)
        else:
            found[k] = _both(system, found[k], site)
    return found


def _one_slip(system: System, orbit: Orbit, one: Site, other: Site) -> bool:
    """Whether two sliders slip at once, and stop at event nodes of their own or at one that there is.

    If that is where friction stops their strain, it is greatest anywhere from there on until it is let go.
    """
    if not (one.row is other.row is LIMIT_GRAZING) or len(one.added) != len(other.added):
        return False
    assert isinstance(one.at, Extremum)
    assert isinstance(other.at, Extremum)
    guards = [surface_of(system, site.switch).switch for site in (one, other)]
    alike, _ = _alike(system, orbit, guards[0], one.at.interval)
    turn, same = ([node for node, _ in site.replaced] for site in (one, other))
    at_once = bool(turn) or apart(one.at.phase, other.at.phase, orbit) < BESIDE_EXTREMUM
    return guards[1] in alike and turn == same and at_once


def _both(system: System, one: Site, other: Site) -> Site:
    """The site at which the sliders of two slip and are held again at the same event nodes."""
    release, slips = one.added[0], other.added[0].event
    guard = surface_of(system, slips.switch).switch
    first = _with(release, (guard, slips.direction), *slips.modes)
    stops = [pair for pair in _stops(other) if pair not in _stops(one)]
    last = [_with(stop, *stops) for stop in one.added[1:]]
    turn = tuple((node, replace(event, modes=(*event.modes, *stops))) for node, event in one.replaced)
    return replace(one, added=(first, *last), replaced=turn)


def _with(added: Added, *modes: tuple[int, int]) -> Added:
    """The same with further modes."""
    return replace(added, event=replace(added.event, modes=(*added.event.modes, *modes)))


def _stops(site: Site) -> tuple[tuple[int, int], ...]:
    """The modes at the event node at which a site's slider stops."""
    return site.added[1].event.modes if len(site.added) > 1 else site.replaced[0][1].modes


def _turn(system: System, orbit: Orbit, at: Extremum, both: dict[int, int]) -> int | None:
    """The event node at which twins stop as the strain turns: at that phase, or before, held by friction."""
    for j, event in enumerate(orbit.mesh.events):
        if event.switch not in both:
            continue
        if apart(float(orbit.phases[j]), at.phase, orbit) < BESIDE_EXTREMUM:
            return j
        release = sticks(system, orbit.mesh, event.switch, j)
        if release is not None and surface_of(system, event.switch).kind == Kind.SLIDING:
            length, since = (
                float((phase - orbit.phases[j]) % orbit.mesh.period)
                for phase in (float(orbit.phases[release]) + BESIDE_EXTREMUM, at.phase)
            )
            if since <= length:
                return j
    return None


def leading(system: System, orbit: Orbit, surface: SurfaceLike, interval: int) -> tuple[SurfaceLike, int]:
    """Return the surface whose row grazing-sliding of a surface is, and the sign between their guards.

    It is dry friction in parallel with sliders, where there is any, else the surface itself.
    """
    both = twins(system, surface.switch, held_in(system, orbit, interval))
    each = ((surface_of(system, k), sign) for k, sign in both.items())
    return next((own for own in each if own[0].kind == Kind.SLIDING), (surface, 1))


def _grazing(system: System, orbit: Orbit, site: Site, guard: int, both: dict[int, int]) -> Site:
    """The site at which all joints that slip about the turn are held for a while."""
    assert isinstance(site.at, Extremum)
    stop, release = site.added
    way = release.event.direction
    ways = {k: sign * way for k, sign in both.items()}
    modes = sides(system, orbit)[site.at.interval]
    slipping = [k for k in both if modes[column(system, k)] == ways[k]]
    stuck = tuple((k, STUCK) for k in slipping)
    onward = tuple((k, ways[k]) for k in slipping)
    first = Added(replace(stop.event, modes=(*stop.event.modes, *stuck)), stop.phase, stop.part)
    last = Added(replace(release.event, modes=onward), release.phase, release.part)
    return replace(site, added=(first, last))
