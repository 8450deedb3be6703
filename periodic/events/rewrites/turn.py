"""An excursion ends about an event node of dry friction: see `periodic.events.rewrites.turns`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from periodic.events.sideconditions import Length, Limit
from periodic.events.rewrites.touch import ALIKE, SHORT, VANISHING, index_of, ordered
from periodic.events.rewrites.turns import Turn, short_of, turns
from periodic.correction.change import Beyond
from periodic.orbit.orbit import Orbit
from periodic.orbit.redistribution import redistribute
from periodic.system import System


@dataclass(frozen=True)
class LastTurn:
    """An excursion becomes so short before the motion turns in it that it may end."""

    system: System
    turn: Turn
    length: float
    part: float
    shortest: float

    touches = False
    otherwise = None
    strict = False

    @property
    def final(self) -> bool:
        """Whether excursions are never looked at when shorter."""
        return self.length <= SHORT[-1]

    @property
    def condition(self) -> Length:
        """How short it becomes."""
        return Length(self.turn.begin, self.length)

    @property
    def name(self) -> str:
        """What ends."""
        return "an excursion ends where friction turns the motion"

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield the mesh without the excursion, and without those as short, held at the touch."""
        length, events = orbit.mesh.segment_lengths(orbit.phases), orbit.mesh.events
        ends = [
            j
            for turn in turns(system, orbit)
            if abs(length[turn.begin] / self.length - 1) < ALIKE
            for j in (turn.begin, turn.end)
        ]
        first, switch = events[self.turn.begin], events[self.turn.begin].switch
        at = self.turn.inside[0]
        for gone in dict.fromkeys((tuple(ends), (self.turn.begin, self.turn.end))):
            kept = [(events[m], float(orbit.phases[m])) for m in range(len(events)) if m not in gone]
            others, phases = ordered(kept, orbit)
            mesh = redistribute(orbit, orbit.mesh.ntst, others, phases, self.shortest)
            node = index_of(others, phases, (events[at], float(orbit.phases[at])), orbit)
            left = short_of(system, orbit, switch, float(orbit.phases[at]))
            yield Beyond(mesh, phases, Limit(node, switch, -first.direction, left), True)


def change(system: System, before: Orbit, after: Orbit, shortest: float) -> LastTurn | None:
    """Return the first such end between two orbits on one mesh, if any; `after` may be a guess."""
    found = []
    now, then = before.mesh.segment_lengths(before.phases), after.mesh.segment_lengths(after.phases)
    for turn in turns(system, before):
        i = turn.begin
        half = VANISHING * float(now[i])
        nearest = next((length for length in SHORT if length < half), half)
        if then[i] <= max(half, nearest):
            part = (now[i] ** 2 - nearest**2) / (2 * now[i] * (now[i] - then[i]))
            found.append(LastTurn(system, turn, nearest, min(float(part), 1.0), shortest))
    return min(found, key=lambda end: end.part, default=None)
