"""Where relays switch along an orbit whose mesh has no event nodes for them yet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.events.modes import group, sides
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import MINUS, PLUS, SurfaceLike, System


def switched(system: System, orbit: Orbit, switch: int) -> list[tuple[EventNode, float]]:
    """Return where a relay switches, with the phases: at its event nodes, else where the orbit makes it.

    Without event nodes it switches on where the upper threshold is passed upwards, and off where the lower
    one is passed downwards after that.
    """
    if group(system, orbit.mesh, switch):
        return SwitchPolynomials(system, orbit).crossings(switch)
    found = list[tuple[EventNode, float]]()
    for mode in (MINUS, PLUS):
        modes = (*(pair for pair in orbit.mesh.modes if pair[0] != switch), (switch, mode))
        given = replace(orbit, mesh=replace(orbit.mesh, modes=modes))
        crossings = SwitchPolynomials(system, given).crossings(switch)
        found += [crossing for crossing in crossings if crossing[0].direction == -mode]
    found.sort(key=lambda crossing: crossing[1])
    before = [*found[-1:], *found[:-1]]
    return [own for own, last in zip(found, before, strict=True) if own[0].direction != last[0].direction]


def mode_at(system: System, orbit: Orbit, relay: SurfaceLike, phase: Array) -> int:
    """Return whether a relay is on or off at a phase (1,): by where it switches, or its modes."""
    crossings = switched(system, orbit, relay.switch)
    if not crossings:
        assert relay.column is not None
        return int(sides(system, orbit)[orbit.locate(phase)[0][0], relay.column])
    since = [float((phase[0] - at) % orbit.mesh.period) for _, at in crossings]
    return crossings[int(np.argmin(since))][0].direction
