"""Jumps of the equations: on either side of an event node they take the branch of their own side.

The side of a switch in an interval is known from the last event node of that switch, whatever the last digits
of the state say; without any the state decides. See `periodic.system.Jumping`.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from periodic.orbit.mesh import Mesh
from periodic.orbit.scheme import Array
from periodic.system import Jumping, LinearisationLike, System, jumps_of


def sides(system: System, mesh: Mesh) -> Array:
    """Return the side of each jump in each interval, 0 where the state decides, shape (N, jumps)."""
    jumps = jumps_of(system)
    found = np.zeros((mesh.ntst, len(jumps)))
    for i, k in enumerate(jumps):
        own = [j for j, event in enumerate(mesh.events) if event.switch == k]
        if own:
            found[:, i] = mesh.events[own[-1]].direction
        for j in own:
            found[mesh.starts[j] :, i] = mesh.events[j].direction
    return found


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
