"""A motion that is left to settle from rest: a first orbit where Newton finds none."""

from __future__ import annotations

from typing import cast

import numpy as np

from periodic.condensed import settling as condensed
from periodic.correction.outcome import FAILURES
from periodic.events.motions import FOLLOWED, orbit_of
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.sampling import sampled
from periodic.orbit.scheme import Array
from periodic.system import Moving, System, linear_of, slides_of, surfaces_of

PERIODS = 100
"""Most periods of the excitation that a motion is given to settle."""

STILL = 1e-3
"""A motion has settled that changes by less than this part of its peak to peak from period to period."""

TOLERANCE = 1e-6
"""Of the integration."""

SAMPLES = 193
"""Places in a period at which it is looked at."""


def settled(system: System, start: Orbit) -> Orbit | None:
    """Return the motion to which a system settles from the beginning of an orbit, with its parameters.

    None where it does not settle within PERIODS, where its integration fails, and of a system that cannot be
    followed in time.
    """
    if linear_of(system):
        return condensed.settled(system, start) if slides_of(system) else None
    if not hasattr(system, "motion"):
        return None
    moving, phase = cast(Moving, system), np.linspace(0, FORCED, SAMPLES)
    state, algebraic = start.nodes[0], start.algebraic[0, 0]
    for _ in range(PERIODS):
        try:
            path = moving.motion(state, algebraic, start.parameter, phase, TOLERANCE)
        except FAILURES:
            return None
        if not np.isfinite(path.state).all():
            return None
        if _closed(path.state):
            last = path.state[-1], path.algebraic[-1], start.parameter, FOLLOWED
            if (converged := orbit_of(moving, *last)) is not None:
                return converged
            return sampled(path.phase, path.state, path.algebraic, start.parameter, system=system)
        state, algebraic = path.state[-1], path.algebraic[-1]
    return None


def held(system: System, motion: Orbit) -> list[str]:
    """Return along which jumps of the equations a motion slides all the time, by their switches' names.

    It has no isolated orbits there: where friction holds it is not determined.
    """
    states, tau = motion.nodes[:-1], motion.grid.left
    values = np.abs(system.switch(states, tau, motion.parameter)).max(axis=0)
    slopes = np.abs(system.switch_gradient(states, tau, motion.parameter)[0]).sum(axis=2).max(axis=0)
    still = values <= TOLERANCE * slopes * motion.span()
    unknown = [s.switch for s in surfaces_of(system) if s.releases is not None and s.place is None]
    return [system.switches[k].name for k in unknown if still[k]]


def _closed(path: Array) -> bool:
    """Whether a motion over a period comes back to its beginning."""
    return bool(np.abs(path[-1] - path[0]).max() < STILL * np.ptp(path, axis=0).max())
