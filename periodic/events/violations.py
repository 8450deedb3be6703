"""Where an orbit violates its word: the one test of the modes that its event nodes prescribe.

In each mode of a surface some functions keep their sign (`periodic.system.SurfaceLike`): the guard on either
side, the releases while the motion is held. That is tested on the polynomials of the whole orbit, which their
Bernstein coefficients enclose, not on samples. At each event node the switch must pass its level in the
node's direction.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

import numpy as np

from periodic.events.impactmodes import thrown
from periodic.events.impacts import slope_before
from periodic.events.modes import mode_after, modes_at, modes_in, release, surface_of
from periodic.events.rates import before
from periodic.events.switchpolynomials import Extremum, SwitchPolynomials
from periodic.events.thresholds import RELEASED, TOGETHER
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import HELD, STUCK, Kind, SurfaceLike, System, guards, surfaces_of


class Breach(Enum):
    """How an orbit violates its word.

    REVERSED: an event node passes its level the other way. GRAZED: an impact or a relay has no speed. HELD:
    the motions on both sides of a jump lead back to it, or a relay's thresholds are in the wrong order.
    THROUGH: the orbit goes through a wall. EXCURSION: a switch passes its level without an event node. MODE:
    the motion is held where it should not be, or the reverse.
    """

    REVERSED = auto()
    GRAZED = auto()
    HELD = auto()
    THROUGH = auto()
    EXCURSION = auto()
    MODE = auto()


@dataclass(frozen=True)
class Violation:
    """A violation: the switch, where (an extremum, or an event node), and the side on which it should be.

    depth: how far it is past its level, for MODE as a part of its largest value; for a crossing at an event
    node the slope. arriving: whether it is taken in the state before the impact at the event node.
    """

    breach: Breach
    switch: int
    at: Extremum | int
    side: int
    depth: float
    arriving: bool = False


def violations(system: System, orbit: Orbit, otherwise: Orbit | None = None) -> list[Violation]:
    """Return where an orbit violates its word; empty where it is an orbit of the system.

    Surfaces without event nodes are on the side of the farthest point of `otherwise`, by default the orbit.
    """
    return at_nodes(system, orbit) + between_nodes(system, orbit, otherwise)


def at_nodes(system: System, orbit: Orbit) -> list[Violation]:
    """Return the event nodes at which a switch does not pass its level in the node's direction."""
    return _at_nodes(SwitchPolynomials(system, orbit))


def _at_nodes(dense: SwitchPolynomials) -> list[Violation]:
    return [violation for i in range(len(dense.orbit.phases)) for violation in _at_node(dense, i)]


def refusals(system: System, orbit: Orbit) -> list[Violation]:
    """Return the violations for which an orbit is refused at once: at event nodes, and through walls."""
    impacts = [surface.switch for surface in surfaces_of(system) if surface.kind == Kind.IMPACT]
    if not impacts:
        return at_nodes(system, orbit)
    dense = SwitchPolynomials(system, orbit)
    return _at_nodes(dense) + [v for switch in impacts for v in _through(dense, switch)]


def between_nodes(system: System, orbit: Orbit, otherwise: Orbit | None = None) -> list[Violation]:
    """Return the violations of the modes between event nodes; `otherwise` as in `violations`."""
    if not system.switches:
        return []
    own = SwitchPolynomials(system, orbit)
    base = own if otherwise is None else SwitchPolynomials(system, otherwise)
    found = list[Violation]()
    for surface in surfaces_of(system):
        if surface.kind == Kind.IMPACT:
            found += _excursions(own, surface.switch, -system.switches[surface.switch].direction, 1.0)
            found += _through(own, surface.switch)
            if surface.leaves is not None:
                most = largest(own, surface.leaves)
                found += _excursions(own, surface.leaves, -1, most, Breach.MODE)
        elif surface.kind in (Kind.KINK, Kind.JUMP, Kind.RELAY):
            found += _excursions(own, surface.switch, base.side(surface.switch), 1.0)
        elif surface.releases is not None:
            found += _held(own, base, surface)
    return found


def _excursions(
    dense: SwitchPolynomials, switch: int, otherwise: int, most: float, breach: Breach = Breach.EXCURSION
) -> list[Violation]:
    """The excursions of a switch past its level without event nodes."""
    sides, found = dense.expected(switch, otherwise), list[Violation]()
    for e in dense.unmarked(switch, otherwise):
        side = int(sides[e.interval])
        found.append(Violation(breach, switch, e, side, -side * e.value / most))
    return found


def _through(dense: SwitchPolynomials, switch: int) -> list[Violation]:
    """How far the orbit goes to the side of an impact's surface on which there is no motion, if it does."""
    side = -dense.system.switches[switch].direction
    along = dense.along(switch)
    lowest = int(np.where(dense.at_rest(along, switch), 0.0, side * along.value).argmin())
    depth = -side * float(along.value[lowest])
    return (
        [Violation(Breach.THROUGH, switch, along.extremum(switch, lowest), side, depth)] if depth > 0 else []
    )


def _held(own: SwitchPolynomials, base: SwitchPolynomials, surface: SurfaceLike) -> list[Violation]:
    """Where the motion slips that should be held at a surface, or the reverse."""
    assert surface.releases is not None
    past = [limit for limit in _limits(own, surface) if limit.depth > RELEASED]
    if past:  # past a limit the motion turns back at once
        return past
    each = (
        violation
        for k in (surface.switch, *surface.releases)
        for violation in _excursions(own, k, base.side(k), largest(own, k), Breach.MODE)
    )
    # beside friction that holds, a slider stays at its limit, and leaves it as slowly as a motion from rest
    return [v for v in each if surface.kind != Kind.SLIDER or v.depth > RELEASED]


def limits(system: System, orbit: Orbit, surface: SurfaceLike) -> list[Violation]:
    """Return the limits at a guard's event nodes: a crossing does not stick, and a stop does not slip on.

    At impacts at which the guard jumps: the limits of the modes before and after. The depths are negative as
    long as these hold.
    """
    return _limits(SwitchPolynomials(system, orbit), surface)


def _limits(dense: SwitchPolynomials, surface: SurfaceLike) -> list[Violation]:
    system, orbit = dense.system, dense.orbit
    assert surface.releases is not None
    (up, down), guard, found = surface.releases, surface.switch, _about_impacts(system, orbit, surface)
    nodes = [j for j, event in enumerate(orbit.mesh.events) if event.switch == guard]
    if not nodes or surface.kind == Kind.SLIDER:  # a slider is held wherever its speed turns
        return found
    most = largest(dense, up, down)
    for j in nodes:
        event, start = orbit.mesh.events[j], orbit.mesh.starts[j]
        at = orbit.nodes[start : start + 1], orbit.phases[j : j + 1], orbit.parameter
        d, held = event.direction, mode_after(surface, event) == STUCK
        onward, side = up if d > 0 else down, -d if held else d
        value = float(guards(system, *at, modes_at(system, orbit, j, onward))[0, onward])
        found.append(Violation(Breach.MODE, onward, j, side, -side * value / most))
    return found


def _about_impacts(system: System, orbit: Orbit, surface: SurfaceLike) -> list[Violation]:
    """The limits of the modes before and after impacts at which the guard of a surface jumps."""
    found = list[Violation]()
    for j in thrown(system, orbit, surface):
        if slope_before(system, orbit, j) * orbit.mesh.events[j].direction > 0:
            interval, x, _ = before(orbit, j)
            start = int(orbit.mesh.starts[j])
            found += _beside_impact(system, orbit, surface, j, x, interval, arriving=True)
            found += _beside_impact(system, orbit, surface, j, orbit.nodes[start][None], start)
    return found


def _beside_impact(
    system: System,
    orbit: Orbit,
    surface: SurfaceLike,
    node: int,
    state: Array,
    interval: int,
    arriving: bool = False,
) -> list[Violation]:
    """The limits of a surface's mode in the interval before or after an impact, at the impact."""
    assert surface.column is not None
    dense, phase = SwitchPolynomials(system, orbit), orbit.phases[node : node + 1]
    mode = int(dense.modes[interval, surface.column]) or dense.side(surface.switch)
    values = guards(system, state, phase, orbit.parameter, modes_in(system, orbit, interval))[0]
    return [
        Violation(Breach.MODE, k, node, side, -side * float(values[k]) / largest(dense, k), arriving)
        for k, side in _kept(surface, mode, arriving)
    ]


def _kept(surface: SurfaceLike, mode: int, arriving: bool) -> tuple[tuple[int, int], ...]:
    """The switches, with their sides, that a mode requires just before or after an impact.

    A joint held before the impact is within its limits; an elastic slider reverses wherever its speed does.
    """
    assert surface.releases is not None
    if mode in (STUCK, HELD):
        up, down = surface.releases
        return ((up, -1), (down, 1)) if arriving else ()
    return ((surface.switch, mode),) if mode and surface.kind == Kind.SLIDING else ()


def largest(dense: SwitchPolynomials, *switches: int) -> float:
    """Return the largest value of switches along an orbit."""
    return float(np.abs(dense.knots[:, :, list(switches)]).max()) or 1.0


def _unforced(dense: SwitchPolynomials, index: int, own: SurfaceLike) -> list[Violation]:
    """The changes of mode at other surfaces that an event node states, but that do not happen there.

    A joint that another's event tears off is within its limits in the modes before, past one in those after;
    one that stops there, or passes 0, has no speed.
    """
    system, orbit, found = dense.system, dense.orbit, list[Violation]()
    event, start = orbit.mesh.events[index], int(orbit.mesh.starts[index])
    at = orbit.nodes[start : start + 1], orbit.phases[index : index + 1], orbit.parameter
    for k, mode in event.modes:
        surface = surface_of(system, k)
        if k == own.switch or surface.releases is None or surface.column is None:
            continue
        before, after = (guards(system, *at, modes_in(system, orbit, j))[0] for j in (start - 1, start))
        let_go = mode != STUCK and dense.modes[start - 1, surface.column] in (STUCK, HELD)
        leaves = release(surface, mode) if let_go else k
        torn = let_go and mode * before[leaves] < 0 < mode * after[leaves]
        most = largest(dense, leaves)
        if not torn and abs(before[leaves]) > TOGETHER * most:
            found.append(Violation(Breach.MODE, k, index, mode, 1.0))
    return found


def _at_node(dense: SwitchPolynomials, index: int) -> list[Violation]:
    """What is wrong at an event node."""
    system, orbit = dense.system, dense.orbit
    event, start = orbit.mesh.events[index], orbit.mesh.starts[index]
    surface = surface_of(system, event.switch)

    def reported(breach: Breach, slope: float) -> list[Violation]:
        ahead = slope * event.direction
        return [] if ahead > 0 else [Violation(breach, event.switch, index, event.direction, -ahead)]

    if surface.kind in (Kind.IMPACT, Kind.RELAY):
        band = reported(Breach.HELD, _beyond(system, orbit, index)) if surface.kind == Kind.RELAY else []
        return reported(Breach.GRAZED, slope_before(system, orbit, index)) + band
    if surface.releases is not None:
        reversed_there = reported(Breach.REVERSED, slope_before(system, orbit, index))
        return reversed_there + _unforced(dense, index, surface)
    at = orbit.nodes[start : start + 1], orbit.phases[index : index + 1], orbit.parameter
    d_state, d_phase, _ = (g[0, event.switch] for g in system.switch_gradient(*at))
    slope = float(d_phase + d_state @ orbit.node_rates[start])
    return reported(Breach.HELD if surface.kind == Kind.JUMP else Breach.REVERSED, slope)


def _beyond(system: System, orbit: Orbit, index: int) -> float:
    """A relay's guard in its mode after an event node: of the mode's sign if the thresholds are in order."""
    start = int(orbit.mesh.starts[index])
    at = orbit.nodes[start : start + 1], orbit.phases[index : index + 1], orbit.parameter
    return float(guards(system, *at, modes_in(system, orbit, start))[0, orbit.mesh.events[index].switch])


def word(system: System, orbit: Orbit) -> tuple[EventNode, ...] | None:
    """Return the event nodes of an orbit at which modes change, sorted; None where modes are violated.

    Their phases are left out, so that an orbit has the same word on any mesh.
    """
    if any(v.breach in (Breach.EXCURSION, Breach.MODE) for v in between_nodes(system, orbit)):
        return None
    marked = {surface.switch for surface in surfaces_of(system) if surface.kind == Kind.MARKER}
    own = [event for event in orbit.mesh.events if event.switch not in marked]
    return tuple(sorted(own, key=lambda event: (event.switch, event.direction, event.modes)))
