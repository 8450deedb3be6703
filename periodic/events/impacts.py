"""Impacts: event nodes at which the state is mapped, x+ = r(x-, tau, p); see `periodic.system.Resetting`.

The mesh point of the event is x+; the polynomial of the interval before it ends at x-. Perturbations pass the
impact by its saltation matrix, see `periodic.events.saltation`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from periodic.events.modes import modes_in, of_kind
from periodic.events.rates import all_before, before, rate_before
from periodic.events.saltation import Saltations, mapped
from periodic.orbit.jump import Jump
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import Kind, System, guards, guards_gradient, jumps_of, resets_of


def tied(system: System, orbit: Orbit) -> list[int]:
    """Return the indices of the orbit's event nodes that are impacts."""
    resets = resets_of(system)
    return [i for i, event in enumerate(orbit.mesh.events) if event.switch in resets]


def jumps(system: System, orbit: Orbit, free: tuple[int, ...]) -> list[Jump]:
    """Return the event nodes of an orbit at which its state or its rates jump, linearised."""
    own = jumping(system, orbit)
    if not own:
        return []
    carried = Saltations(system, orbit, own, free)
    interval, x, phase = all_before(orbit, own)
    events = [orbit.mesh.events[i] for i in own]
    after, by_state, by_phase, by_parameter = mapped(system, events, x, phase, orbit.parameter)
    k, found = len(orbit.phases), list[Jump]()
    for place, index in enumerate(own):
        by_outer = np.zeros((x.shape[1], k + len(free)))
        by_outer[:, index] = by_phase[place]
        by_outer[:, k:] = by_parameter[place][:, list(free)]
        states = x[place], after[place], by_state[place]
        found.append(Jump(index, int(interval[place]), *states, by_outer, carried, place))
    return found


def jumping(system: System, orbit: Orbit) -> tuple[int, ...]:
    """Return the event nodes of an orbit at which its state or its rates jump."""
    own = {*resets_of(system), *jumps_of(system), *carrying(system)} if orbit.mesh.events else set()
    if not own:
        return ()
    return tuple(
        i
        for i, event in enumerate(orbit.mesh.events)
        if (event.switch in own or {k for k, _ in event.modes} & own) and not _settling(system, event)
    )


def _settling(system: System, event: EventNode) -> bool:
    """Whether elastic sliders come to be held at an event node, and nothing else happens: no rate jumps."""
    sliders = {surface.switch for surface in of_kind(system, Kind.SLIDER)}
    return event.switch in sliders and {k for k, _ in event.modes} <= sliders


def carrying(system: System) -> list[int]:
    """Return the switches at which elastic sliders give way: the rate of their place jumps there."""
    return [k for surface in of_kind(system, Kind.SLIDER) for k in surface.releases or ()]


def applied(orbit: Orbit, step: Array, found: Sequence[Jump]) -> Array:
    """Return the steps (N, n, w) composed with the jumps at the ends of their intervals."""
    for jump in found:
        j, start = jump.interval, orbit.nodes[jump.interval + 1]
        own = step[j].copy()
        own[:, 0] += start - jump.before
        step[j] = jump.by_state @ own
        step[j, :, 0] += jump.after - start
        step[j, :, 1 + orbit.nodes.shape[1] :] += jump.by_outer
    return step


def perturbed(orbit: Orbit, step: Array, arriving: Array, found: Sequence[Jump]) -> Array:
    """Return the steps of perturbations at fixed tau, (N, n, n+q): in the states, then in the parameters.

    arriving (jumps, n, w): the steps of the intervals that end at jumps, up to the state before the jump.
    Raises numpy.linalg.LinAlgError where the rates at a jump are not determined.
    """
    n, k = step.shape[1], len(orbit.phases)

    def at_fixed_phase(steps: Array) -> Array:
        return np.concatenate([steps[:, :, 1 : 1 + n], steps[:, :, 1 + n + k :]], axis=2)

    passing = at_fixed_phase(step)
    for jump, own in zip(found, at_fixed_phase(arriving), strict=True):
        passing[jump.interval] = jump.saltation[:, :n] @ own
        passing[jump.interval, :, n:] += jump.saltation[:, n:]
    return passing


def arriving_row(system: System, orbit: Orbit, index: int, switch: int, free: tuple[int, ...]) -> Row:
    """Return a switch s(x-, phi, p) where the interval before an event node ends, and its gradient.

    The impact's own switch is 0 there.
    """
    k, end = len(orbit.phases), orbit.mesh.scheme.end
    interval, x, phase = before(orbit, index)
    side = modes_in(system, orbit, interval)
    d_state, d_phase, d_parameter = guards_gradient(system, x, phase, orbit.parameter, side)
    nodes, stages = np.zeros_like(orbit.nodes), np.zeros_like(orbit.stages)
    nodes[interval] = end[0] * d_state[0, switch]
    stages[interval] = end[1:, None] * d_state[0, switch]
    outer = np.zeros(k + len(free))
    outer[index] = d_phase[0, switch]
    outer[k:] = d_parameter[0, switch, list(free)]
    value = guards(system, x, phase, orbit.parameter, side)[0, switch]
    return Row(float(value), nodes, outer, stages)


def slope_before(system: System, orbit: Orbit, index: int) -> float:
    """ds/dtau with which a switch arrives at its event node."""
    switch = orbit.mesh.events[index].switch
    interval, x, phase = before(orbit, index)
    side = modes_in(system, orbit, interval)
    d_state, d_phase, _ = guards_gradient(system, x, phase, orbit.parameter, side)
    return float(d_phase[0, switch] + d_state[0, switch] @ rate_before(orbit, index))
