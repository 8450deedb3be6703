"""Event nodes: mesh points that lie where a switch passes a level, so that kinks fall between intervals."""

from __future__ import annotations

import numpy as np

from periodic.events.impacts import arriving_row, tied
from periodic.events.modes import modes_at, modes_in
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.system import System, guards, guards_gradient


def event_rows(system: System, orbit: Orbit, free: tuple[int, ...]) -> list[Row]:
    """Return the condition of each event node, linearised: s(x, phi, p) = level where its segment begins."""
    impacts = tied(system, orbit)
    rows = list[Row]()
    for index, event in enumerate(orbit.mesh.events):
        at = arriving_row if index in impacts else node_row
        row = at(system, orbit, index, event.switch, free)
        rows.append(Row(row.value - event.level, row.nodes, row.outer, row.stages))
    return rows


def node_row(system: System, orbit: Orbit, index: int, switch: int, free: tuple[int, ...]) -> Row:
    """Return a switch s(x, phi, p) at the mesh point of an event node, in the modes of `modes_at`."""
    node, k = orbit.mesh.starts[index], len(orbit.phases)
    where = (orbit.nodes[node : node + 1], orbit.phases[index : index + 1], orbit.parameter)
    own = orbit.mesh.events[index].switch == switch
    side = modes_in(system, orbit, node - 1) if own else modes_at(system, orbit, index, switch)
    d_state, d_phase, d_parameter = guards_gradient(system, *where, side)
    nodes = np.zeros_like(orbit.nodes)
    nodes[node] = d_state[0, switch]
    outer = np.zeros(k + len(free))
    outer[index] = d_phase[0, switch]
    outer[k:] = d_parameter[0, switch, list(free)]
    return Row(float(guards(system, *where, side)[0, switch]), nodes, outer)
