"""Excursions with an impact inside, which reverses the rate of their switch: they end in a corner."""

from __future__ import annotations

from periodic.events.impacts import tied
from periodic.events.modes import modes_in
from periodic.events.rates import before, rate_before
from periodic.orbit.orbit import Orbit
from periodic.system import System, guards_gradient


def reversed_by_impact(system: System, orbit: Orbit, segment: int) -> bool:
    """Whether an impact at an end of a segment reverses ds/dtau of the other end's switch: no swap then."""
    ends, impacts = (segment, (segment + 1) % len(orbit.phases)), tied(system, orbit)
    for node, other in (ends, ends[::-1]):
        if node in impacts:
            switch, start = orbit.mesh.events[other].switch, orbit.mesh.starts[node]
            interval, x, phase = before(orbit, node)
            pieces = (
                (x, rate_before(orbit, node), interval),
                (orbit.nodes[start : start + 1], orbit.node_rates[start], int(start)),
            )
            slopes = []
            for state, rate, place in pieces:
                modes = modes_in(system, orbit, place)
                by_state, by_phase, _ = guards_gradient(system, state, phase, orbit.parameter, modes)
                slopes.append(float(by_phase[0, switch] + by_state[0, switch] @ rate))
            if slopes[0] * slopes[1] <= 0:
                return True
    return False


def corner(system: System, orbit: Orbit, segment: int) -> tuple[int, int] | None:
    """Return the ends of an excursion about an impact that lies at an end of a segment; None without one.

    The impact reverses the switch's rate; the excursion ends in a corner, where all three events meet.
    """
    events, k = orbit.mesh.events, len(orbit.phases)
    impacts = tied(system, orbit)
    if not impacts or not reversed_by_impact(system, orbit, segment):
        return None
    for m in (segment, (segment + 1) % k):
        earlier, later = (m - 1) % k, (m + 1) % k
        returns = events[earlier].direction != events[later].direction
        same = events[earlier].switch == events[later].switch != events[m].switch
        if m in impacts and same and returns:
            return earlier, later
    return None
