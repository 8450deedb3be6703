"""Event nodes: mesh points that lie where a switch passes a level, so that kinks fall between intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from periodic.events.impacts import arriving_row, tied
from periodic.events.modes import modes_at, modes_in, modes_in_all
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, guards, guards_gradient


def event_rows(system: System, orbit: Orbit, free: tuple[int, ...]) -> list[Row]:
    """Return the condition of each event node, linearised: s(x, phi, p) = level where its segment begins."""
    events, impacts = orbit.mesh.events, tied(system, orbit)
    others = [index for index in range(len(events)) if index not in impacts]
    sides = modes_in_all(system, orbit, orbit.mesh.starts[others] - 1)
    found = _rows(system, orbit, [(i, events[i].switch) for i in others], sides, free)
    rows = dict(zip(others, found, strict=True))
    for i in impacts:
        rows[i] = arriving_row(system, orbit, i, events[i].switch, free)
    return [replace(rows[i], value=rows[i].value - event.level) for i, event in enumerate(events)]


def node_row(system: System, orbit: Orbit, index: int, switch: int, free: tuple[int, ...]) -> Row:
    """Return a switch s(x, phi, p) at the mesh point of an event node, in the modes of `modes_at`."""
    own = orbit.mesh.events[index].switch == switch
    before = int(orbit.mesh.starts[index]) - 1
    side = modes_in(system, orbit, before) if own else modes_at(system, orbit, index, switch)
    return _rows(system, orbit, [(index, switch)], side, free)[0]


def _rows(
    system: System,
    orbit: Orbit,
    places: Sequence[tuple[int, int]],
    sides: Array,
    free: tuple[int, ...],
) -> list[Row]:
    """The rows of switches at event nodes, (index, switch) each, in modes (K, columns)."""
    if not places:
        return []
    indices, switches = map(list, zip(*places, strict=True))
    nodes = orbit.mesh.starts[indices]
    where = orbit.nodes[nodes], orbit.phases[indices], orbit.parameter
    each = np.arange(len(indices)), switches
    by_state, by_phase, by_parameter = (d[each] for d in guards_gradient(system, *where, sides))
    values, found = guards(system, *where, sides)[each], list[Row]()
    for k, index in enumerate(indices):
        states = np.zeros_like(orbit.nodes)
        states[nodes[k]] = by_state[k]
        outer = np.zeros(len(orbit.phases) + len(free))
        outer[index] = by_phase[k]
        outer[len(orbit.phases) :] = by_parameter[k, list(free)]
        found.append(Row(float(values[k]), states, outer))
    return found
