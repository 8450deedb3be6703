"""Sliding on a jump: dry friction that sticks (Filippov).

Where a switch s with a jump vanishes and the equations of both sides lead back to s = 0, the motion stays
there, with the part sigma of the jump, -1 < sigma < 1, that keeps s' = 0. It leaves where sigma reaches 1 or
-1. A stretch of sticking lies between an event node of s and one of a release; see `periodic.system.Jumping`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from periodic.events.modes import column, group, modes_at, of_kind, releases, sides, sticks, surface_of
from periodic.events.rates import rate_at, slope_at
from periodic.events.violations import Breach, between_nodes
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import HELD, STUCK, Kind, System, guards

VANISHING = 0.1
"""Part of the bound of what matters below which a stretch of sticking is given up again."""

H = 2 * np.pi / 400
"""Step (rad) by which the end of a new stretch of sticking is looked for."""

GAMMA = 1 - 1 / np.sqrt(2)
"""Of ROS2."""

WRONG = 1e-9
"""How far a switch, sigma or a phase may be on the wrong side."""

Passage = tuple[EventNode, float, float]


def passages(system: System, orbit: Orbit, least: float) -> list[Passage]:
    """Return event, phase and |slope| of the event nodes that jumps with sliding want.

    least: change of a switch by which a stretch of sticking matters.
    """
    held, sliders = ([s.switch for s in of_kind(system, kind)] for kind in (Kind.SLIDING, Kind.SLIDER))
    if held and orbit.mesh.events and not any(v.breach is Breach.MODE for v in between_nodes(system, orbit)):
        sliders, held = [*sliders, *held], []
    own = [j for k in sliders for j in _own(system, orbit, k)]
    kept = [(orbit.mesh.events[j], float(orbit.phases[j]), 1.0) for j in own]
    return kept + [passage for k in held for passage in _passages(system, orbit, k, least)]


def _own(system: System, orbit: Orbit, switch: int) -> list[int]:
    """The event nodes at which a guard or a release of its surface passes its level."""
    surface = surface_of(system, switch)
    own = (surface.switch, *(surface.releases or ()))
    return [j for j, event in enumerate(orbit.mesh.events) if event.switch in own]


def stop(switch: int, direction: int) -> EventNode:
    """Return the event node at which a motion that passes a switch in a direction begins to be held there."""
    return EventNode(switch, direction, modes=((switch, STUCK),))


def _passages(system: System, orbit: Orbit, switch: int, least: float) -> list[Passage]:
    events, new = orbit.mesh.events, []
    found: list[Passage] = []
    gone = _vanished(system, orbit, switch, VANISHING * least)
    for j in _own(system, orbit, switch):
        state, phase = orbit.nodes[orbit.mesh.starts[j]], float(orbit.phases[j])
        if events[j].switch != switch or j in gone:
            found += [(events[j], phase, 1.0)] if j not in gone else []
            continue
        ending = sticks(system, orbit.mesh, switch, j)
        passing = EventNode(switch, events[j].direction)
        if ending is None:
            stretch = _stretch(system, orbit, switch, state, phase)
            begins = stretch.release is not None and stretch.size > least
            found.append((stop(switch, passing.direction) if begins else passing, phase, 1.0))
            new += [stretch.release] if begins and stretch.release else []
            continue
        found.append((passing if ending in gone else events[j], phase, 1.0))
        if ending not in gone:
            slip = _slip(system, orbit, switch, j)
            found += slip.passages if slip.size > least else ()
    if new:  # beyond a crossing that should stick an orbit tells nothing
        return found + new
    held = -np.inf
    for event, phase in _missed(system, orbit, switch):
        if phase < held:  # noise of a stop, or the way back from beyond it
            continue
        stretch = _stretch(system, orbit, switch, orbit.state(np.array([phase]))[0], phase)
        if stretch.release is None:
            found.append((event, phase, 1.0))
        else:
            begun = (stop(switch, event.direction), phase, 1.0)
            found += [begun, stretch.release] if stretch.size > least else []
            held = stretch.release[1]
    return found


def _vanished(system: System, orbit: Orbit, switch: int, least: float) -> set[int]:
    """Event nodes about stretches of sticking, and of slipping between two of them, too short to matter.

    A stretch of sticking that leads on to the side it came for leaves the crossing.
    """
    events, own = orbit.mesh.events, group(system, orbit.mesh, switch)
    gone: set[int] = set()
    for j, after in zip(own, [*own[1:], *own[:1]], strict=True):
        length = (orbit.phases[after] - orbit.phases[j]) % orbit.mesh.period
        if sticks(system, orbit.mesh, switch, j) == after:
            if min(_speeds(system, orbit, switch, j)) * length <= least:
                gone |= {after} if events[after].direction == events[j].direction else {j, after}
        elif events[j].switch != switch and sticks(system, orbit.mesh, switch, after) is not None:
            values, _ = _values(system, orbit, switch)
            inside = (orbit.stage_phases.ravel() - orbit.phases[j]) % orbit.mesh.period < length
            gone |= {j, after} if np.abs(values[inside]).max() <= least else set()
    return gone


def _sigma(system: System, state: Array, phase: float, orbit: Orbit, switch: int) -> float:
    return float(_sigmas(system, orbit, switch, state[None], np.array([phase]))[0])


def _sigmas(system: System, orbit: Orbit, switch: int, state: Array, phase: Array) -> Array:
    """sigma at several states (K, n); infinite where nothing jumps, as without friction."""
    up, down = releases(system, switch)
    values = guards(system, state, phase, orbit.parameter, modes_at(system, orbit, phase))
    jump = values[:, down] - values[:, up]
    held = np.where(jump > 0, jump, 1.0)
    return np.where(jump > 0, (values[:, up] + values[:, down]) / held, np.inf)


def _missed(system: System, orbit: Orbit, switch: int) -> list[tuple[EventNode, float]]:
    """Changes of sign between collocation points that slip, with no event node of the switch between them."""
    tau = orbit.stage_phases.ravel()
    values, side = _values(system, orbit, switch)
    values = np.where((np.abs(values) < WRONG) & (side != 0), side, values)
    tied = orbit.phases[group(system, orbit.mesh, switch)]
    points = [(t, s) for t, s, mode in zip(tau, values, side, strict=True) if mode not in (STUCK, HELD)]
    found = []
    for (t, s), (later, other) in pairwise([*points, *((t + orbit.mesh.period, s) for t, s in points[:1])]):
        between = ((tied - t + WRONG) % orbit.mesh.period < later - t + 2 * WRONG).any()
        if s * other < 0 and not between:
            place = t + (later - t) * s / (s - other)
            found.append((EventNode(switch, 1 if other > 0 else -1), float(place)))
    return found


def _values(system: System, orbit: Orbit, switch: int) -> tuple[Array, Array]:
    """A switch at the collocation points, and the side that the equations are on there."""
    flat = (-1, orbit.stages.shape[2])
    values = system.switch(orbit.stages.reshape(flat), orbit.stage_phases.ravel(), orbit.parameter)
    mode = sides(system, orbit)[:, column(system, switch)]
    return values[:, switch], np.repeat(mode, orbit.mesh.scheme.ncol)


@dataclass(frozen=True)
class _Stretch:
    """Sticking that begins at a state: its release, None where it does not stick, and how far s would go if
    it slipped on instead until then.
    """

    release: Passage | None = None
    size: float = 0.0


@dataclass(frozen=True)
class _Slip:
    """A slip within a stretch of sticking: its release and the next stop, and how far s goes."""

    passages: tuple[Passage, ...] = ()
    size: float = 0.0


def _slip(system: System, orbit: Orbit, switch: int, node: int) -> _Slip:
    """The first slip that is missing in the stretch of sticking that begins at an event node.

    It ends about where the integral of sigma - 1, a parabola from its passage on, comes back to 0.
    """
    start, (up, down) = orbit.mesh.starts[node], releases(system, switch)
    count = len(orbit.mesh.breaks[node]) - 1
    tau = orbit.stage_phases[start : start + count].ravel()
    state = orbit.stages[start : start + count].reshape(len(tau), -1)
    sigma = _sigmas(system, orbit, switch, state, tau)
    past = np.flatnonzero(np.abs(sigma[:-1]) > 1 + WRONG)
    if not past.size or past[0] == 0:
        return _Slip()
    first, way = past[0], 1 if sigma[past[0]] > 0 else -1
    back = next((i for i in range(first, len(tau)) if way * sigma[i] <= 1), None)
    if back is None:
        return _Slip()

    def passed(i: int) -> float:
        return float(tau[i - 1] + (tau[i] - tau[i - 1]) * (way - sigma[i - 1]) / (sigma[i] - sigma[i - 1]))

    begin, end = passed(first), passed(back)
    release = (EventNode(up if way > 0 else down, way), begin, 1.0)
    stopped = (stop(switch, -way), min(begin + 1.5 * (end - begin), (end + float(tau[-1])) / 2), 1.0)
    excess = float((way * sigma[first:back] - 1).max())
    speed = sum(_speeds(system, orbit, switch, node)) / 2
    return _Slip((release, stopped), excess * speed * (end - begin))


def _stretch(system: System, orbit: Orbit, switch: int, state: Array, phase: float) -> _Stretch:
    """What sticking at a state comes to: steps of Rosenbrock's method until sigma reaches 1 or -1."""
    sigma = _sigma(system, state, phase, orbit, switch)
    if not abs(sigma) < 1:
        return _Stretch()
    (up, down), motion = releases(system, switch), _Motion(system, orbit, switch, phase)
    try:
        speed, held = min(motion.speeds(state, phase)), motion.steps(state, phase)
    except np.linalg.LinAlgError:  # the equations do not determine the rates, as without a mass
        return _Stretch()
    x, tau = state, phase
    while tau < phase + orbit.mesh.period:
        x = held(x, tau)
        before, sigma, tau = sigma, _sigma(system, x, tau + H, orbit, switch), tau + H
        if abs(sigma) >= 1:
            way = 1 if sigma > 0 else -1
            place = tau - H * float(np.clip((sigma - way) / (sigma - before), 0, 1))
            release = (EventNode(up if way > 0 else down, way), place, 1.0)
            return _Stretch(release, speed * (place - phase))
    return _Stretch(None, np.inf)


@dataclass(frozen=True)
class _Motion:
    """Rates at a jump, on given sides of it."""

    system: System
    orbit: Orbit
    switch: int
    phase: float

    def rate(self, state: Array, phase: float, side: float) -> Array:
        """x' there."""
        guess, at = np.zeros_like(state), np.array([phase])
        return rate_at(self.system, self.orbit, state[None], guess, self._unknown, at, self._mode(side))

    def steps(self, state: Array, phase: float) -> Callable[[Array, float], Array]:
        """Steps of H while it sticks, of second order and damped however fast the system's modes are.

        ROS2 (Verwer, Spee, Blom & Hundsdorfer, SIAM J. Sci. Comput. 20 (1999) 1456), which keeps its order
        with the slope of where the sticking begins.
        """
        at, mode, rate = np.array([phase]), self._mode(STUCK), self.rate(state, phase, STUCK)
        slope = slope_at(self.system, self.orbit, state[None], rate, self._unknown, at, mode)
        damped = np.linalg.inv(np.eye(len(state)) - GAMMA * H * slope)

        def step(x: Array, tau: float) -> Array:
            first = damped @ self.rate(x, tau, STUCK)
            second = damped @ (self.rate(x + H * first, tau + H, STUCK) - 2 * first)
            return np.asarray(x + H / 2 * (3 * first + second))

        return step

    @property
    def _unknown(self) -> Array:
        return self.orbit.algebraic_guess(np.array([self.phase]))[0]

    def _mode(self, side: float) -> Array:
        mode = modes_at(self.system, self.orbit, np.array([self.phase]))[0]
        mode[column(self.system, self.switch)] = side
        return mode

    def speeds(self, state: Array, phase: float) -> tuple[float, float]:
        """|ds/dtau| on either side."""
        at, orbit = np.array([phase]), self.orbit
        side = modes_at(self.system, orbit, np.array([self.phase]))
        values = guards(self.system, state[None], at, orbit.parameter, side)[0]
        up, down = releases(self.system, self.switch)
        return abs(float(values[up])), abs(float(values[down]))


def _speeds(system: System, orbit: Orbit, switch: int, node: int) -> tuple[float, float]:
    """|ds/dtau| on either side of the jump at an event node."""
    phase = float(orbit.phases[node])
    return _Motion(system, orbit, switch, phase).speeds(orbit.nodes[orbit.mesh.starts[node]], phase)
