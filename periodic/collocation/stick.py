"""Sliding on a jump: dry friction that sticks (Filippov).

Where a switch s with a jump vanishes and the equations of both sides lead back to s = 0, the motion stays
there, with the part sigma of the jump, -1 < sigma < 1, that keeps s' = 0. It leaves where sigma reaches 1 or
-1. A stretch of sticking lies between an event node of s and one of a release; see `periodic.system.Jumping`.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from periodic.collocation.rates import rate_at
from periodic.collocation.sides import STUCK, group, sides, sticks
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System, jumps_of, slides_of

VANISHING = 0.1
"""Part of the bound of what matters below which a stretch of sticking is given up again."""

STEPS = 400
"""Steps in a period by which the end of a new stretch of sticking is looked for."""

WRONG = 1e-9
"""How far a switch, sigma or a phase may be on the wrong side."""

Passage = tuple[EventNode, float, float]


def passages(system: System, orbit: Orbit, least: float) -> list[Passage]:
    """Return event, phase and |slope| of the event nodes that jumps with sliding want.

    least: change of a switch by which a stretch of sticking matters.
    """
    return [passage for k in slides_of(system) for passage in _passages(system, orbit, k, least)]


def _passages(system: System, orbit: Orbit, switch: int, least: float) -> list[Passage]:
    events, new = orbit.mesh.events, []
    found: list[Passage] = []
    for j in (j for j in group(system, orbit.mesh, switch) if events[j].switch == switch):
        state, phase = orbit.nodes[orbit.mesh.starts[j]], float(orbit.phases[j])
        found.append((events[j], phase, 1.0))
        ending, stretch = sticks(system, orbit.mesh, switch, j), _stretch(system, orbit, switch, state, phase)
        if ending is None:
            new += [stretch.release] if stretch.release and stretch.size > least else []
        else:
            length = (orbit.phases[ending] - phase) % orbit.mesh.period
            if stretch.speed * length > VANISHING * least:
                found.append((events[ending], float(phase + length), 1.0))
    if new:  # beyond a crossing that should stick an orbit tells nothing
        return found + new
    for event, phase, _ in _missed(system, orbit, switch):
        found.append((event, phase, 1.0))
        stretch = _stretch(system, orbit, switch, orbit.state(np.array([phase]))[0], phase)
        found += [stretch.release] if stretch.release and stretch.size > least else []
    return found


def _sigma(system: System, state: Array, phase: float, orbit: Orbit, switch: int) -> float:
    up, _ = slides_of(system)[switch]
    return 1 + float(system.switch(state[None], np.array([phase]), orbit.parameter)[0, up])


def _missed(system: System, orbit: Orbit, switch: int) -> list[tuple[EventNode, float, float]]:
    """Changes of sign between collocation points that slip, with no event node of the switch between them.

    Event, phase, and the larger of the values before and after it.
    """
    tau, n = orbit.stage_phases.ravel(), orbit.stages.shape[2]
    values = system.switch(orbit.stages.reshape(-1, n), tau, orbit.parameter)[:, switch]
    side = np.repeat(sides(system, orbit.mesh)[:, jumps_of(system).index(switch)], orbit.mesh.scheme.ncol)
    values = np.where((np.abs(values) < WRONG) & (side != 0), side, values)
    tied = orbit.phases[group(system, orbit.mesh, switch)]
    points = [(t, s) for t, s, mode in zip(tau, values, side, strict=True) if mode != STUCK]
    found = []
    for (t, s), (later, other) in pairwise([*points, *((t + orbit.mesh.period, s) for t, s in points[:1])]):
        between = ((tied - t + WRONG) % orbit.mesh.period < later - t + 2 * WRONG).any()
        if s * other < 0 and not between:
            place = t + (later - t) * s / (s - other)
            found.append((EventNode(switch, 1 if other > 0 else -1), float(place), max(abs(s), abs(other))))
    return found


@dataclass(frozen=True)
class _Stretch:
    """Sticking that begins at a state: its release, None where it does not stick; how fast s would change
    if it slipped on instead, and how far until the release.
    """

    release: Passage | None
    speed: float
    size: float


def _stretch(system: System, orbit: Orbit, switch: int, state: Array, phase: float) -> _Stretch:
    """What sticking at a state comes to: Runge-Kutta steps until sigma reaches 1 or -1."""
    sigma = _sigma(system, state, phase, orbit, switch)
    if not abs(sigma) < 1:
        return _Stretch(None, 0.0, 0.0)
    up, down = slides_of(system)[switch]
    mode = np.zeros(len(jumps_of(system)))
    unknown = orbit.algebraic_guess(np.array([phase]))[0]
    gradient = system.switch_gradient(state[None], np.array([phase]), orbit.parameter)

    def rate(at: Array, when: float, side: float) -> Array:
        mode[jumps_of(system).index(switch)] = side
        return rate_at(system, orbit, at[None], np.zeros_like(at), unknown, np.array([when]), mode)

    slopes = [
        gradient[0][0, switch] @ rate(state, phase, way) + gradient[1][0, switch] for way in (1.0, -1.0)
    ]
    speed, h, x, tau = float(np.abs(slopes).min()), 2 * np.pi / STEPS, state, phase
    while tau < phase + orbit.mesh.period:
        x = x + h * rate(x + h / 2 * rate(x, tau, STUCK), tau + h / 2, STUCK)
        before, sigma, tau = sigma, _sigma(system, x, tau + h, orbit, switch), tau + h
        if abs(sigma) >= 1:
            way = 1 if sigma > 0 else -1
            place = tau - h * float(np.clip((sigma - way) / (sigma - before), 0, 1))
            return _Stretch(
                (EventNode(up if way > 0 else down, way), place, 1.0), speed, speed * (place - phase)
            )
    return _Stretch(None, speed, np.inf)


def shortfall(system: System, orbit: Orbit) -> float:
    """Return by how much, in s, an orbit is wrong that slips where it should stick, or the reverse."""
    worst = [0.0]
    for k, (up, _) in slides_of(system).items():
        worst += [size for _, _, size in _missed(system, orbit, k)]
        mode = sides(system, orbit.mesh)[:, jumps_of(system).index(k)]
        n = orbit.stages.shape[2]
        values = system.switch(orbit.stages.reshape(-1, n), orbit.stage_phases.ravel(), orbit.parameter)
        sigma = 1 + values[:, up].reshape(orbit.stage_phases.shape)
        worst.append(float((np.abs(sigma[mode == STUCK]) - 1 - WRONG).max(initial=0.0)))
        for j in group(system, orbit.mesh, k):
            if orbit.mesh.events[j].switch == k and sticks(system, orbit.mesh, k, j) is None:
                state, phase = orbit.nodes[orbit.mesh.starts[j]], float(orbit.phases[j])
                worst.append(_stretch(system, orbit, k, state, phase).size)
    return max(worst)
