"""Saltation: the map of perturbations at fixed tau through an event at which the state or its rates jump.

With x+ = r(x-, tau, p) where s(x, tau, p) = 0, and x' = f- before and f+ after,

    dx+ = r_x dx- + r_p dp + (f+ - r_x f- - r_tau) (s_x dx- + s_p dp) / (s_x f- + s_tau),

the linearisation of the flow through an event whose time follows the state (di Bernardo et al.,
Piecewise-smooth Dynamical Systems, 2008, 2.5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import NDArray

from periodic.events.modes import modes_in, sides
from periodic.events.rates import all_before, before, rate_before, rates_at
from periodic.orbit.jump import Jump
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import STUCK, Resetting, System, guards_gradient, resets_of
from periodic.system.precision import difference_step

STEP = difference_step(order=4)
"""Step of differences in each argument, as a part of its size: they are of the fourth order."""

STENCIL = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))
"""Central difference of the fourth order: steps and their weights."""


@dataclass(frozen=True, eq=False)
class Saltations:
    """The saltation matrices at some event nodes of an orbit, for some free parameters.

    See `periodic.orbit.jump.Carried`. Rates before and after are guessed from the orbit's own.
    """

    system: System
    orbit: Orbit
    indices: tuple[int, ...]
    free: tuple[int, ...]

    @cached_property
    def matrices(self) -> Array:
        """S (K, n, n+q): dx+ from (dx-, dp) at fixed tau. Raises numpy.linalg.LinAlgError, see `at`."""
        _, x, phase = all_before(self.orbit, self.indices)
        return self.at(x, phase, self.orbit.parameter)

    def at(self, x: Array, phase: Array, parameter: Array) -> Array:
        """Return the matrices for events at other x- (K, n), tau (K,) and p.

        Raises numpy.linalg.LinAlgError where there are no rates, and where a switch is at rest.
        """
        system, orbit, side = self.system, self.orbit, self._modes
        interval, start = self._intervals
        events, each = [orbit.mesh.events[i] for i in self.indices], np.arange(len(phase))
        switch = [event.switch for event in events]
        after, by_state, by_phase, by_parameter = mapped(system, events, x, phase, parameter)
        arriving = orbit.knot_rates[interval], orbit.algebraic[interval, -1]
        ends = orbit.mesh.scheme.end @ arriving[0]
        old = rates_at(system, parameter, x, ends, arriving[1], phase, side[interval])
        leaving = orbit.node_rates[start], orbit.algebraic[start, 0]
        new = rates_at(system, parameter, after, *leaving, phase, side[start])
        slopes_of = guards_gradient(system, x, phase, parameter, side[interval])
        s_state, s_phase, s_parameter = (g[each, switch] for g in slopes_of)
        slopes = np.concatenate([s_state, s_parameter[:, list(self.free)]], axis=1)
        jump = new - np.einsum("kij,kj->ki", by_state, old) - by_phase
        speed = np.einsum("kn,kn->k", s_state, old) + s_phase
        if (speed == 0).any():
            raise np.linalg.LinAlgError("an event at rest")
        smooth = np.concatenate([by_state, by_parameter[:, :, list(self.free)]], axis=2)
        return smooth + jump[:, :, None] * slopes[:, None] / speed[:, None, None]

    @cached_property
    def _intervals(self) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
        start = self.orbit.mesh.starts[list(self.indices)].astype(np.int_)
        return (start - 1) % self.orbit.mesh.ntst, start

    @cached_property
    def _modes(self) -> Array:
        return sides(self.system, self.orbit)


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
    matrix = Saltations(system, orbit, (index,), tangent)
    interval, x, phase = before(orbit, index)
    n, k, end = x.shape[1], len(orbit.phases), orbit.mesh.scheme.end
    place = np.concatenate([x[0], phase, orbit.parameter])

    def value(moved: Array) -> float:
        return float(weights @ matrix.at(moved[None, :n], moved[n : n + 1], moved[n + 1 :])[0] @ perturbation)

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
    """Return a row for changes at fixed tau: the phases of jumps follow from the state that arrives there.

    Other event nodes are ordinary mesh points, and it does not matter whether they move.
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
    system: System, events: Sequence[EventNode], x: Array, phase: Array, parameter: Array
) -> tuple[Array, Array, Array, Array]:
    """x+ (K, n), its derivatives in state, phase and parameters; x- itself where only the equations jump.

    For an impact after which the motion rests on the wall x+ is the limit of x-, r(x-), r(r(x-)), ...: each
    impact multiplies the speed by -e, so that the limit is x- + (r(x-) - x-)/(1 + e).
    """
    count, n = x.shape
    after, by_state = x.copy(), np.tile(np.eye(n), (count, 1, 1))
    by_phase, by_parameter = np.zeros((count, n)), np.zeros((count, n, len(parameter)))
    switches, resets = np.array([event.switch for event in events]), {*resets_of(system)}
    for switch in {*switches.tolist()} & resets:
        own, resetting = switches == switch, cast(Resetting, system)
        after[own] = resetting.reset(switch, x[own], phase[own], parameter)
        slopes = resetting.reset_gradient(switch, x[own], phase[own], parameter)
        by_state[own], by_phase[own], by_parameter[own] = slopes
    for i, event in enumerate(events):
        if event.switch not in resets or (event.switch, STUCK) not in event.modes:
            continue
        share = 1 / (1 + bounce(system, event.switch, x[i], phase[i], parameter)[1])
        after[i] = x[i] + share * (after[i] - x[i])
        by_state[i] = np.eye(n) + share * (by_state[i] - np.eye(n))
        by_phase[i], by_parameter[i] = 0.0, 0.0
    return after, by_state, by_phase, by_parameter


def bounce(system: System, switch: int, x: Array, phase: float, parameter: Array) -> tuple[Array, float]:
    """Return r(x-) (n,) and the coefficient of restitution e, from the next impact, r(r(x-))."""
    resetting, at = cast(Resetting, system), np.array([phase])
    after = resetting.reset(switch, x[None], at, parameter)[0]
    first, second = after - x, resetting.reset(switch, after[None], at, parameter)[0] - after
    return after, -float(first @ second) / (float(first @ first) or 1.0)
