"""Chatter that ends in rest on a wall: impacts without number in finite time, and what is left of them.

Each impact of the sequence leaves e times the speed of the one before. The first are event nodes; the last of
these has all that follow in it: it leads to where x, r(x), r(r(x)), ... tend to, at rest on the wall, at its
own phase. With w the speed after it and a = -s'' what presses, the bounces left out last

    2 w / a (1 + e + e^2 + ...) = 2 w / (a (1 - e)),

and the mean square of their speeds over a period T is 2 w^3 / (3 a T (1 - e^3)); both to the first order in
w, as a does not change in so short a time. The motion that leaves the wall later knows nothing of them.

References
----------
Nordmark & Piiroinen, Nonlinear Dynamics 58 (2009) 85.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.events.impacts import slope_before, tied
from periodic.events.modes import surface_of
from periodic.events.rates import before
from periodic.events.saltation import bounce, mapped
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, System


@dataclass(frozen=True)
class Tail:
    """The bounces that an impact leaves out: how long they last (rad), and the mean square of what they add.

    The latter is that of the states over a period, as they are scaled.
    """

    length: float
    square: float


def settling(system: System, orbit: Orbit) -> list[int]:
    """Return the impacts of an orbit, by their event nodes, after which it rests on the wall."""
    events = orbit.mesh.events
    return [i for i in tied(system, orbit) if (events[i].switch, STUCK) in events[i].modes]


def tail(system: System, orbit: Orbit, index: int) -> Tail:
    """Return what an impact after which an orbit rests leaves out; infinite where nothing presses."""
    event, (_, x, phase) = orbit.mesh.events[index], before(orbit, index)
    surface = surface_of(system, event.switch)
    assert surface.leaves is not None
    rest = mapped(system, [event], x, phase, orbit.parameter)[0]
    after, ratio = bounce(system, event.switch, x[0], float(phase[0]), orbit.parameter)
    pressed = -float(system.switch(rest, phase, orbit.parameter)[0, surface.leaves])
    if pressed <= 0 or ratio >= 1:
        return Tail(np.inf, np.inf)
    speed = ratio * abs(slope_before(system, orbit, index))
    thrown = float(((after - rest[0]) ** 2).sum())
    first = 2 * speed / pressed
    square = thrown * first / (3 * orbit.mesh.period * (1 - ratio**3))
    return Tail(first / (1 - ratio), square)


def neglected(system: System, orbit: Orbit) -> float:
    """Return the error of an orbit that rests at once, root mean square over peak to peak.

    Infinite where the bounces last longer than the rest: then it never rests.
    """
    square, lengths = 0.0, orbit.mesh.segment_lengths(orbit.phases)
    for index in settling(system, orbit):
        left = tail(system, orbit, index)
        square += left.square if left.length < lengths[index] else np.inf
    return float(np.sqrt(square)) / max(orbit.span(), 1e-300)
