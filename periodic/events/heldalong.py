"""What no event node changes any more: modes of surfaces all along, and the place where something is HELD."""

from __future__ import annotations

import numpy as np

from periodic.events.modes import mode_after, sides
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import HELD, STUCK, System, surfaces_of


def still(
    system: System, modes: tuple[tuple[int, int], ...], events: tuple[EventNode, ...]
) -> tuple[tuple[int, int], ...]:
    """Return the modes all along of surfaces that none of some event nodes changes."""
    changed = {
        surface.switch
        for surface in surfaces_of(system)
        if any(mode_after(surface, event) is not None for event in events)
    }
    return tuple(pair for pair in modes if pair[0] not in changed)


def all_along(
    system: System, orbit: Orbit, events: tuple[EventNode, ...]
) -> tuple[tuple[tuple[int, int], ...], Array | None]:
    """Return the modes of surfaces that lose their event nodes, with those that have none, and parameters.

    What slips no more is held where it is: that is its place from there on. The parameters are None where
    none has changed.
    """
    modes, parameter = dict(still(system, orbit.mesh.modes, events)), orbit.parameter.copy()
    for surface in surfaces_of(system):
        had = any(mode_after(surface, event) is not None for event in orbit.mesh.events)
        has = any(mode_after(surface, event) is not None for event in events)
        if surface.releases is None or surface.place is None or surface.column is None or has or not had:
            continue
        mode = sides(system, orbit)[:, surface.column]
        stuck = np.flatnonzero(mode == STUCK)
        if len(stuck):
            place, weights = surface.place
            places = orbit.nodes[stuck] @ np.array(weights)
            parameter[place] = (places.min() + places.max()) / 2  # between the slips that are gone
            modes[surface.switch] = HELD
    changed = not np.array_equal(parameter, orbit.parameter)
    return tuple(modes.items()), parameter if changed else None
