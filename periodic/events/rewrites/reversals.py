"""Excursions about an event node of the speed: a mass that meets a stop turns back where its speed is 0.

There friction reverses or holds the mass, or a law changes that differs between loading and unloading.
Between the event nodes of such an excursion lie the node of the speed's zero and, where the mass sticks
there, the node of its release. All of them meet where the excursion ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.events.modes import group, of_held, returns, sliding, sticks, surface_of
from periodic.events.rewrites.sites import apart
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import AT_EXTREMUM, AT_LEVEL
from periodic.orbit.orbit import Orbit
from periodic.system import Kind, System


@dataclass(frozen=True)
class Reversal:
    """The event nodes at which an excursion begins and ends, and the nodes of the speed between them."""

    begin: int
    inside: tuple[int, ...]
    end: int


def reversals(system: System, orbit: Orbit) -> list[Reversal]:
    """Return the excursions of an orbit that turn back at an event node of another switch."""
    events, own, found = orbit.mesh.events, returns(system), list[Reversal]()
    if len(events) < 3:
        return []
    for i, first in enumerate(events):
        ahead = [(i + m) % len(events) for m in range(1, 4)]
        inner = events[ahead[0]].switch
        if first.switch not in own or not (inner in own or sliding(system, inner) is not None):
            continue
        inside = ahead[:1] if stuck_until(system, orbit, ahead[0]) is None else ahead[:2]
        last = ahead[len(inside)]
        closes = events[last].switch == first.switch and events[last].direction == -first.direction
        if closes and SwitchPolynomials(system, orbit).turns(first.switch, inside[0]):
            found.append(Reversal(i, tuple(inside), last))
    return found


def stuck_until(system: System, orbit: Orbit, node: int) -> int | None:
    """Return the event node of the release where sticking of a mass begins at one.

    A slider that sticks is strained: it does not hold the mass.
    """
    switch = orbit.mesh.events[node].switch
    return sticks(system, orbit.mesh, switch, node) if switch in _holding(system) else None


def _holding(system: System) -> list[int]:
    """The guards of surfaces that hold masses."""
    return [k for k in of_held(system) if surface_of(system, k).kind != Kind.SLIDER]


def held(system: System, orbit: Orbit, switch: int, phase: float) -> tuple[float, float]:
    """Return where sticking that holds a switch about a phase begins and ends; the phase twice if none."""
    for jump in _holding(system):
        for j in group(system, orbit.mesh, jump):
            release = stuck_until(system, orbit, j)
            if release is None:
                continue
            length = float((orbit.phases[release] - orbit.phases[j]) % orbit.mesh.period)
            since = float((phase - orbit.phases[j] + AT_EXTREMUM) % orbit.mesh.period) - AT_EXTREMUM
            if since <= length + AT_EXTREMUM and SwitchPolynomials(system, orbit).turns(switch, j):
                return phase - since, phase - since + length
    return phase, phase


def short_of(system: System, orbit: Orbit, switch: int, phase: float) -> float:
    """Return how far short of its level an extremum is held: 0 except where friction reverses the motion."""
    begin, end = held(system, orbit, switch, phase)
    events = zip(orbit.mesh.events, orbit.phases, strict=True)
    far = [apart(begin, float(tau), orbit) for e, tau in events if sliding(system, e.switch) is not None]
    if begin == end and min(far, default=np.inf) > AT_EXTREMUM:
        return 0.0
    return AT_LEVEL * float(np.abs(SwitchPolynomials(system, orbit).knots[:, :, switch]).max())
