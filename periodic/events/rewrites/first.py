"""The first rewrite on the way from one orbit to another on the same mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.correction.change import Change
from periodic.events.modes import held_all_along, of_held, sliding, surface_of
from periodic.events.rewrites.ends import Excursion, ends, excursions, longest_slip
from periodic.events.rewrites.grazingonsets import begins, beside_node
from periodic.events.rewrites.letgo import slip_that_joins
from periodic.events.rewrites.rewrite import Begins, Ends
from periodic.events.rewrites.sites import Site
from periodic.events.rewrites.strained import strained_away
from periodic.events.rewrites.table import (
    ADDING_ABOUT,
    ADDING_SLIDING,
    CORNER,
    GRAZING,
    IMPACT,
    LIMIT_GRAZING,
    RELAY,
    REVERSAL,
    ROOT,
    SHORT,
    SWAP,
    TEARING,
)
from periodic.events.rewrites.wholeorbit import WholeOrbit, whole_orbit
from periodic.events.sideconditions import Clearance
from periodic.events.switchpolynomials import Extremum, SwitchPolynomials
from periodic.events.thresholds import AT_LEVEL, LONGEST, VANISHING
from periodic.events.violations import Breach, Violation, between_nodes, largest, limits
from periodic.orbit.orbit import Orbit
from periodic.system import Kind, System

ENDS_BELOW = SHORT[-1]
"""Length (rad) of an excursion below which a grazing foreseen within it may be its end."""


def first_change(
    system: System, before: Orbit, after: Orbit, shortest: float, ends_below: float = ENDS_BELOW
) -> Change | None:
    """Return the first rewrite between two orbits on one mesh, where there is one.

    `after` may be a guess, its event nodes out of order. Beginnings come before ends, as orbits past them on
    this mesh violate their word. A grazing that may be the end of an excursion is returned with both.
    """
    if not system.switches:
        return None
    ending, begun = _joined(system, before, after, _alone(_endings(system, before, after, shortest)))
    found = [*ending, *begun, *_onsets(system, before, after, ending, shortest)]
    first = min(found, key=lambda change: (not change.strict, change.part), default=None)
    if isinstance(first, Begins) and first.site.row is GRAZING:
        return _or_end(first, before, after, ending, ends_below)
    return first


def _or_end(begins: Begins, before: Orbit, after: Orbit, ending: list[Ends], ends_below: float) -> Begins:
    """The grazing; if it may be the end of an excursion, with that end as `otherwise`.

    In a guess the depth of an excursion vanishes before its length.
    """
    each = [end for end in ending if end.site.row is GRAZING]
    end = min(each, key=lambda end: end.part, default=None)
    if end is None or end.site.switch != begins.site.switch:
        return begins
    i, at = end.excursion.index, begins.site.at
    assert isinstance(at, Extremum)
    now, then = (o.mesh.segment_lengths(o.phases)[i] for o in (before, after))
    inside = np.mod(at.phase - after.phases[i], after.mesh.period) <= then
    return replace(begins, otherwise=end) if inside and now < ends_below else begins


def _alone(ending: list[Ends]) -> list[Ends]:
    """The ends, without swaps within slips that end as a whole."""
    whole = {j for end in ending if end.site.row in (ADDING_ABOUT, TEARING) for j in end.excursion.segments}
    return [end for end in ending if end.site.row is not SWAP or end.excursion.index not in whole]


def _joined(
    system: System, before: Orbit, after: Orbit, ending: list[Ends]
) -> tuple[list[Ends], list[Begins]]:
    """The ends, and what begins where releases come together; these are no ends."""
    found, begun = list[Ends](), list[Begins]()
    for end in ending:
        slip = slip_that_joins(system, before, end.excursion)
        if slip is None:
            found.append(end)
        elif slip.added and (part := _part_to(system, before, after, slip)) is not None:
            begun.append(Begins(system, slip, part, end.shortest))
    return found, begun


def _part_to(system: System, before: Orbit, after: Orbit, slip: Site) -> float | None:
    """The part of the way to an orbit at which a slip begins; None where it does not on the way."""
    each = [SwitchPolynomials(system, orbit) for orbit in (before, after)]
    assert isinstance(slip.held, Clearance)
    if not all(dense.minima(slip.switch, slip.held.side) for dense in each):
        return None
    now, then = (slip.held.linearise(system, orbit, ()).value for orbit in (before, after))
    past = AT_LEVEL * largest(each[0], slip.switch)
    return max(now, 0.0) / (now - then) if then < -past < now else None


def _onsets(
    system: System, before: Orbit, after: Orbit, ending: list[Ends], shortest: float
) -> list[Begins | WholeOrbit]:
    """What begins between two orbits."""
    if not bool((after.mesh.segment_lengths(after.phases) > 0).all()):
        return []
    held = of_held(system)
    slips = any(end.site.row is not SWAP and sliding(system, end.site.switch) is not None for end in ending)
    dense = SwitchPolynomials(system, before)
    loose = [k for k in held if not held_all_along(before.mesh, surface_of(system, k))]
    resting = {jump for jump in loose if not dense.knots[:, :, jump].any()}
    found = list[Begins | WholeOrbit]()
    for violation in between_nodes(system, after, before):
        jump = sliding(system, violation.switch)
        if violation.breach is Breach.THROUGH or (jump is not None and (slips or jump in resting)):
            continue
        part = _share(system, before, violation)
        at, surface = violation.at, surface_of(system, violation.switch)
        slider = surface.kind == Kind.SLIDER and not held_all_along(before.mesh, surface)
        if slider and violation.switch != jump and part * abs(violation.depth) <= AT_LEVEL:
            continue  # it stops at its limit there; the turn of its strain decides what follows
        if isinstance(at, Extremum) and at.switch != jump and strained_away(system, after, surface, at):
            continue
        if _at_end(after, violation, ending):
            continue
        whole = whole_orbit(system, before, violation, part)
        site = begins(system, after, violation)
        if whole is not None:
            found.append(whole)
        elif site is not None:
            found.append(Begins(system, site, part, shortest))
    return found


def _at_end(after: Orbit, violation: Violation, ending: list[Ends]) -> bool:
    """Whether an excursion lies just before a relay's event node whose passage ends in a graze."""
    if not isinstance(violation.at, Extremum):
        return False
    segment = int(after.mesh.segments[0][violation.at.interval])
    following = (segment + 1) % max(len(after.phases), 1)
    return any(end.site.row is RELAY and end.excursion.index == following for end in ending)


def _share(system: System, before: Orbit, violation: Violation) -> float:
    """The part of the way to an orbit past a change at which the change lies, about."""
    dense, at = SwitchPolynomials(system, before), violation.at
    if isinstance(at, Extremum):
        most = largest(dense, at.switch) if sliding(system, at.switch) is not None else 1.0
        clear = abs(_clear(dense, at, violation.side)) / most
    else:
        surface = surface_of(system, violation.switch)
        same = violation.switch, at, violation.arriving
        each = limits(system, before, surface)
        clear = next((abs(v.depth) for v in each if (v.switch, v.at, v.arriving) == same), 0.0)
    return float(clear / (clear + abs(violation.depth)))


def _clear(dense: SwitchPolynomials, at: Extremum, side: int) -> float:
    """A switch at its extremum nearest to one of another orbit on the same mesh, or there if it has none.

    Rounding may make an extremum beside an event node of a surface that holds motions.
    """
    orbit = dense.orbit
    if dense.minima(at.switch, side):
        near = dense.nearest(at.switch, side, at.phase)
        if not beside_node(dense, near):
            return near.value
    phase = orbit.grid.left[at.interval] + at.theta * orbit.grid.width[at.interval]
    return dense.value(replace(at, phase=float(phase)))


def _endings(system: System, before: Orbit, after: Orbit, shortest: float) -> list[Ends]:
    """The excursions that become so small between two orbits that they may end."""
    if not before.mesh.events:
        return []
    each = (_ending(system, before, after, shortest, excursion) for excursion in excursions(system, before))
    return [end for end in each if end is not None]


def _ending(
    system: System, before: Orbit, after: Orbit, shortest: float, excursion: Excursion
) -> Ends | None:
    """The end of one excursion, if it is near."""
    row, unit = excursion.row, excursion.unit
    now, then = (excursion.size(system, orbit) / unit for orbit in (before, after))
    if then >= now or (row is CORNER and now <= row.least):
        return None
    half = now if row.gradual else VANISHING * now
    size, last = row.size_below(half), False
    if row.by_speed and size >= half:
        return None
    if row in (ADDING_SLIDING, LIMIT_GRAZING):
        jump = sliding(system, ends(system, before, excursion)[0].switch)
        assert jump is not None
        last = longest_slip(system, before, jump) <= 2 * now
        size = min(LONGEST, half) if last else size
    if then > (max(half, size) if row.power == ROOT and not (last or row.gradual) else size):
        return None
    final = last or size <= row.least
    part, site = row.part(now, then, size), ends(system, before, excursion)[0]
    name = _name(system, site, last)
    return Ends(system, excursion, site, size * unit, final, last, part, shortest, name)


def _name(system: System, site: Site, last: bool) -> str:
    """What ends, in words."""
    if site.row is SWAP:
        names = [system.switches[each.event.switch].name for each in reversed(site.added)]
        return f"the events {' and '.join(dict.fromkeys(names))} meet"
    name, jump = system.switches[site.switch].name, sliding(system, site.switch)
    if jump is not None:
        name = system.switches[jump].name
        if last and surface_of(system, jump).alone:
            return f"the motion slides along {name} = 0 all the time"
        return (
            f"{name} holds all along, at a place that is not determined" if last else f"a stop at {name} ends"
        )
    if site.row is RELAY:
        return f"{name} grazes the threshold at which it switches"
    if site.row is IMPACT:
        return f"the impact at {name} has no speed left"
    if site.row is REVERSAL:
        return "an excursion ends where friction turns the motion"
    return f"the events {name} meet"
