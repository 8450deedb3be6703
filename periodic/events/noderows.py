"""Event nodes: mesh points that lie where a switch passes a level, so that kinks fall between intervals."""

from __future__ import annotations

import numpy as np

from periodic.events.impacts import event_row, tied
from periodic.events.modes import modes_in
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.system import System, guards, guards_gradient


def event_rows(system: System, orbit: Orbit, free: tuple[int, ...]) -> list[Row]:
    """Return the condition of each event node, linearised: s(x, phi, p) = level where its segment begins."""
    impacts = tied(system, orbit)
    rows = (event_row if index in impacts else _row for index in range(len(orbit.phases)))
    return [row(system, orbit, index, free) for index, row in enumerate(rows)]


def _row(system: System, orbit: Orbit, index: int, free: tuple[int, ...]) -> Row:
    node, event, k = orbit.mesh.starts[index], orbit.mesh.events[index], len(orbit.phases)
    where = (orbit.nodes[node : node + 1], orbit.phases[index : index + 1], orbit.parameter)
    side = modes_in(system, orbit, node - 1)
    d_state, d_phase, d_parameter = guards_gradient(system, *where, side)
    nodes = np.zeros_like(orbit.nodes)
    nodes[node] = d_state[0, event.switch]
    outer = np.zeros(k + len(free))
    outer[index] = d_phase[0, event.switch]
    outer[k:] = d_parameter[0, event.switch, list(free)]
    return Row(float(guards(system, *where, side)[0, event.switch]) - event.level, nodes, outer)
