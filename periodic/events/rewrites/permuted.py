"""Words of the same event nodes in another order: several swaps at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from periodic.events.impacts import tied
from periodic.events.modes import inconsistency
from periodic.events.rewrites.sites import Node, in_order
from periodic.events.rewrites.swaps import swaps
from periodic.events.rewrites.together import together
from periodic.events.twinguards import held_throughout
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System


def permuted(system: System, orbit: Orbit, phases: Array) -> list[Node] | None:
    """Return the event nodes of an orbit with new phases, sorted by these.

    None where their order is unchanged, and where changing it takes other rows of the table than swaps.

    Parameters
    ----------
    system : System
        The system.
    orbit : Orbit
        An orbit with its word.
    phases : ndarray, shape (k,)
        New phases of its event nodes, in any order.

    Returns
    -------
    list of (EventNode, float), or None
        Event nodes with their phases, these in [0, period) and in order.
    """
    if (orbit.mesh.segment_lengths(phases) > 0).all() or tied(system, orbit):
        return None
    events, places = list(orbit.mesh.events), [float(phase) for phase in phases]
    for _ in range(len(events) ** 2):
        segment = _first_reversed(places, orbit.mesh.period)
        if segment is None:
            break
        if not swaps(system, _with(orbit, events), segment):
            return None
        _swap(events, places, segment, orbit.mesh.period)
    else:
        return None
    nodes = in_order(zip(events, places, strict=True), orbit)
    held = held_throughout(system, orbit.mesh.modes)
    if inconsistency(system, [event for event, _ in nodes]) or together(system, nodes, 0.0, held) != nodes:
        return None
    return nodes


def _first_reversed(places: Sequence[float], period: float) -> int | None:
    """The first segment at whose end the event node is the earlier one; None where all are in order."""
    ends = [*places[1:], places[0] + period]
    return next((i for i, (begin, end) in enumerate(zip(places, ends, strict=True)) if end <= begin), None)


def _with(orbit: Orbit, events: Sequence[EventNode]) -> Orbit:
    """The orbit with other event nodes at its phases."""
    return replace(orbit, mesh=replace(orbit.mesh, events=tuple(events)))


def _swap(events: list[EventNode], places: list[float], segment: int, period: float) -> None:
    """Exchange the event nodes at the ends of a segment, with their phases."""
    i, j = segment, (segment + 1) % len(events)
    turn = 0.0 if j else period
    events[i], events[j] = events[j], events[i]
    places[i], places[j] = places[j] + turn, places[i] - turn
