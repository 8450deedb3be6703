"""The word of a simulated motion, and the guess of an orbit that is made from it.

The events of a motion integrated in time, and the modes of its surfaces, are the orbit's word. Joints that
neither slip nor come to rest in the whole period are HELD.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from periodic.events.heldalong import placed
from periodic.events.modes import of_kind, release, sides
from periodic.events.relaycrossings import mode_at
from periodic.events.rewrites.sites import Node, in_order, ordered
from periodic.events.rewrites.together import together
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import AT_LEVEL, SAME_PHASE
from periodic.events.twinguards import twins
from periodic.events.violations import largest
from periodic.orbit.construction import constant
from periodic.orbit.layout import layout_of
from periodic.orbit.mesh import MIN_INTERVALS, EventNode, Mesh, uniform
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import (
    HELD,
    STUCK,
    Happened,
    Kind,
    Moving,
    SurfaceLike,
    System,
    TrajectoryLike,
    surfaces_of,
)

PER_PERIOD = 60
"""Intervals in a period of the guess."""

PERIODS = 100
"""Most periods of the excitation that a motion is given to settle."""

STILL = 1e-3
"""A motion has settled that changes by less than this part of its peak to peak from period to period."""

FOLLOWED = 1e-8
"""Tolerance with which motions are followed in time for their events."""

APART = 1e-5
"""Distance (rad) at which simultaneous events are put that do not cause each other."""


def word_of(system: System, events: Sequence[Happened], always: Sequence[int] = ()) -> list[Node]:
    """Return the event nodes, with their phases, for the events of a motion.

    always: guards of friction that is held all along.
    """
    surfaces, found = surfaces_of(system), list[Node]()
    rows = sorted(events, key=lambda event: event.phase)
    modes = {event.surface: event.after for event in rows}
    for group in _at_once(rows):
        each = sorted(group, key=lambda event: _rank(surfaces[event.surface], event))
        held = [surfaces[i].switch for i in _stuck(surfaces, modes) - {event.surface for event in each}]
        for count, apart in enumerate(_together(system, each, [*held, *always])):  # their order is arbitrary
            node = _node(system, surfaces[apart[0].surface], apart)
            found.append((node, apart[0].phase + count * APART))
        modes |= {event.surface: event.after for event in each}
    return together(system, found, APART, always)


def _at_once(rows: Sequence[Happened]) -> Iterator[list[Happened]]:
    """Yield groups of simultaneous events, from events in order of phase."""
    group = list[Happened]()
    for event in rows:
        if group and event.phase - group[-1].phase > SAME_PHASE:
            yield group
            group = []
        group.append(event)
    if group:
        yield group


def _stuck(surfaces: Sequence[SurfaceLike], modes: Mapping[int, int]) -> set[int]:
    """The surfaces of friction that is held, by their indices."""
    return {i for i, mode in modes.items() if mode == STUCK and surfaces[i].kind == Kind.SLIDING}


def _together(system: System, each: list[Happened], held: Sequence[int]) -> list[list[Happened]]:
    """Simultaneous events, in sets of which one causes the others, or that have the same guard.

    held: guards of friction that is held before and after them.
    """
    surfaces, found = surfaces_of(system), dict[int, list[Happened]]()
    if _brings_about(system, surfaces[each[0].surface]):
        return [each]
    for event in each:
        found.setdefault(min(twins(system, surfaces[event.surface].switch, held)), []).append(event)
    return list(found.values())


def _always(system: System, whole: TrajectoryLike) -> list[int]:
    """The guards of friction that is held in all of a motion."""
    changed = {event.surface for event in whole.events}
    modes = enumerate(zip(surfaces_of(system), whole.modes, strict=True))
    return [s.switch for i, (s, m) in modes if s.kind == Kind.SLIDING and m == STUCK and i not in changed]


def _brings_about(system: System, surface: SurfaceLike) -> bool:
    """Whether an event at a surface may cause others: an impact, or where guards depend on other modes."""
    return surface.kind == Kind.IMPACT or getattr(system, "guards_depend", False)


def _node(system: System, surface: SurfaceLike, each: Sequence[Happened]) -> EventNode:
    """The event node of simultaneous events, the first of which causes the others."""
    surfaces, first, modes = surfaces_of(system), each[0], list[tuple[int, int]]()
    for event in each:
        if event.after == STUCK or (surfaces[event.surface].kind != Kind.IMPACT and event is not first):
            modes.append((surfaces[event.surface].switch, event.after))
    switch, direction = _crossed(system, surface, first)
    return EventNode(switch, direction, modes=tuple(modes))


def _rank(surface: SurfaceLike, event: Happened) -> int:
    """Rank of an event among simultaneous ones, causes first: impacts, then stops, then releases.

    Friction goes before sliders in parallel with it.
    """
    if surface.kind == Kind.IMPACT and event.before != STUCK:
        return 0
    return (3 if event.before == STUCK else 1) + (surface.kind == Kind.SLIDER)


def _crossed(system: System, surface: SurfaceLike, event: Happened) -> tuple[int, int]:
    """The switch that crosses its level at an event, and the direction."""
    if surface.kind == Kind.IMPACT and event.before == STUCK:
        assert surface.leaves is not None
        return surface.leaves, 1
    if surface.kind == Kind.IMPACT:
        return surface.switch, system.switches[surface.switch].direction
    if event.before == STUCK and surface.releases is not None:
        return release(surface, event.after), event.after
    return surface.switch, -event.before if event.after == STUCK else event.after


def motion_from(
    system: Moving,
    state: Array,
    algebraic: Array,
    parameter: Array,
    phase: Array,
    tolerance: float,
    modes: Sequence[int] | None,
) -> TrajectoryLike:
    """Return the motion from a state; modes: those before it, which relays and friction that sticks keep."""
    given = state, algebraic, parameter, phase, tolerance
    keeps = any(surface.kind == Kind.RELAY or surface.alone for surface in surfaces_of(system))
    return system.motion(*given, modes) if modes and keeps else system.motion(*given)


def has_words(system: System) -> bool:
    """Return whether words are read from motions of a system: it has relays, holds, or walls to rest on."""
    return bool(_followed_surfaces(system)) or any(s.leaves is not None for s in surfaces_of(system))


def _followed_surfaces(system: System) -> list[SurfaceLike]:
    """The surfaces that hold, and relays."""
    return [s for s in surfaces_of(system) if s.releases is not None or s.kind == Kind.RELAY]


def orbit_of(
    system: Moving,
    state: Array,
    algebraic: Array,
    parameter: Array,
    tolerance: float,
    begin: float = 0.0,
    before: Sequence[int] | None = None,
) -> Orbit | None:
    """Return the motion of one period from a state as a guess of an orbit.

    None for a system without relays, surfaces that hold, and walls to rest on, and where the modes at the end
    do not lead to those at the beginning, so that two events are put at one phase. begin: the phase of the
    state; before: the modes of all surfaces before it, which relays and friction that sticks keep.

    Raises what the integration raises.
    """
    if not has_words(system):
        return None
    followed = _followed_surfaces(system)

    def follow(phase: Array, parameter: Array) -> TrajectoryLike:
        return motion_from(system, state, algebraic, parameter, phase, tolerance, before)

    whole = follow(np.array([begin, begin + FORCED]), parameter)
    nodes = word_of(system, whole.events, _always(system, whole))
    changed = {k for event, _ in nodes for k in (event.switch, *(k for k, _ in event.modes))}
    mesh, phases = _mesh(system, nodes)
    if len(np.unique(phases)) < len(phases):
        return None
    modes, parameter = list[tuple[int, int]](), parameter.copy()
    for index, surface in enumerate(surfaces_of(system)):
        if surface not in followed or changed & {surface.switch, *(surface.releases or ())}:
            continue
        mode = whole.modes[index]
        if mode == STUCK and (surface.place is not None or surface.alone):
            parameter, mode = placed(surface, parameter, state[None]), HELD
        modes.append((surface.switch, mode))
    mesh = Mesh(mesh.scheme, mesh.breaks, mesh.events, mesh.period, tuple(modes))
    return replace(_on(mesh, phases, parameter, begin, follow), layout=layout_of(system))


def followed(system: System, orbit: Orbit, tolerance: float, before: int = 0) -> Orbit | None:
    """Return the motion of one period from a state of an orbit as a guess; None where there is none.

    It begins midway in the longest segment in which the orbit is not behind a wall, as far from all events as
    possible, and `before` periods earlier. The orbit may violate its word; the guess has the motion's word.

    Raises what the integration raises.
    """
    if not hasattr(system, "motion") or orbit.mesh.period != FORCED:
        return None
    at = _begin(system, orbit)[None]
    state, algebraic = orbit.state(at)[0], orbit.algebraic_guess(at)[0]
    moving, begin, modes = cast(Moving, system), float(at[0]), _modes(system, orbit, at)
    for _ in range(before):
        ends = np.array([begin, begin + FORCED])
        path = motion_from(moving, state, algebraic, orbit.parameter, ends, tolerance, modes)
        state, algebraic = path.state[-1], path.algebraic[-1]
        modes = list(path.modes)
    return orbit_of(moving, state, algebraic, orbit.parameter, tolerance, begin, modes)


def passed(system: System, orbit: Orbit, tolerance: float) -> list[Node] | None:
    """Return the events of the motion of one period from a state of an orbit; None where there is none.

    It begins as in `followed`. The orbit need not be closed; its event nodes may be those of one nearby.

    Raises what the integration raises.
    """
    if not hasattr(system, "motion") or orbit.mesh.period != FORCED:
        return None
    at = _begin(system, orbit)[None]
    state, algebraic, begin = orbit.state(at)[0], orbit.algebraic_guess(at)[0], float(at[0])
    given = state, algebraic, orbit.parameter, np.array([begin, begin + FORCED]), tolerance
    whole = motion_from(cast(Moving, system), *given, _modes(system, orbit, at))
    return in_order(word_of(system, whole.events, _always(system, whole)), orbit)


def _modes(system: System, orbit: Orbit, at: Array) -> list[int]:
    """The modes of all surfaces at a phase (1,), 0 of those that have no column."""
    found = sides(system, orbit)[orbit.locate(at)[0][0]]
    relays = {s.switch: mode_at(system, orbit, s, at) for s in surfaces_of(system) if s.kind == Kind.RELAY}
    own = [0 if s.column is None else int(found[s.column]) for s in surfaces_of(system)]
    return [relays.get(s.switch, mode) for s, mode in zip(surfaces_of(system), own, strict=True)]


def _begin(system: System, orbit: Orbit) -> Array:
    """The phase midway in the longest segment that is not behind a wall there; in the longest if none is."""
    at, walls = np.mod(amid(orbit), FORCED), of_kind(system, Kind.IMPACT)
    ahead = np.ones(len(at), dtype=bool)
    for k in (wall.switch for wall in walls):
        own = -system.switches[k].direction * system.switch(orbit.state(at), at, orbit.parameter)[:, k]
        ahead &= own >= -AT_LEVEL * largest(SwitchPolynomials(system, orbit), k)
    return np.asarray(at[ahead.argmax()])


def amid(orbit: Orbit) -> Array:
    """Return the phases midway in the segments, the longest first; 0 where there are none."""
    if not orbit.mesh.events:
        return np.zeros(1)
    lengths = orbit.mesh.segment_lengths(orbit.phases)
    order = np.argsort(-lengths, kind="stable")
    return np.asarray((orbit.phases + lengths / 2)[order])


def _mesh(system: System, nodes: Sequence[Node]) -> tuple[Mesh, Array]:
    """A mesh with event nodes."""
    if not nodes:
        return uniform(Scheme(), PER_PERIOD), np.zeros(0)
    rest = constant(uniform(Scheme(), 1), *system.rest(system.nominal), system.nominal)
    events, phases = ordered(nodes, rest)
    lengths = np.diff(np.append(phases, phases[0] + FORCED))
    counts = np.maximum(np.ceil(PER_PERIOD * lengths / FORCED).astype(int), MIN_INTERVALS)
    breaks = tuple(np.linspace(0, 1, count + 1) for count in counts)
    return Mesh(Scheme(), breaks, events, FORCED), phases


def _on(
    mesh: Mesh,
    phases: Array,
    parameter: Array,
    begin: float,
    follow: Callable[[Array, Array], TrajectoryLike],
) -> Orbit:
    """The motion from a phase on, at the points of a mesh that may begin elsewhere in the period."""
    grid = mesh.grid(phases)
    nodes = mesh.nodes(phases)
    stages = grid.left[:, None] + grid.width[:, None] * mesh.scheme.points
    for start in mesh.starts:
        nodes[start] += SAME_PHASE
        stages[start - 1, -1] -= SAME_PHASE
    flat = begin + np.mod(np.concatenate([nodes, stages.ravel()]) - begin, FORCED)
    phase, place = np.unique(np.append(flat, [begin, begin + FORCED]), return_inverse=True)
    path = follow(phase, parameter)
    last = np.searchsorted(path.phase, phase, side="right") - 1  # of each impact's two points the later one
    x, z = path.state[last][place], path.algebraic[last][place]
    first, count = len(nodes), mesh.ntst
    shape = (count, mesh.scheme.ncol, -1)
    states = x[:first]
    if mesh.events:
        states[-1] = states[0]
    inner = x[first : first + stages.size].reshape(shape)
    unknown = z[first : first + stages.size].reshape(*shape[:2], z.shape[1])
    return Orbit(mesh, states, inner, unknown, phases, parameter)
