"""Jumps of the equations: on either side of an event node they take the branch of their own side.

The side of a switch in an interval is known from the last event node of that switch, whatever the last digits
of the state say. Without any it is that on which the orbit is, but for what is shallow: so an orbit is smooth
past the touch up to which it is followed. Else the state decides. See `periodic.system.Jumping`.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import Jumping, LinearisationLike, System, jumps_of, slides_of

STUCK = 2
"""Side of a jump on which the motion slides along it."""


SHALLOW = 0.05
"""How far past its level a switch without event nodes may be, as a part of how far it is on its own side."""


def sides(system: System, orbit: Orbit) -> Array:
    """Return the side of each jump in each interval, 0 where the state decides, shape (N, jumps).

    1 and -1 are the signs of its switch, STUCK says that the motion slides on the jump.
    """
    jumps, mesh = jumps_of(system), orbit.mesh
    found = np.zeros((mesh.ntst, len(jumps)))
    for i, k in enumerate(jumps):
        own = group(system, mesh, k)
        modes = [STUCK if sticks(system, mesh, k, j) is not None else mesh.events[j].direction for j in own]
        found[:, i] = modes[-1] if own else _whole(system, orbit, k)
        for j, mode in zip(own, modes, strict=True):
            found[mesh.starts[j] :, i] = mode
    return found


def _whole(system: System, orbit: Orbit, switch: int) -> int:
    """The side of a jump all along an orbit without event nodes of it, 0 if it has none."""
    if switch in slides_of(system):
        return 0
    states, tau = orbit.stages.reshape(-1, orbit.stages.shape[2]), orbit.stage_phases.ravel()
    values = system.switch(states, tau, orbit.parameter)[:, switch]
    side = 1 if values.max() > -values.min() else -1
    return side if (side * values).min() > -SHALLOW * np.abs(values).max() else 0


def group(system: System, mesh: Mesh, switch: int) -> list[int]:
    """Return the event nodes of a jump and of its releases, in order."""
    releases = slides_of(system).get(switch, ())
    return [j for j, event in enumerate(mesh.events) if event.switch in (switch, *releases)]


def sticks(system: System, mesh: Mesh, switch: int, node: int) -> int | None:
    """Return the event node of the release where an event node of a jump begins a stretch of sticking."""
    own, releases = group(system, mesh, switch), slides_of(system).get(switch, ())
    after = own[(own.index(node) + 1) % len(own)]
    begins = mesh.events[node].switch == switch and mesh.events[after].switch in releases
    return after if begins else None


def linearise(
    system: System,
    rate: Array,
    state: Array,
    algebraic: Array,
    phase: Array,
    parameter: Array,
    side: Array,
    free: tuple[int, ...] = (),
) -> LinearisationLike:
    """Linearise the equations on the given sides (points, jumps) of their jumps."""
    if not side.any():
        return system.linearise(rate, state, algebraic, phase, parameter, free)
    beside = cast(Jumping, system)
    return beside.linearise_beside(rate, state, algebraic, phase, parameter, side, free)
