"""Side conditions at a change of events: how far a switch is from its level, how long a segment is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.events.eventrows import node_row
from periodic.events.impacts import arriving_row, slope_before
from periodic.events.modes import modes_in
from periodic.events.rates import before, rate_before
from periodic.events.switchpolynomials import Extremum, SwitchPolynomials
from periodic.orbit.gradients import Points, Slopes, gathered
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.system import System, guards, guards_gradient
from periodic.system.precision import difference_step

STEP = difference_step(order=2)
"""Step (rad) along the motion of differences of a switch's gradient."""


@dataclass(frozen=True)
class Clearance:
    """Side condition: the minimum of side * s nearest to a phase is `level`, s a switch."""

    switch: int
    side: int
    phase: float
    level: float = 0.0

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return side * s at the extremum less `level`, and the gradient at that place in its interval."""
        at = SwitchPolynomials(system, orbit).nearest(self.switch, self.side, self.phase)
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
    modes = modes_in(system, orbit, at.interval)
    d_state, d_phase, d_parameter = (
        side * g[:, at.switch] for g in guards_gradient(system, state, phase, orbit.parameter, modes)
    )
    slopes = Slopes(np.zeros_like(state), d_state, np.zeros((1, 0)), d_phase, d_parameter[0, list(free)])
    row = gathered(system, orbit, points, slopes, free)
    value = side * float(guards(system, state, phase, orbit.parameter, modes)[0, at.switch])
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
class Lengths:
    """Side condition: the total length (rad) of some segments, by the event nodes at which they begin."""

    segments: tuple[int, ...]
    length: float

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return their total length less the given one."""
        each = [Length(segment, 0.0).linearise(system, orbit, free) for segment in self.segments]
        row = sum(each[1:], each[0])
        return Row(row.value - self.length, row.nodes, row.outer)


@dataclass(frozen=True)
class Limit:
    """Side condition: side * (a switch) is `level` at an event node, which need not be its own.

    arriving: whether the state is the one before the impact there.
    """

    node: int
    switch: int
    side: int
    level: float = 0.0
    arriving: bool = False

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return its value and gradient."""
        at = arriving_row if self.arriving else node_row
        row = at(system, orbit, self.node, self.switch, free).scaled(self.side)
        return Row(row.value - self.level, row.nodes, row.outer, row.stages)


@dataclass(frozen=True)
class Speed:
    """Side condition: the switch of an impact, or a relay, arrives at its level with a given |ds/dtau|."""

    index: int
    speed: float

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return the speed less the given one."""
        interval, x, phase = before(orbit, self.index)
        event, rate = orbit.mesh.events[self.index], rate_before(orbit, self.index)[None]
        points = Points(np.array([interval]), np.ones(1), phase, rate, x, np.zeros((1, 0)))
        modes = modes_in(system, orbit, interval)
        ends = [
            guards_gradient(system, x + step * rate, phase + step, orbit.parameter, modes)
            for step in (STEP, -STEP)
        ]
        by_state, by_phase, by_parameter = (
            (ahead - back)[:, event.switch] / (2 * STEP) for ahead, back in zip(*ends, strict=True)
        )
        slope = guards_gradient(system, x, phase, orbit.parameter, modes)[0][:, event.switch]
        slopes = Slopes(slope, by_state, np.zeros((1, 0)), by_phase, by_parameter[0, list(free)])
        row = gathered(system, orbit, points, slopes, free).scaled(event.direction)
        return Row(speed(system, orbit, self.index) - self.speed, row.nodes, row.outer, row.stages)


def speed(system: System, orbit: Orbit, index: int) -> float:
    """Return |ds/dtau| with which a switch arrives at its impact."""
    return slope_before(system, orbit, index) * orbit.mesh.events[index].direction
