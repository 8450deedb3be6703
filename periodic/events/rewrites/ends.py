"""Sites where a part of the word of an orbit ends: the rows of the table read from right to left."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from periodic.correction.condition import SideCondition
from periodic.events.impacts import tied
from periodic.events.modes import group, mode_after, relays, release, returns, surface_of, torn
from periodic.events.rewrites.corners import corner
from periodic.events.rewrites.intersections import at_intersection, intersections
from periodic.events.rewrites.meetings import meeting, met
from periodic.events.rewrites.merging import merged, merging
from periodic.events.rewrites.reversals import reversals, short_of
from periodic.events.rewrites.sites import Site
from periodic.events.rewrites.steadyforce import slipping_on, stopped_again
from periodic.events.rewrites.strikes import last_impact
from periodic.events.rewrites.swaps import swapped, swaps
from periodic.events.rewrites.table import (
    ADDING_ABOUT,
    ADDING_SLIDING,
    AFTER_IMPACT,
    BEFORE_IMPACT,
    CAUGHT,
    CORNER,
    CROSSING_SLIDING,
    FIRST_DEPARTURES,
    FIRST_SLIPS,
    GRAZING,
    GRAZING_SLIDING,
    IMPACT,
    LIMIT_GRAZING,
    MERGING,
    RELAY,
    RELEASE_AT_IMPACT,
    REVERSAL,
    SWAP,
    SWITCHING_ABOUT,
    SWITCHING_SLIDING,
    TEARING,
    Row,
)
from periodic.events.rewrites.together import without
from periodic.events.rewrites.tornoff import thrown_back, torn_off
from periodic.events.sideconditions import Clearance, Length, Lengths, Limit, Speed, speed
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import BESIDE_EXTREMUM, SHALLOW
from periodic.events.violations import largest
from periodic.orbit.mesh import INSIDE, EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System


@dataclass(frozen=True)
class Excursion:
    """A part of the word that may end: its row, the event node at which it begins, and its size's measure.

    unit: of the row's sizes, 1 rad or the largest value of the switch of an impact or a relay. segments:
    those whose lengths together are its size, by default the one that begins at `index`.
    """

    row: Row
    index: int
    unit: float = 1.0

    segments: tuple[int, ...] = ()

    def size(self, system: System, orbit: Orbit) -> float:
        """Its length, or the speed with which its switch arrives."""
        if self.row.by_speed:
            return speed(system, orbit, self.index)
        lengths = orbit.mesh.segment_lengths(orbit.phases)
        return float(lengths[list(self.segments or (self.index,))].sum())

    def held(self, size: float) -> SideCondition:
        """The side condition that keeps it at a size, in rad or as a speed."""
        if self.row.by_speed:
            return Speed(self.index, size)
        return Lengths(self.segments, size) if self.segments else Length(self.index, size)


def excursions(system: System, orbit: Orbit) -> Iterator[Excursion]:
    """Yield all that may end on an orbit."""
    events, k, own = orbit.mesh.events, len(orbit.phases), returns(system)
    about = {i for reversal in reversals(system, orbit) for i in (reversal.begin, reversal.inside[-1])}
    for reversal in reversals(system, orbit):
        yield Excursion(REVERSAL, reversal.begin)
    switched = [i for i, event in enumerate(events) if event.switch in relays(system)]
    struck = [i for i in tied(system, orbit) if (events[i].switch, STUCK) not in events[i].modes]
    for row, i in [*((IMPACT, i) for i in struck), *((RELAY, i) for i in switched)]:
        dense = SwitchPolynomials(system, orbit)
        yield Excursion(row, i, float(np.abs(dense.knots[:, :, events[i].switch]).max()))
    for i, first in enumerate(events):
        second = events[(i + 1) % k]
        if first.switch == second.switch in own and i not in about:
            yield Excursion(GRAZING, i)
        both = only_slips(system, orbit, i)
        if both and both[0].index == i:
            row = FIRST_DEPARTURES if surface_of(system, events[i].switch).place is None else FIRST_SLIPS
            yield Excursion(row, i, segments=tuple(j for slip in both for j in slip.segments))
        between = _held(system, orbit, i)
        if between is not None and not both:
            yield Excursion(between, i)
        inner = slip_about(system, orbit, i)
        if inner and not both:
            yield Excursion(ADDING_ABOUT, i, segments=(i, inner[-1]))
        if thrown := thrown_back(system, orbit, i):
            yield Excursion(TEARING, i, segments=(i, *thrown))
        if corner(system, orbit, i) is not None and i not in about:
            yield Excursion(CORNER, i)
        if i in about:
            continue
        meets, merges = meeting(system, orbit, i), merging(system, orbit, i)
        if meets is not None:
            yield Excursion(meets, i)
        elif merges is not None:
            yield Excursion(MERGING, i, segments=merges.segments)
        elif swaps(system, orbit, i) or at_intersection(system, orbit, i):
            turned = slipping_on(system, orbit, i) is not None
            yield Excursion(SWITCHING_ABOUT if turned else SWAP, i)


def ends(system: System, orbit: Orbit, excursion: Excursion) -> list[Site]:
    """Return the sites at which an excursion may end: nodes removed, and the condition there."""
    if excursion.row is IMPACT:
        return last_impact(system, orbit, excursion.index)
    if excursion.row in (FIRST_SLIPS, FIRST_DEPARTURES):
        return _first_slips(system, orbit, excursion.row, excursion.index)
    if excursion.row is RELAY:
        i = excursion.index
        return [Site(RELAY, orbit.mesh.events[i].switch, i, Speed(i, 0.0), 0.0)]
    if excursion.row in (SWAP, SWITCHING_ABOUT):  # another orbit may have shown which of them it is
        turned = slipping_on(system, orbit, excursion.index) is not None
        if turned:
            return [stopped_again(system, orbit, excursion.index)]
        return intersections(system, orbit, excursion.index) or [swapped(system, orbit, excursion.index)]
    if excursion.row is MERGING:
        merges = list(merged(system, orbit, excursion.index))
        return [*merges, *intersections(system, orbit, excursion.index)]
    if excursion.row in (BEFORE_IMPACT, AFTER_IMPACT, RELEASE_AT_IMPACT, CAUGHT):
        return [met(system, orbit, excursion.row, excursion.index)]
    return [_end(system, orbit, excursion.row, excursion.index)]


def _end(system: System, orbit: Orbit, row: Row, i: int) -> Site:
    if row is GRAZING:
        return _pair(orbit, row, (i, (i + 1) % len(orbit.phases)), i)
    if row is CORNER:
        around = corner(system, orbit, i)
        assert around is not None
        return _pair(orbit, row, around, i)
    if row is REVERSAL:
        return _reversal(system, orbit, i)
    if row is ADDING_ABOUT:
        return _about(system, orbit, i)
    if row is TEARING:
        return torn_off(system, orbit, i)
    return _vanishing(system, orbit, row, i)


def _pair(orbit: Orbit, row: Row, removed: tuple[int, int], segment: int) -> Site:
    """An excursion between two event nodes, which grazes at the middle of a segment."""
    last = orbit.mesh.events[removed[1]]
    held = Clearance(last.switch, last.direction, _middle(orbit, segment))
    return Site(row, last.switch, segment, held, 0.0, removed=removed)


def _middle(orbit: Orbit, segment: int) -> float:
    length = float(orbit.mesh.segment_lengths(orbit.phases)[segment])
    return float(orbit.phases[segment]) + length / 2


def _reversal(system: System, orbit: Orbit, begin: int) -> Site:
    """An excursion about a reversal of friction."""
    reversal = next(reversal for reversal in reversals(system, orbit) if reversal.begin == begin)
    first, at = orbit.mesh.events[begin], reversal.inside[0]
    left = short_of(system, orbit, first.switch, float(orbit.phases[at]))
    held = Limit(at, first.switch, -first.direction, left)
    return Site(REVERSAL, first.switch, at, held, 0.0, removed=(reversal.begin, reversal.end))


def slip_about(system: System, orbit: Orbit, begin: int) -> tuple[int, ...]:
    """Return the event nodes of other surfaces in a slip that begins at one; () if there are none or many."""
    events, k = orbit.mesh.events, len(orbit.phases)
    surface = surface_of(system, events[begin].switch)
    if surface.releases is None or events[begin].switch == surface.switch:
        return ()
    inner = list[int]()
    for m in range(1, min(k, INSIDE + 2)):
        j = (begin + m) % k
        mode = mode_after(surface, events[j])
        if mode is not None:
            ends = mode == STUCK and events[j].switch == surface.switch
            return tuple(inner) if ends and inner and _shallow(system, orbit, begin, j) else ()
        inner.append(j)
    return ()


def _shallow(system: System, orbit: Orbit, begin: int, end: int) -> bool:
    """Whether the force on a joint hardly exceeds its limit from its release to another event node."""
    event, mesh = orbit.mesh.events[begin], orbit.mesh
    dense = SwitchPolynomials(system, orbit)
    first, last = int(mesh.starts[begin]), int(mesh.starts[end])
    inside = np.arange(first, last if last > first else last + mesh.ntst) % mesh.ntst
    excess = float((event.direction * dense.knots[inside][:, :, event.switch]).max())
    return excess < SHALLOW * largest(dense, event.switch)


def _about(system: System, orbit: Orbit, begin: int) -> Site:
    """A slip about events at other surfaces, where the joint is pulled most."""
    inner, first = slip_about(system, orbit, begin), orbit.mesh.events[begin]
    events, end = orbit.mesh.events, (inner[-1] + 1) % len(orbit.phases)
    held = Limit(inner[0], first.switch, -first.direction)
    others = events[end].modes_beside(surface_of(system, first.switch).switch)
    event = events[inner[0]]
    joined = ((inner[0], replace(event, modes=(*event.modes, *others))),) if others else ()
    return Site(ADDING_ABOUT, first.switch, inner[0], held, 0.0, (), (begin, end), joined)


def only_slips(system: System, orbit: Orbit, begin: int) -> list[Excursion]:
    """Return all slips of a joint if they end at once, and one of them begins at an event; else [].

    A joint with a place slips there and back. One without a place slides all along: its slips are alike.
    """
    surface = surface_of(system, orbit.mesh.events[begin].switch)
    if surface.releases is None or (surface.place is None and not surface.alone):
        return []
    own = group(system, orbit.mesh, surface.switch)
    begun = [i for i in own if mode_after(surface, orbit.mesh.events[i]) != STUCK]
    ways = {orbit.mesh.events[i].direction for i in begun}
    if begin not in begun or len(own) != 2 * len(begun) or len(ways) != len(begun):
        return []
    found = [slip for slip in (_slip(system, orbit, i) for i in begun) if slip is not None]
    sizes = [slip.size(system, orbit) for slip in found]
    alike = bool(found) and np.ptp(sizes) < BESIDE_EXTREMUM * max(sizes)
    at_once = alike if surface.place is None else len(begun) == 2
    return found if len(found) == len(begun) and at_once else []


def _slip(system: System, orbit: Orbit, begin: int) -> Excursion | None:
    """The slip that begins at an event node and may end, by itself or about events at other surfaces."""
    row = _held(system, orbit, begin)
    if row in (ADDING_SLIDING, LIMIT_GRAZING):
        return Excursion(row, begin, segments=(begin,))
    inner = slip_about(system, orbit, begin)
    return Excursion(ADDING_ABOUT, begin, segments=(begin, inner[-1])) if inner else None


def _first_slips(system: System, orbit: Orbit, row: Row, begin: int) -> list[Site]:
    """The sites of a joint's only slips: without them it is held all along, at its limit where one was."""
    each = [_end(system, orbit, slip.row, slip.index) for slip in only_slips(system, orbit, begin)]
    removed = tuple(j for site in each for j in site.removed)
    replaced = tuple(pair for site in each for pair in site.replaced)
    return [replace(site, row=row, removed=removed, replaced=replaced) for site in each]


def _surface(system: System, orbit: Orbit, segment: int) -> SurfaceLike | None:
    """The surface that may hold motions and that both event nodes of a segment change, if any."""
    i, j = segment, (segment + 1) % len(orbit.phases)
    if i == j:
        return None
    surface = surface_of(system, orbit.mesh.events[i].switch)
    second = orbit.mesh.events[j]
    other = surface_of(system, second.switch)
    passes = other.kind == Kind.IMPACT or torn(system, surface, second)
    ends = mode_after(surface, second) is not None and not passes
    return surface if surface.releases is not None and ends else None


def _held(system: System, orbit: Orbit, segment: int) -> Row | None:
    """The row of the segment between an event node and the next one; None where it cannot vanish."""
    surface = _surface(system, orbit, segment)
    if surface is None:
        return None
    first, second = orbit.mesh.events[segment], orbit.mesh.events[(segment + 1) % len(orbit.phases)]
    stuck, then = (mode_after(surface, event) == STUCK for event in (first, second))
    if surface.kind == Kind.SLIDER and stuck and second.direction != first.direction:
        return GRAZING_SLIDING
    if surface.kind == Kind.SLIDER:
        return LIMIT_GRAZING if then and not stuck else None
    if stuck:
        return CROSSING_SLIDING if second.direction == first.direction else GRAZING_SLIDING
    if then:
        return ADDING_SLIDING if first.switch != surface.switch else SWITCHING_SLIDING
    return None


def _vanishing(system: System, orbit: Orbit, row: Row, i: int) -> Site:
    """A segment of sticking or slipping."""
    surface = _surface(system, orbit, i)
    assert surface is not None and surface.releases is not None
    j, guard = (i + 1) % len(orbit.phases), surface.switch
    first, second = orbit.mesh.events[i], orbit.mesh.events[j]
    onward = release(surface, first.direction)
    others = first.modes_beside(guard)
    if row is CROSSING_SLIDING:
        passes = replace(first, modes=others)
        return Site(row, onward, i, Limit(i, onward, first.direction), 0.0, (), (j,), ((i, passes),))
    if row is SWITCHING_SLIDING:
        stops = replace(first, modes=((guard, STUCK), *others))
        return Site(row, onward, i, Limit(i, onward, -first.direction), 0.0, (), (j,), ((i, stops),))
    if row is GRAZING_SLIDING:
        held = Clearance(guard, second.direction, _middle(orbit, i))
        return Site(row, guard, i, held, 0.0, removed=(i, j))
    held = Clearance(first.switch, -first.direction, _middle(orbit, i))
    others_stop = _others_stop(system, first, second, guard)
    if others_stop is not None:
        return Site(row, first.switch, i, held, 0.0, (), (i,), ((j, others_stop),))
    return Site(row, first.switch, i, held, 0.0, removed=(i, j))


def _others_stop(system: System, first: EventNode, second: EventNode, guard: int) -> EventNode | None:
    """The second event node of a slip without what the first one lets go; None where nothing else stops."""
    released = (switch for switch, mode in first.modes_beside(guard) if mode != STUCK)
    left: EventNode | None = second
    for switch in (guard, *released):
        if left is not None and mode_after(surface_of(system, switch), left) == STUCK:
            left = without(system, left, switch)
    return left


def longest_slip(system: System, orbit: Orbit, switch: int) -> float:
    """Return the length of the longest slip at a guard."""
    own, surface = group(system, orbit.mesh, switch), surface_of(system, switch)
    pairs = zip(own, [*own[1:], *own[:1]], strict=True)
    slips = [(i, j) for i, j in pairs if mode_after(surface, orbit.mesh.events[i]) != STUCK]
    return max((float((orbit.phases[j] - orbit.phases[i]) % orbit.mesh.period) for i, j in slips), default=0)
