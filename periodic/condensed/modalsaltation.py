"""Modal saltation: how perturbations of an orbit pass events at which the forces on the linear part jump.

In modes, with x = Re outputs z and dz/dtau = lambda z + B f, saltation is of rank one: at fixed tau

    dz+ = dz- + B (f+ - f-) (s_x dx-)/(ds/dtau),

s the switch of the event, since an event that is late by -(s_x dx-)/(ds/dtau) leaves the old forces at work
for as long. Perturbations of own states change likewise, by the jump of their rates. Compare
`periodic.events.saltation`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.condensed.modal.moments import Complex
from periodic.condensed.modal.response import Response
from periodic.events.impacts import carrying
from periodic.events.modes import linearise, modes_in, sides
from periodic.events.rates import before
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import LinearPart, System, guards_gradient, jumps_of
from periodic.system.precision import CONVERGED, MOST_ITERATIONS


@dataclass(frozen=True)
class ModalSaltation:
    """An event at the end of an interval.

    row (n,): by how much (rad) the event comes earlier, per perturbation of the states; modes (J,), own (o,):
    what is added to perturbations of modes and own states per rad of that.
    """

    interval: int
    row: Array
    modes: Complex
    own: Array


def saltations(system: System, part: LinearPart, orbit: Orbit, response: Response) -> list[ModalSaltation]:
    """Return the events of an orbit at which forces or rates of own states jump, in order.

    Raises numpy.linalg.LinAlgError where ds/dtau is 0 at an event, or forces there are not found.
    """
    jumps, found = {*jumps_of(system), *carrying(system)}, list[ModalSaltation]()
    chosen = [i for i, event in enumerate(orbit.mesh.events) if event.switch in jumps]
    if not chosen:
        return []
    forces = np.ascontiguousarray(orbit.algebraic[:, :, list(part.forces)])
    history = response.history(forces)
    for i in chosen:
        saltation = _saltation(system, part, orbit, response, history[orbit.mesh.starts[i]], i)
        if saltation is not None:
            found.append(saltation)
    return sorted(found, key=lambda each: each.interval)


def _saltation(
    system: System, part: LinearPart, orbit: Orbit, response: Response, modes: Complex, index: int
) -> ModalSaltation | None:
    """The saltation at one event, `modes` the z there; None where its switch depends on no state."""
    switch, start, side = orbit.mesh.events[index].switch, orbit.mesh.starts[index], sides(system, orbit)
    interval, x, phase = before(orbit, index)
    modes_before = modes_in(system, orbit, interval)
    slope, by_phase, _ = (
        g[0, switch] for g in guards_gradient(system, x, phase, orbit.parameter, modes_before)
    )
    if not slope.any():
        return None
    own = np.setdiff1d(np.arange(x.shape[1]), part.states)
    given = [
        _solved_on(system, orbit, x, phase, own, side[k], guess)
        for k, guess in ((interval, orbit.algebraic[interval, -1]), (start, orbit.algebraic[start, 0]))
    ]
    (rates, forces), (later, after) = ((r, a[list(part.forces)]) for r, a in given)
    rate = np.zeros(x.shape[1])
    rate[own] = rates
    driven = response.modes.exponents * modes + response.modes.inputs @ forces
    rate[list(part.states)] = (response.modes.outputs @ driven).real
    speed = float(slope @ rate + by_phase)
    if speed == 0:
        raise np.linalg.LinAlgError("an event at rest")
    return ModalSaltation(interval, slope / speed, response.modes.inputs @ (after - forces), later - rates)


def _solved_on(
    system: System, orbit: Orbit, x: Array, phase: Array, own: Array, side: Array, guess: Array
) -> tuple[Array, Array]:
    """Rates of own states (o,) and unknowns (m,) at a state (1, n) on given sides of the jumps.

    Raises numpy.linalg.LinAlgError where they are not found.
    """
    n, rate, unknown = x.shape[1], np.zeros_like(x), guess[None].copy()
    for _ in range(MOST_ITERATIONS):
        line = linearise(system, (rate, x, unknown, phase, orbit.parameter), side[None])
        rows = np.concatenate([line.d_rate[0][:, own], line.d_algebraic[0]], axis=1)
        driven = np.concatenate([line.d_rate[0], line.d_state[0]], axis=1)[:n]
        kept = np.append(driven.any(axis=1), np.ones(len(rows) - n, dtype=bool))
        change = np.linalg.solve(rows[kept], line.residual[0][kept])
        rate[0, own] -= change[: len(own)]
        unknown = system.move(unknown, -change[None, len(own) :])
        found = np.append(rate[0, own], unknown)
        if np.abs(change).max(initial=0.0) <= CONVERGED * (1 + np.abs(found).max(initial=0.0)):
            return rate[0, own], unknown[0]
    raise np.linalg.LinAlgError("the forces at an event are not found")
