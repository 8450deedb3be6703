"""Motions integrated until they settle: a guess of an orbit where Newton's method finds none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

import numpy as np

from periodic.correction.discretisation import Discretisation
from periodic.correction.outcome import FAILURES
from periodic.correction.tolerance import Accuracy
from periodic.events.motions import FOLLOWED, PERIODS, STILL, motion_from, orbit_of
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.sampling import sampled
from periodic.orbit.scheme import Array
from periodic.system import Moving, System, surfaces_of
from periodic.tracing.returnmap import ReturnMap

CLOSE = 1e-2 * STILL
"""As `STILL`, of a motion settled further, as the order of events near each other may need it."""

NEAR = 1e-2
"""As `STILL`, for the result of Newton's method on the return map: near enough to read its word."""

TRANSIENTS = (10, 40)
"""Periods after which Newton's method on the return map is tried."""

PLACES_IN_PERIOD = 193
"""Phases in a period at which the motion is computed."""


def settled(method: Discretisation, system: System, start: Orbit) -> Iterator[Orbit]:
    """Yield the motion to which a system settles from the beginning of an orbit, with its parameters.

    By the method's own simulation, or by integration of all states; then the same motion settled further.
    Nothing where it does not settle within PERIODS, where its integration fails, and for a system that cannot
    be integrated.
    """
    own = method.settled(system, start)
    yield from _integrated(system, start) if own is None else own


def _integrated(system: System, start: Orbit) -> Iterator[Orbit]:
    """The motion of a system with all its states."""
    if not hasattr(system, "motion"):
        return
    wanted = STILL
    moving, phase = cast(Moving, system), np.linspace(0, FORCED, PLACES_IN_PERIOD)
    state, algebraic, modes = start.nodes[0], start.algebraic[0, 0], None
    for count in range(PERIODS):
        try:
            found = None
            if count in TRANSIENTS:
                found = _fixed(moving, state, algebraic, start.parameter, phase, modes)
            state = state if found is None else found
            given = state, algebraic, start.parameter, phase, Accuracy.STANDARD
            path = motion_from(moving, *given, modes)
        except FAILURES:
            return
        if not np.isfinite(path.state).all():
            return
        state, algebraic, modes = path.state[-1], path.algebraic[-1], path.modes
        if found is not None or _closed(path.state, wanted):
            converged = orbit_of(moving, state, algebraic, start.parameter, FOLLOWED, before=modes)
            yield converged or sampled(path.phase, path.state, path.algebraic, start.parameter, system=system)
            if wanted == CLOSE or converged is None:
                return
            wanted = CLOSE


def _fixed(
    moving: Moving,
    state: Array,
    algebraic: Array,
    parameter: Array,
    phase: Array,
    modes: Sequence[int] | None,
) -> Array | None:
    """The beginning of an orbit near a motion, if Newton's method finds one."""

    def follow(begin: Array) -> Array:
        return motion_from(moving, begin, algebraic, parameter, phase, Accuracy.STANDARD, modes).state

    try:
        return ReturnMap(follow, STILL / 2, NEAR).fixed(state)
    except FAILURES:
        return None


def held(system: System, motion: Orbit) -> list[str]:
    """Return along which jumps of the equations a motion slides all the time, by their switches' names.

    There orbits are not isolated: the place at which friction holds is not determined.
    """
    states, tau = motion.nodes[:-1], motion.grid.left
    values = np.abs(system.switch(states, tau, motion.parameter)).max(axis=0)
    slopes = np.abs(system.switch_gradient(states, tau, motion.parameter)[0]).sum(axis=2).max(axis=0)
    still = values <= Accuracy.STANDARD * slopes * motion.span()
    each = [s for s in surfaces_of(system) if s.releases is not None]
    unknown = [s.switch for s in each if s.place is None and not s.alone]
    return [system.switches[k].name for k in unknown if still[k]]


def _closed(path: Array, still: float) -> bool:
    """Whether a motion over a period comes back to its beginning, but for a part of its peak to peak."""
    return bool(np.abs(path[-1] - path[0]).max() < still * max(np.ptp(path, axis=0).max(), Accuracy.STANDARD))
