"""Jumps of the equations: on either side of an event node they take the branch of their own side.

The side of a switch in an interval is known from the last event node of that switch, whatever the last digits
of the state say; without any the state decides. See `periodic.system.Jumping`.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from periodic.orbit.mesh import Mesh
from periodic.orbit.scheme import Array
from periodic.system import Jumping, LinearisationLike, System, jumps_of, slides_of

STUCK = 2
"""Side of a jump on which the motion slides along it."""


def sides(system: System, mesh: Mesh) -> Array:
    """Return the side of each jump in each interval, 0 where the state decides, shape (N, jumps).

    1 and -1 are the signs of its switch, STUCK says that the motion slides on the jump.
    """
    jumps = jumps_of(system)
    found = np.zeros((mesh.ntst, len(jumps)))
    for i, k in enumerate(jumps):
        own = group(system, mesh, k)
        modes = [STUCK if sticks(system, mesh, k, j) is not None else mesh.events[j].direction for j in own]
        if own:
            found[:, i] = modes[-1]
        for j, mode in zip(own, modes, strict=True):
            found[mesh.starts[j] :, i] = mode
    return found


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
