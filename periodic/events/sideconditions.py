"""Side conditions at a change of events: how far a switch is from its level, how long a stretch is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.events.switchpolynomials import Dense, Extremum
from periodic.orbit.gradients import Points, Slopes, gathered
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.system import System


@dataclass(frozen=True)
class Clearance:
    """Side condition: the extremum of a switch nearest a phase lies at `level`, min of side * s."""

    switch: int
    side: int
    phase: float
    level: float = 0.0

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return the clearance side * s at the extremum, and its gradient, that at a fixed place."""
        at = Dense(system, orbit).nearest(self.switch, self.side, self.phase)
        row = clearance(system, orbit, at, self.side, free)
        return Row(row.value - self.level, row.nodes, row.outer, row.stages)


def clearance(system: System, orbit: Orbit, at: Extremum, side: int, free: tuple[int, ...]) -> Row:
    """Return side * s at a point of an orbit as a row."""
    phase = np.array([at.phase])
    basis = orbit.mesh.scheme.basis(np.array([at.theta]))
    state = basis @ orbit.knots[at.interval]
    points = Points(
        np.array([at.interval]),
        np.array([at.theta]),
        phase,
        basis @ orbit.knot_rates[at.interval],
        state,
        np.zeros((1, orbit.algebraic.shape[2])),
    )
    d_state, d_phase, d_parameter = (
        side * g[:, at.switch] for g in system.switch_gradient(state, phase, orbit.parameter)
    )
    slopes = Slopes(np.zeros_like(state), d_state, np.zeros((1, 0)), d_phase, d_parameter[0, list(free)])
    row = gathered(system, orbit, points, slopes, free)
    value = side * float(system.switch(state, phase, orbit.parameter)[0, at.switch])
    return Row(value, row.nodes, row.outer, row.stages)


@dataclass(frozen=True)
class Length:
    """Side condition: the segment that begins at an event node has a given length (rad)."""

    segment: int
    length: float

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return its length less the given one."""
        k = len(orbit.phases)
        outer = np.zeros(k + len(free))
        outer[self.segment] -= 1.0
        outer[(self.segment + 1) % k] += 1.0
        value = float(orbit.mesh.segment_lengths(orbit.phases)[self.segment]) - self.length
        return Row(value, np.zeros_like(orbit.nodes), outer)


@dataclass(frozen=True)
class Limit:
    """Side condition: side * (a switch) is `level` at an event node, which need not be its own."""

    node: int
    switch: int
    side: int
    level: float = 0.0

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return its value and gradient."""
        start, k = orbit.mesh.starts[self.node], len(orbit.phases)
        where = orbit.nodes[start : start + 1], orbit.phases[self.node : self.node + 1], orbit.parameter
        d_state, d_phase, d_parameter = system.switch_gradient(*where)
        nodes, outer = np.zeros_like(orbit.nodes), np.zeros(k + len(free))
        nodes[start] = d_state[0, self.switch]
        outer[self.node] = d_phase[0, self.switch]
        outer[k:] = d_parameter[0, self.switch, list(free)]
        value = float(system.switch(*where)[0, self.switch])
        row = Row(value, nodes, outer).scaled(self.side)
        return Row(row.value - self.level, row.nodes, row.outer)
