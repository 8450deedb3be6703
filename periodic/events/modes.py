"""The word of an orbit, its mode sequence: the modes of its surfaces between its event nodes.

An event node is a transition: it takes its own surface, and others that change with it, from one mode to
another. So the last event node that changed a surface determines its mode in an interval, not the sign of a
guard that rounding may decide. A surface that no event node changes has the side on which the orbit lies but
for shallow excursions, so that an orbit is smooth past the grazing up to which it is followed; if excursions
are deep the state decides. See `periodic.system.SurfaceLike`.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from periodic.events.thresholds import SHALLOW
from periodic.orbit.mesh import EventNode, Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import (
    HELD,
    MINUS,
    PLUS,
    STUCK,
    Jumping,
    Kind,
    LinearisationLike,
    SurfaceLike,
    System,
    guards,
    surfaces_of,
)

_KEPT: weakref.WeakKeyDictionary[Mesh, tuple[weakref.ReferenceType[System], Array]] = (
    weakref.WeakKeyDictionary()
)
"""Modes by meshes, with the system that they belong to."""


def surface_of(system: System, switch: int) -> SurfaceLike:
    """Return the surface that a switch is the guard of, a release of, or a departure from."""
    return next(
        s for s in surfaces_of(system) if switch in (s.switch, s.leaves) or switch in (s.releases or ())
    )


def of_kind(system: System, *kinds: Kind) -> list[SurfaceLike]:
    """Return the surfaces of some kinds."""
    return [surface for surface in surfaces_of(system) if surface.kind in kinds]


def bends(system: System) -> list[int]:
    """Return the switches at whose level 0 the equations have a kink, or a jump without sliding motions."""
    return [surface.switch for surface in of_kind(system, Kind.KINK, Kind.JUMP, Kind.RELAY)]


def returns(system: System) -> list[int]:
    """Return the switches of `bends` whose excursions may be arbitrarily short: all but relays."""
    return [surface.switch for surface in of_kind(system, Kind.KINK, Kind.JUMP)]


def relays(system: System) -> list[int]:
    """Return the guards of relays, each a different function in either mode."""
    return [surface.switch for surface in of_kind(system, Kind.RELAY)]


def of_held(system: System) -> list[int]:
    """Return the guards of the surfaces at which motions may be held."""
    return [surface.switch for surface in surfaces_of(system) if surface.releases is not None]


def sliding(system: System, switch: int) -> int | None:
    """Return the guard of a switch's surface if motions may be held at it, else None."""
    surface = surface_of(system, switch)
    return None if surface.releases is None else surface.switch


def releases(system: System, switch: int) -> tuple[int, int]:
    """Return the switches (up, down) at which motions held at a guard are released."""
    found = surface_of(system, switch).releases
    assert found is not None
    return found


def release(surface: SurfaceLike, way: int) -> int:
    """Return the switch at which a motion held at a surface is released upwards (1), or downwards (-1)."""
    assert surface.releases is not None
    return surface.releases[0 if way > 0 else 1]


def column(system: System, switch: int) -> int:
    """Return the column of a guard's surface among the modes."""
    found = surface_of(system, switch).column
    assert found is not None
    return found


def mode_after(surface: SurfaceLike, event: EventNode) -> int | None:
    """Return the mode of a surface after an event node; None where the node does not change it."""
    for guard, mode in event.modes:
        if guard == surface.switch:
            return mode
    if surface.kind == Kind.IMPACT:
        return event.direction if event.switch == surface.leaves else None
    passes = event.switch == surface.switch or event.switch in (surface.releases or ())
    return event.direction if passes else None


def torn(system: System, surface: SurfaceLike, event: EventNode) -> bool:
    """Whether friction is let go by a jump of the force as another guard passes 0, short of its own limit."""
    other = surface_of(system, event.switch)
    passes = other.switch == event.switch != surface.switch and other.kind != Kind.IMPACT
    return passes and surface.kind == Kind.SLIDING and mode_after(surface, event) in (PLUS, MINUS)


def held_all_along(mesh: Mesh, surface: SurfaceLike) -> bool:
    """Whether a motion is held at a surface all along."""
    return dict(mesh.modes).get(surface.switch) == HELD


def group(system: System, mesh: Mesh, switch: int) -> list[int]:
    """Return the event nodes that change the mode of a guard's surface, in order."""
    surface = surface_of(system, switch)
    return [j for j, event in enumerate(mesh.events) if mode_after(surface, event) is not None]


def sticks(system: System, mesh: Mesh, switch: int, node: int) -> int | None:
    """Return the event node at which the sticking ends that begins at `node`; None where none begins."""
    if mode_after(surface_of(system, switch), mesh.events[node]) != STUCK:
        return None
    own = group(system, mesh, switch)
    return own[(own.index(node) + 1) % len(own)]


def sides(system: System, orbit: Orbit) -> Array:
    """Return the mode of each surface with a column in each interval, shape (N, columns).

    1 and -1 are the signs of its guard; STUCK and HELD: the guard is held at 0; 0: the state decides.
    """
    own = [s for s in surfaces_of(system) if s.column is not None]
    if not own:
        return np.zeros((orbit.mesh.ntst, 0))
    found = _by_nodes(system, orbit.mesh, own).copy()
    for surface in own:
        column = cast(int, surface.column)
        if np.isnan(found[0, column]):
            found[:, column] = _whole(system, orbit, surface)
    return found


def _by_nodes(system: System, mesh: Mesh, own: Sequence[SurfaceLike]) -> Array:
    """The modes that a mesh prescribes in each interval, NaN where it prescribes none; cached by mesh."""
    kept = _KEPT.get(mesh)
    if kept is None or kept[0]() is not system:
        found = np.stack([_along(mesh, surface) for surface in own], axis=1)
        found = found[:, np.argsort([cast(int, surface.column) for surface in own], kind="stable")]
        kept = weakref.ref(system), found
        _KEPT[mesh] = kept
    return kept[1]


def _along(mesh: Mesh, surface: SurfaceLike) -> Array:
    """The mode of a surface in each interval."""
    changes = [(int(j), mode_after(surface, e)) for j, e in zip(mesh.starts, mesh.events, strict=True)]
    changes = [(j, mode) for j, mode in changes if mode is not None]
    whole = changes[-1][1] if changes else dict(mesh.modes).get(surface.switch)
    found = np.full(mesh.ntst, np.nan if whole is None else whole, dtype=float)
    for j, mode in changes:
        found[j:] = mode
    return found if surface.kind != Kind.IMPACT else np.where(found == STUCK, STUCK, 0.0)


def _whole(system: System, orbit: Orbit, surface: SurfaceLike) -> int:
    """The mode of a surface without event nodes along an orbit; 0 where the state decides."""
    if surface.releases is not None:
        return 0
    states, tau = orbit.stages.reshape(-1, orbit.stages.shape[2]), orbit.stage_phases.ravel()
    if surface.kind == Kind.RELAY:
        return _relayed(system, states, tau, orbit.parameter, surface)
    values = system.switch(states, tau, orbit.parameter)[:, surface.switch]
    side = 1 if values.max() > -values.min() else -1
    return side if (side * values).min() > -SHALLOW * np.abs(values).max() else 0


def _relayed(system: System, states: Array, tau: Array, parameter: Array, surface: SurfaceLike) -> int:
    """The mode of a relay that never switches: on where it has been above the upper threshold."""
    columns = sum(other.column is not None for other in surfaces_of(system))
    side = np.zeros((len(tau), columns))
    values = dict[int, Array]()
    for mode in (MINUS, PLUS):
        side[:, cast(int, surface.column)] = mode
        values[mode] = guards(system, states, tau, parameter, side)[:, surface.switch]
    return PLUS if values[MINUS].max() > 0 and values[PLUS].min() > 0 else MINUS


def completed(system: System, events: Sequence[EventNode]) -> tuple[EventNode, ...]:
    """Return event nodes with their modes, for nodes read from a file without modes.

    Sticking begins where the next event node of a surface is one of its releases.
    """
    found = list(events)
    for surface in surfaces_of(system):
        own = [j for j, e in enumerate(events) if mode_after(surface, e) is not None]
        for j, after in zip(own, [*own[1:], *own[:1]], strict=True):
            released = events[after].switch in (surface.releases or ())
            if released and events[j].switch == surface.switch and not events[j].modes:
                found[j] = replace(events[j], modes=((surface.switch, STUCK),))
    return tuple(found)


def inconsistency(system: System, events: Sequence[EventNode]) -> str:
    """Return where event nodes are no mode sequence of a relay or a surface that holds; '' where they are.

    Each transition of a surface begins in the mode in which the one before ended.
    """
    for surface in surfaces_of(system):
        if surface.releases is None and surface.kind != Kind.RELAY:
            continue
        own = [(e, cast(int, mode_after(surface, e))) for e in events if mode_after(surface, e) is not None]
        for (_, before), (event, after) in zip(own[-1:] + own[:-1], own, strict=True):
            if not _follows(surface, event, before, after):
                return f"{surface.name} goes to mode {after} from mode {before}"
    return ""


def _follows(surface: SurfaceLike, event: EventNode, before: int, after: int) -> bool:
    """Whether a transition may begin in a mode."""
    if event.switch == surface.switch:
        return before == -event.direction
    if event.switch in (surface.releases or ()):
        return before == STUCK and after == event.direction
    return before != after


def modes_at(system: System, orbit: Orbit, node: int, switch: int) -> Array:
    """Return the modes at an event node in which a switch decides what its surface does there, (1, columns).

    They are those before it. What the node takes along counts as after it where the surface is its own: so
    a mass that stops and lets go of another at once is held against what is left.
    """
    start = int(orbit.mesh.starts[node])
    found = modes_in(system, orbit, start - 1)
    own = surface_of(system, switch)
    here = surface_of(system, orbit.mesh.events[node].switch)
    if own.column is None or own.switch != here.switch or not found.size:
        return found
    after = modes_in(system, orbit, start).copy()
    after[:, own.column] = found[:, own.column]
    return after


def modes_in(system: System, orbit: Orbit, interval: int) -> Array:
    """Return the modes in one interval, (1, columns), or (1, 0) where guards do not depend on them."""
    return modes_in_all(system, orbit, [interval])


def modes_in_all(system: System, orbit: Orbit, intervals: Sequence[int] | Array) -> Array:
    """Return the modes in some intervals, (K, columns), or (K, 0) where guards do not depend on them."""
    if not getattr(system, "guards_depend", False):
        return np.zeros((len(intervals), 0))
    return sides(system, orbit)[intervals]


def linearise(
    system: System,
    at: tuple[Array, Array, Array, Array, Array],
    side: Array,
    free: tuple[int, ...] = (),
) -> LinearisationLike:
    """Linearise the equations at (rate, state, algebraic, phase, parameter) in modes (points, columns)."""
    if not side.any():
        return system.linearise(*at, free)
    return cast(Jumping, system).linearise_beside(*at, side, free)
