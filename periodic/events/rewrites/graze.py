"""Impacts begin and end where an orbit grazes: the switch of an impact just touches its level.

On one side the orbit passes the level by, on the other it has an impact, whose speed v = |ds/dtau| grows from
0. With the impact the branch is smooth in v, not in the parameter, which often turns there: the multipliers
are without bound as v falls to 0 (Nordmark, J. Sound Vib. 145 (1991) 279). So a branch is followed without
the impact up to the touch, and with it from a small speed on. Compare `periodic.events.rewrites.touch`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from periodic.events.sideconditions import Clearance
from periodic.events.switchpolynomials import Dense, Extremum
from periodic.events.impacts import slope_before, tied
from periodic.events.rates import before, rate_before
from periodic.events.rewrites.touch import index_of, ordered
from periodic.correction.change import Beyond
from periodic.orbit.gradients import Points, Slopes, gathered
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.redistribution import redistribute
from periodic.orbit.row import Row
from periodic.system import System, resets_of

SLOW = (1e-2, 1e-3, 1e-4)
"""Speeds at which patterns are exchanged, tried in turn, as a part of how far the switch ranges."""

SLOWER = (1e-5, 1e-6)
"""Speeds tried where those lead to none, among impacts as slow, or lie beyond more folds than one."""

VANISHING = 0.5
"""An impact of which a step would leave this part of its speed, by its tangent, may end within the step."""

STEP = 1e-4
"""Step (rad) along the motion of differences of a switch's gradient."""


@dataclass(frozen=True)
class Speed:
    """Side condition: the switch of an impact arrives at its level with a given |ds/dtau|."""

    index: int
    speed: float

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return the speed less the given one."""
        interval, x, phase = before(orbit, self.index)
        event, rate = orbit.mesh.events[self.index], rate_before(orbit, self.index)[None]
        points = Points(np.array([interval]), np.ones(1), phase, rate, x, np.zeros((1, 0)))
        ends = [
            system.switch_gradient(x + step * rate, phase + step, orbit.parameter) for step in (STEP, -STEP)
        ]
        by_state, by_phase, by_parameter = (
            (ahead - back)[:, event.switch] / (2 * STEP) for ahead, back in zip(*ends, strict=True)
        )
        slope = system.switch_gradient(x, phase, orbit.parameter)[0][:, event.switch]
        slopes = Slopes(slope, by_state, np.zeros((1, 0)), by_phase, by_parameter[0, list(free)])
        row = gathered(system, orbit, points, slopes, free).scaled(event.direction)
        return Row(_speed(system, orbit, self.index) - self.speed, row.nodes, row.outer, row.stages)


@dataclass(frozen=True)
class FirstImpact:
    """The switch of an impact touches its level: beyond, the orbit has an impact there."""

    system: System
    extremum: Extremum
    part: float
    shortest: float

    touches = True
    otherwise = None
    strict = True
    final = True

    @property
    def condition(self) -> Clearance:
        """The touch."""
        at = self.extremum
        return Clearance(at.switch, -self.system.switches[at.switch].direction, at.phase)

    @property
    def name(self) -> str:
        """Which switch touches."""
        return f"{self.system.switches[self.extremum.switch].name} is touched"

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield meshes with an event node where the switch touches, and slow impacts."""
        condition, k = self.condition, self.extremum.switch
        at = Dense(system, orbit).nearest(k, condition.side, condition.phase)
        pair = EventNode(k, -condition.side), at.phase
        old = zip(orbit.mesh.events, map(float, orbit.phases), strict=True)
        events, phases = ordered([*old, pair], orbit)
        mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
        for slow in (*SLOW, *SLOWER):
            held = Speed(index_of(events, phases, pair, orbit), slow * _range(system, orbit, k))
            yield Beyond(mesh, phases, held, touches=False, spare=slow in SLOWER)


@dataclass(frozen=True)
class LastImpact:
    """An impact becomes as slow as `slow`: beyond, the orbit passes the level by."""

    system: System
    index: int
    event: EventNode
    slow: float
    speed: float
    part: float
    shortest: float

    touches = False
    otherwise = None
    strict = False

    @property
    def final(self) -> bool:
        """Whether impacts are never looked at when slower."""
        return self.slow == SLOW[-1]

    @property
    def condition(self) -> Speed:
        """How slow it becomes."""
        return Speed(self.index, self.speed)

    @property
    def name(self) -> str:
        """Which impact ends."""
        return f"the impact at {self.system.switches[self.event.switch].name} has no speed left"

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield the mesh without the impact, held at the touch."""
        both = list(zip(orbit.mesh.events, map(float, orbit.phases), strict=True))
        (_, phase) = both.pop(self.index)
        events, phases = ordered(both, orbit)
        mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
        yield Beyond(mesh, phases, Clearance(self.event.switch, -self.event.direction, phase), True)


def change(system: System, before: Orbit, after: Orbit, shortest: float) -> FirstImpact | LastImpact | None:
    """Return the first touch between two orbits on one mesh at which an impact begins or ends, if any.

    `after` may be a guess.
    """
    if not resets_of(system):
        return None
    first, last = _first(system, before, after, shortest), _last(system, before, after, shortest)
    return min((c for c in (first, last) if c is not None), key=lambda c: c.part, default=None)


def _first(system: System, before: Orbit, after: Orbit, shortest: float) -> FirstImpact | None:
    if not bool((after.mesh.segment_lengths(after.phases) > 0).all()):
        return None
    dense, base, found = Dense(system, after), Dense(system, before), list[FirstImpact]()
    for k in resets_of(system):
        side = -system.switches[k].direction
        for low in dense.unseen(k, side):
            # The orbit before may come near its level nowhere but at its impacts: then this is a new turn.
            clear = abs(base.nearest(k, side, low.phase).value) if base.minima(k, side) else 0.0
            found.append(FirstImpact(system, low, clear / (clear + abs(low.value)), shortest))
    return min(found, key=lambda first: first.part, default=None)


def _last(system: System, before: Orbit, after: Orbit, shortest: float) -> LastImpact | None:
    found = list[LastImpact]()
    for i in tied(system, before):
        event, now, then = before.mesh.events[i], _speed(system, before, i), _speed(system, after, i)
        size = _range(system, before, event.switch)
        slow = next((s for s in SLOW if s * size < VANISHING * now), None)
        if slow is None or then > max(VANISHING * now, slow * size):
            continue
        part = min((now - slow * size) / (now - then), 1.0)
        found.append(LastImpact(system, i, event, slow, slow * size, part, shortest))
    return min(found, key=lambda last: last.part, default=None)


def _speed(system: System, orbit: Orbit, index: int) -> float:
    return slope_before(system, orbit, index) * orbit.mesh.events[index].direction


def _range(system: System, orbit: Orbit, switch: int) -> float:
    """How far a switch is away from its level at the most."""
    return float(np.abs(Dense(system, orbit).knots[:, :, switch]).max())
