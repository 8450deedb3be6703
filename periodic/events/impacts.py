"""Impacts: event nodes at which the state is mapped, x+ = r(x-, tau, p); see `periodic.system.Resetting`.

The mesh point of the event is x+, the polynomial of the interval before it ends at x-. How perturbations pass
it is told by `periodic.events.saltation`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from periodic.events.saltation import mapped, saltation
from periodic.events.rates import before, rate_before
from periodic.orbit.jump import Jump
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, jumps_of, resets_of, slides_of

SAMPLES = 17
"""Places in each interval at which an orbit is looked at between its impacts."""

TINY = 1e-300


def tied(system: System, orbit: Orbit) -> list[int]:
    """Return the indices of the orbit's event nodes that are impacts."""
    resets = resets_of(system)
    return [i for i, event in enumerate(orbit.mesh.events) if event.switch in resets]


def jumps(system: System, orbit: Orbit, free: tuple[int, ...]) -> list[Jump]:
    """Return the event nodes of an orbit at which its state or its rates jump, linearised.

    Raises numpy.linalg.LinAlgError where one has no rates.
    """
    special = (*resets_of(system), *jumps_of(system))
    return [_jump(system, orbit, i, free) for i, e in enumerate(orbit.mesh.events) if e.switch in special]


def _jump(system: System, orbit: Orbit, index: int, free: tuple[int, ...]) -> Jump:
    switch, k = orbit.mesh.events[index].switch, len(orbit.phases)
    interval, x, phase = before(orbit, index)
    after, by_state, by_phase, by_parameter = mapped(system, switch, x, phase, orbit.parameter)
    by_outer = np.zeros((x.shape[1], k + len(free)))
    by_outer[:, index] = by_phase[0]
    by_outer[:, k:] = by_parameter[0][:, list(free)]
    carried = saltation(system, orbit, index, free)(x, phase, orbit.parameter)
    return Jump(index, interval, x[0], after[0], by_state[0], by_outer, carried)


def applied(orbit: Orbit, step: Array, found: Sequence[Jump]) -> tuple[Array, Array | None]:
    """Return the steps (N, n, w) with impacts at their ends, and the steps of perturbations at fixed tau.

    The latter have shape (N, n, n+q), None where there are no impacts: their columns are the states, then the
    free parameters.
    """
    if not found:
        return step, None
    n, k = step.shape[1], len(orbit.phases)
    perturbed = np.concatenate([step[:, :, 1 : 1 + n], step[:, :, 1 + n + k :]], axis=2)
    for jump in found:
        j, start = jump.interval, orbit.nodes[jump.interval + 1]
        own = step[j].copy()
        own[:, 0] += start - jump.before
        perturbed[j] = jump.saltation[:, :n] @ perturbed[j]
        perturbed[j, :, n:] += jump.saltation[:, n:]
        step[j] = jump.by_state @ own
        step[j, :, 0] += jump.after - start
        step[j, :, 1 + n :] += jump.by_outer
    return step, perturbed


def event_row(system: System, orbit: Orbit, index: int, free: tuple[int, ...]) -> Row:
    """Return the condition of an impact, linearised: s(x-, phi, p) = 0 where the interval before it ends."""
    switch, k, end = orbit.mesh.events[index].switch, len(orbit.phases), orbit.mesh.scheme.end
    interval, x, phase = before(orbit, index)
    d_state, d_phase, d_parameter = system.switch_gradient(x, phase, orbit.parameter)
    nodes, stages = np.zeros_like(orbit.nodes), np.zeros_like(orbit.stages)
    nodes[interval] = end[0] * d_state[0, switch]
    stages[interval] = end[1:, None] * d_state[0, switch]
    outer = np.zeros(k + len(free))
    outer[index] = d_phase[0, switch]
    outer[k:] = d_parameter[0, switch, list(free)]
    return Row(float(system.switch(x, phase, orbit.parameter)[0, switch]), nodes, outer, stages)


def slope_before(system: System, orbit: Orbit, index: int) -> float:
    """ds/dtau with which a switch arrives at its impact."""
    switch = orbit.mesh.events[index].switch
    _, x, phase = before(orbit, index)
    d_state, d_phase, _ = system.switch_gradient(x, phase, orbit.parameter)
    return float(d_phase[0, switch] + d_state[0, switch] @ rate_before(orbit, index))


def arrived(system: System, orbit: Orbit) -> bool:
    """Whether every impact of an orbit is met in the direction of its switch."""
    every = ((orbit.mesh.events[i], slope_before(system, orbit, i)) for i in tied(system, orbit))
    return all(slope * event.direction > 0 for event, slope in every)


def crossed(system: System, orbit: Orbit) -> bool:
    """Whether an orbit goes on past every jump of the equations along which it is not known to slide."""
    jumps = set(jumps_of(system)) - set(slides_of(system))
    for i, event in enumerate(orbit.mesh.events):
        if event.switch in jumps:
            start = orbit.mesh.starts[i]
            at = orbit.nodes[start : start + 1], orbit.phases[i : i + 1], orbit.parameter
            d_state, d_phase, _ = system.switch_gradient(*at)
            onward = d_phase[0, event.switch] + d_state[0, event.switch] @ orbit.node_rates[start]
            if not onward * event.direction > 0:
                return False
    return True


def free(system: System, orbit: Orbit, least: float) -> bool:
    """Whether an orbit keeps to its side of all impacts, on the whole of it, but for `least` (in s)."""
    resets = list(resets_of(system))
    if not resets:
        return True
    count, theta = orbit.mesh.ntst, np.linspace(0.0, 1.0, SAMPLES)
    index = np.repeat(np.arange(count), SAMPLES)
    values = _sides(system, orbit, index, np.tile(theta, count)).reshape(count, SAMPLES, len(resets))
    left, middle, right = values[:, :-2], values[:, 1:-1], values[:, 2:]
    lowest = np.argwhere((middle <= left) & (middle <= right))
    bend = (left + right - 2 * middle)[tuple(lowest.T)]
    tilt = (right - left)[tuple(lowest.T)]
    vertex = theta[1 + lowest[:, 1]] - np.where(bend > 0, tilt / (2 * np.maximum(bend, TINY)), 0.0) * theta[1]
    deepest = _sides(system, orbit, lowest[:, 0], np.clip(vertex, 0.0, 1.0))
    return bool(values.min() >= -least and deepest.min(initial=0.0) >= -least)


def _sides(system: System, orbit: Orbit, index: NDArray[np.int_], theta: Array) -> Array:
    """Switches of impacts at places in intervals, positive on the free side, shape (points, impacts)."""
    resets = list(resets_of(system))
    basis = orbit.mesh.scheme.basis(theta)
    state = np.einsum("pl,pln->pn", basis, orbit.knots[index])
    tau = orbit.grid.left[index] + orbit.grid.width[index] * theta
    away = [-system.switches[k].direction for k in resets]
    return system.switch(state, tau, orbit.parameter)[:, resets] * away


def passages(system: System, orbit: Orbit) -> list[tuple[EventNode, float, float]]:
    """Return event, phase and |ds/dtau| of an orbit's impacts."""
    return [
        (orbit.mesh.events[i], float(orbit.phases[i]), abs(slope_before(system, orbit, i)))
        for i in tied(system, orbit)
    ]
