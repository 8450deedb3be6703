"""Modes of surfaces that no event node changes any more, and the places at which joints are HELD."""

from __future__ import annotations

import numpy as np

from periodic.events.modes import mode_after, sides
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import HELD, STUCK, SurfaceLike, System, surfaces_of


def still(
    system: System, modes: tuple[tuple[int, int], ...], events: tuple[EventNode, ...]
) -> tuple[tuple[int, int], ...]:
    """Return those of the modes all along whose surfaces no event node changes."""
    changed = {
        surface.switch
        for surface in surfaces_of(system)
        if any(mode_after(surface, event) is not None for event in events)
    }
    return tuple(pair for pair in modes if pair[0] not in changed)


def placed(surface: SurfaceLike, parameter: Array, states: Array) -> Array:
    """Return the parameters (p,) with the place at which a surface is HELD, where it has one.

    It is midway between the extreme places in some states (N, n).
    """
    found = parameter.copy()
    if surface.place is not None:
        place, weights = surface.place
        places = states @ np.array(weights)
        found[place] = (places.min() + places.max()) / 2
    return found


def all_along(
    system: System, orbit: Orbit, events: tuple[EventNode, ...]
) -> tuple[tuple[tuple[int, int], ...], Array | None]:
    """Return the modes of all surfaces without event nodes, with those that lose theirs, and parameters.

    A joint that slips no more is HELD where it stuck, and the parameter of its place, if any, is set to that.
    The parameters are None where none has changed.
    """
    modes, parameter = dict(still(system, orbit.mesh.modes, events)), orbit.parameter
    for surface in surfaces_of(system):
        had = any(mode_after(surface, event) is not None for event in orbit.mesh.events)
        has = any(mode_after(surface, event) is not None for event in events)
        if surface.releases is None or surface.column is None or has or not had:
            continue
        mode = sides(system, orbit)[:, surface.column]
        stuck = np.flatnonzero(mode == STUCK)
        if len(stuck) and (surface.place is not None or surface.alone):
            parameter = placed(surface, parameter, orbit.nodes[stuck])
            modes[surface.switch] = HELD
    changed = not np.array_equal(parameter, orbit.parameter)
    return tuple(modes.items()), parameter if changed else None
