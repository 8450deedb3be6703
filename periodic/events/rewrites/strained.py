"""Which way a slider is strained, by the word: along it a slider that has left a limit is not back at once.

Where dry friction beside a slider sticks or slips, its mode tells which way the slider is strained. A slider
that has stopped at a limit, and is strained away from it or not at all since, cannot be at that limit before
the word changes. A linear prediction may put it there: it has left the limit by the square or the cube of the
length of a slip, which is 0 in linear prediction before that length is.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from periodic.events.modes import group, mode_after, sides, surface_of
from periodic.events.switchpolynomials import Extremum
from periodic.events.twinguards import held_in, holding, twins
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System


def strained_away(system: System, orbit: Orbit, surface: SurfaceLike, at: Extremum) -> bool:
    """Return whether, by the word, a slider has moved away from the limit at which it stopped.

    Parameters
    ----------
    system : System
        The system.
    orbit : Orbit
        An orbit with its word.
    surface : SurfaceLike
        The slider.
    at : Extremum
        An extremum of one of its releases, while it is held.
    """
    own = group(system, orbit.mesh, surface.switch)
    if surface.kind != Kind.SLIDER or not own:
        return False
    assert surface.releases is not None
    way = 1 if at.switch == surface.releases[0] else -1
    starts = orbit.mesh.starts[own]
    last = int(np.searchsorted(starts, at.interval, side="right")) - 1
    slipped, stopped = (mode_after(surface, orbit.mesh.events[own[k]]) for k in (last - 1, last))
    if (slipped, stopped) != (way, STUCK):
        return False
    since = (at.interval - int(starts[last])) % orbit.mesh.ntst + 1
    passed = ((int(starts[last]) + k) % orbit.mesh.ntst for k in range(since))
    return all(_way(system, orbit, surface.switch, interval) in (0, -way) for interval in passed)


def _way(system: System, orbit: Orbit, guard: int, interval: int) -> int | None:
    """The sign of a slider's rate of strain by the modes of friction; None if they tell none."""
    held = held_in(system, orbit, interval)
    if holding(system, guard, held):
        return 0
    modes = sides(system, orbit)[interval]
    for k, sign in twins(system, guard, held).items():
        other = surface_of(system, k)
        if other.kind == Kind.SLIDING and modes[cast(int, other.column)]:
            return sign * int(modes[cast(int, other.column)])
    return None
