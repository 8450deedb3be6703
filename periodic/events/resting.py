"""Complete chatter: infinitely many impacts in finite time, after which the motion rests on a wall.

Each impact reduces the speed by the factor e. The first impacts are event nodes; the last of these stands for
all that follow: it maps the state to the limit of x, r(x), r(r(x)), ..., at rest on the wall, at its own
phase. With w the speed after it and a = -s'' the acceleration onto the wall, the bounces left out last

    2 w / a (1 + e + e^2 + ...) = 2 w / (a (1 - e)),

and the mean square of their speeds over a period T is 2 w^3 / (3 a T (1 - e^3)); both to the first order in
w, as a does not change in so short a time. The motion that leaves the wall later does not depend on them.

The rest ends where a = 0, a time L after that impact. Where the bounces last about as long, a falls on the
way, as a (1 - t/L): they are complete only if the first of them takes less than a part of L (`longest`), else
the mass leaves the wall amid the last of them and is never at rest.

Inertia couples other coordinates to this one. With u its speed before the first of these impacts, and with
impulses over the one that changes this speed by 1, all impacts together give (1 + e) u/(1 - e). The force of
the wall at rest gives 2 e u/(1 - e) in the same time. The difference is u, the impulse that stops this
coordinate. So the impulse u at once, and the force at rest from then on, move the other coordinates as all
the bounces do, to the first order.

References
----------
Nordmark & Piiroinen, Nonlinear Dynamics 58 (2009) 85.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from periodic.events.impacts import slope_before, tied
from periodic.events.modes import surface_of
from periodic.events.rates import before
from periodic.events.rewrites.sites import apart, ordered
from periodic.events.saltation import bounce, mapped
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import STUCK, System

SHORT = 0.1
"""Error of the bounces still left out, in tolerances, once more of them have become event nodes."""


@dataclass(frozen=True)
class Tail:
    """The bounces left out at an impact: how long they last (rad), and the mean square of their states.

    square: of the scaled states less those at rest, over a period. first: how long the first bounce lasts;
    ratio: e; thrown (n,): the states after a single impact less those at rest.
    """

    length: float
    square: float
    first: float
    ratio: float
    thrown: Array


def settling(system: System, orbit: Orbit) -> list[int]:
    """Return the impacts of an orbit, by their event nodes, after which it rests on the wall."""
    events = orbit.mesh.events
    return [i for i in tied(system, orbit) if (events[i].switch, STUCK) in events[i].modes]


def tail(system: System, orbit: Orbit, index: int) -> Tail:
    """Return the bounces left out at an impact before rest; infinite where nothing presses, or e >= 1."""
    event, (_, x, phase) = orbit.mesh.events[index], before(orbit, index)
    surface = surface_of(system, event.switch)
    assert surface.leaves is not None
    rest = mapped(system, [event], x, phase, orbit.parameter)[0]
    after, ratio = bounce(system, event.switch, x[0], float(phase[0]), orbit.parameter)
    pressed = -float(system.switch(rest, phase, orbit.parameter)[0, surface.leaves])
    if pressed <= 0 or ratio >= 1:
        return Tail(np.inf, np.inf, np.inf, ratio, after - rest[0])
    thrown = after - rest[0]
    first = 2 * ratio * abs(slope_before(system, orbit, index)) / pressed
    square = float((thrown**2).sum()) * first / (3 * orbit.mesh.period * (1 - ratio**3))
    return Tail(first / (1 - ratio), square, first, ratio, thrown)


def longest(ratio: float) -> float:
    """Return the longest first bounce 2 w/a from which chatter is complete, in parts of the rest, 0 < e < 1.

    With s'' = -a (1 - t/L) a bounce that begins a time r before the rest ends, and takes sigma r, has the
    speeds w = (a/L) r^2 (sigma/2 - sigma^2/6) and (a/L) r^2 (sigma/2 - sigma^2/3) at its ends; the next one
    has r (1 - sigma) left. Its sigma is the same where

        (3 - sigma) (1 - sigma)^2 = e (3 - 2 sigma);

    from less it goes to 0, from more it grows. 2 w/a = (sigma - sigma^2/3) r.

    Parameters
    ----------
    ratio : float
        e, the coefficient of restitution.

    Returns
    -------
    float
        2 w/(a L) of that sigma.
    """
    roots = np.polynomial.Polynomial([3 * (1 - ratio), 2 * ratio - 7, 5.0, -1.0]).roots()
    sigma = float(roots.real[np.argmin(np.abs(roots))])
    return sigma - sigma**2 / 3


def neglected(system: System, orbit: Orbit) -> float:
    """Return the error due to the bounces left out, root mean square over peak to peak.

    Infinite where the bounces do not end before the rest does: then the motion never comes to rest.
    """
    resting = settling(system, orbit)
    if not resting:
        return 0.0
    square, lengths = 0.0, orbit.mesh.segment_lengths(orbit.phases)
    for index in resting:
        left = tail(system, orbit, index)
        square += left.square if left.first < longest(left.ratio) * lengths[index] else np.inf
    return float(np.sqrt(square)) / max(orbit.span(), 1e-300)


def lengthened(system: System, orbit: Orbit, tolerance: float) -> tuple[tuple[EventNode, ...], Array] | None:
    """Return event nodes and phases with more bounces, where the error of those left out is too large.

    Else None. Each bounce lasts e times as long as the one before: k more reduce the error by e^(3k/2).
    """
    error, least = neglected(system, orbit), SHORT * tolerance
    if not tolerance < error < np.inf:
        return None
    nodes = list(zip(orbit.mesh.events, map(float, orbit.phases), strict=True))
    for index in settling(system, orbit):
        left, (event, phase) = tail(system, orbit, index), nodes[index]
        own = np.sqrt(left.square) / max(orbit.span(), 1e-300)
        count = int(np.ceil(np.log(own / least) / (-1.5 * np.log(left.ratio)))) if own > least else 0
        ends = phase + left.first * (1 - left.ratio ** np.arange(count + 1)) / (1 - left.ratio)
        plain = tuple(pair for pair in event.modes if pair != (event.switch, STUCK))
        nodes[index] = (replace(event, modes=plain) if count else event), phase
        between = [(replace(event, modes=()), float(end)) for end in ends[1:-1]]
        last = [(replace(event, modes=((event.switch, STUCK),)), float(ends[-1]))] if count else []
        nodes += [*between, *last]
    return ordered(nodes, orbit)


def bounced(system: System, orbit: Orbit, guess: Orbit) -> Orbit:
    """Return a guess on the mesh of `lengthened` with the bounces in it; the speed is linear in each."""
    nodes, stages, mesh = guess.nodes.copy(), guess.stages.copy(), guess.mesh
    for index in settling(system, orbit):
        left, switch = tail(system, orbit, index), orbit.mesh.events[index].switch
        thrown, at = left.thrown, _nearest(guess, switch, float(orbit.phases[index]))
        while (switch, STUCK) not in mesh.events[at].modes:
            for k, falling in _falling(guess, at):
                nodes[k] += falling[0] * thrown
                stages[k] += falling[1:, None] * thrown
            thrown, at = left.ratio * thrown, (at + 1) % len(mesh.events)
    nodes[-1] = nodes[0]
    return replace(guess, nodes=nodes, stages=stages)


def _falling(orbit: Orbit, node: int) -> Iterator[tuple[int, Array]]:
    """Yield the intervals from an event node to the next, with a line from 1 to -1 at their knots."""
    parts, first = orbit.mesh.breaks[node], int(orbit.mesh.starts[node])
    knots = np.append(0.0, orbit.mesh.scheme.points)
    for k, (begin, end) in enumerate(pairwise(parts)):
        yield first + k, 1 - 2 * (begin + (end - begin) * knots)


def _nearest(orbit: Orbit, switch: int, phase: float) -> int:
    """The event node of a switch nearest to a phase."""
    own = (i for i, event in enumerate(orbit.mesh.events) if event.switch == switch)
    return min(own, key=lambda i: apart(float(orbit.phases[i]), phase, orbit))
