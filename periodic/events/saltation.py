"""Saltation: how perturbations at fixed tau pass an event at which the state or its rates jump.

With x+ = r(x-, tau, p) where s(x, tau, p) = 0, and x' = f- before and f+ after,

    dx+ = r_x dx- + r_p dp + (f+ - r_x f- - r_tau) (s_x dx- + s_p dp) / (s_x f- + s_tau),

the linearisation of the flow through an event whose time follows the state (di Bernardo et al.,
Piecewise-smooth Dynamical Systems, 2008, 2.5).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from periodic.events.modes import modes_in, sides
from periodic.events.rates import before, rate_at, rate_before
from periodic.orbit.jump import Jump
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import STUCK, Resetting, System, guards_gradient, resets_of

STEP = 1e-3
"""Step of differences in each argument, as a part of its size: they are of the fourth order."""

STENCIL = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))
"""Central difference of the fourth order: steps and their weights."""

Saltation = Callable[[Array, Array, Array], Array]
"""(x- (1, n), tau (1,), p) -> matrix (n, n+q): dx+ from (dx-, dp) at fixed tau."""


def saltation(system: System, orbit: Orbit, index: int, free: tuple[int, ...]) -> Saltation:
    """Return the saltation matrix at an event node of an orbit, as a function of where the event is.

    It raises numpy.linalg.LinAlgError where there are no rates, and where the switch is at rest.
    """
    event, start = orbit.mesh.events[index], orbit.mesh.starts[index]
    switch = event.switch
    interval, side, unknown = before(orbit, index)[0], sides(system, orbit), orbit.algebraic
    arriving = rate_before(orbit, index), unknown[interval, -1]
    leaving = orbit.node_rates[start], unknown[start, 0]
    n, chosen = orbit.nodes.shape[1], list(free)

    def matrix(x: Array, phase: Array, parameter: Array) -> Array:
        at = replace(orbit, parameter=parameter)
        after, by_state, by_phase, by_parameter = mapped(system, event, x, phase, parameter)
        old = rate_at(system, at, x, *arriving, phase, side[interval])
        new = rate_at(system, at, after, *leaving, phase, side[start])
        slopes_of = guards_gradient(system, x, phase, parameter, side[interval : interval + 1])
        s_state, s_phase, s_parameter = (g[0, switch] for g in slopes_of)
        slopes = np.append(s_state, s_parameter[chosen])
        jump = new - by_state[0] @ old - by_phase[0]
        found = np.zeros((n, n + len(free)))
        found[:, :n], found[:, n:] = by_state[0], by_parameter[0][:, chosen]
        speed = float(s_state @ old + s_phase)
        if speed == 0:
            raise np.linalg.LinAlgError("an event at rest")
        return found + np.outer(jump, slopes) / speed

    return matrix


def saltation_gradient(
    system: System,
    orbit: Orbit,
    index: int,
    weights: Array,
    perturbation: Array,
    tangent: tuple[int, ...],
    free: tuple[int, ...],
) -> Row:
    """Return the gradient of weights (n,) . S perturbation (n+q,) in the orbit and the parameters `free`.

    S is the saltation matrix at an event node for the parameters `tangent`.
    """
    matrix = saltation(system, orbit, index, tangent)
    interval, x, phase = before(orbit, index)
    n, k, end = x.shape[1], len(orbit.phases), orbit.mesh.scheme.end
    place = np.concatenate([x[0], phase, orbit.parameter])

    def value(moved: Array) -> float:
        return float(weights @ matrix(moved[None, :n], moved[n : n + 1], moved[n + 1 :]) @ perturbation)

    def slope(i: int) -> float:
        unit = np.zeros(len(place))
        unit[i] = STEP * max(abs(float(place[i])), STEP)
        return sum(weight * value(place + step * unit) for step, weight in STENCIL) / unit[i]

    nodes, stages = np.zeros_like(orbit.nodes), np.zeros_like(orbit.stages)
    by_state = np.array([slope(i) for i in range(n)])
    nodes[interval], stages[interval] = end[0] * by_state, end[1:, None] * by_state
    outer = np.zeros(k + len(free))
    outer[index] = slope(n)
    outer[k:] = [slope(n + 1 + i) for i in free]
    return Row(0.0, nodes, outer, stages)


def at_fixed_phase(
    system: System, orbit: Orbit, jumps: Sequence[Jump], row: Row, free: tuple[int, ...]
) -> Row:
    """Return a row for changes at fixed tau: event nodes at jumps follow from the state that arrives there.

    Other event nodes are mesh points like any, and it does not matter whether they move.
    """
    if not jumps:
        return row
    grid, scheme = orbit.grid, orbit.mesh.scheme
    nodes, outer = row.nodes.copy(), row.outer.copy()
    stages = np.zeros_like(orbit.stages) if row.stages is None else row.stages.copy()
    at_nodes = np.concatenate([grid.left_gradient, grid.left_gradient[:1]])
    at_stages = grid.left_gradient[:, None] + scheme.points[:, None] * grid.width_gradient[:, None]
    late = row.outer[: len(orbit.phases)] + np.einsum("jn,jn,jk->k", row.nodes, orbit.node_rates, at_nodes)
    if row.stages is not None:
        late = late + np.einsum("jln,jln,jlk->k", row.stages, orbit.knot_rates[:, 1:], at_stages)
    for jump in jumps:
        interval, x, phase = before(orbit, jump.index)
        gradient = guards_gradient(system, x, phase, orbit.parameter, modes_in(system, orbit, interval))
        s_state, s_phase, s_parameter = (g[0, orbit.mesh.events[jump.index].switch] for g in gradient)
        moved = -late[jump.index] / (s_state @ rate_before(orbit, jump.index) + s_phase)
        nodes[jump.interval] += scheme.end[0] * moved * s_state
        stages[jump.interval] += scheme.end[1:, None] * moved * s_state
        outer[len(orbit.phases) :] += moved * s_parameter[list(free)]
    return Row(row.value, nodes, outer, stages)


def mapped(
    system: System, event: EventNode, x: Array, phase: Array, parameter: Array
) -> tuple[Array, Array, Array, Array]:
    """x+ with its derivatives in state, phase and parameters; x- itself where only the equations jump.

    Of an impact after which it rests on the wall x+ is where x-, r(x-), r(r(x-)), ... tend to: the speed
    falls to -e times itself each time, so that it is x- + (r(x-) - x-)/(1 + e), whatever e is.
    """
    switch = event.switch
    if switch not in resets_of(system):
        n = x.shape[1]
        return x, np.eye(n)[None], np.zeros((1, n)), np.zeros((1, n, len(parameter)))
    resetting = cast(Resetting, system)
    after = resetting.reset(switch, x, phase, parameter)
    if (switch, STUCK) in event.modes:
        share, by_state = 1 / (1 + bounce(system, switch, x, phase, parameter)[1]), np.eye(x.shape[1])
        slope, *_ = resetting.reset_gradient(switch, x, phase, parameter)
        fixed = x + share * (after - x), by_state + share * (slope - by_state)
        return *fixed, np.zeros_like(x), np.zeros((1, x.shape[1], len(parameter)))
    return after, *resetting.reset_gradient(switch, x, phase, parameter)


def bounce(system: System, switch: int, x: Array, phase: Array, parameter: Array) -> tuple[Array, float]:
    """Return r(x-) and the part e of its speed that an impact leaves, by that which the next one would."""
    resetting = cast(Resetting, system)
    after = resetting.reset(switch, x, phase, parameter)
    first, second = (after - x)[0], (resetting.reset(switch, after, phase, parameter) - after)[0]
    return after, -float(first @ second) / (float(first @ first) or 1.0)
