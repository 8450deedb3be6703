"""Fundamental matrices of an orbit from the steps that C computes, to which saltation is added here."""

from __future__ import annotations

from itertools import accumulate

import numpy as np

from periodic.events.impacts import jumping
from periodic.events.saltation import Saltations
from periodic.linear.bordering import GROWTH, PAIRED_UP_TO, after_bounded, between_any
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System


def carried(system: System, orbit: Orbit, steps: Array) -> Array:
    """Return the steps (N, n, n) of perturbations at fixed tau, of those with event nodes held.

    Raises numpy.linalg.LinAlgError where a jump has no rates.
    """
    own, found = jumping(system, orbit), steps.copy()
    if own:
        interval = (orbit.mesh.starts[list(own)] - 1) % orbit.mesh.ntst
        found[interval] = Saltations(system, orbit, own, ()).matrices @ steps[interval]
    return found


def multiplied(steps: Array) -> Array:
    """Return the fundamental matrices (N+1, n, n)."""
    return np.array(list(accumulate(steps, after_bounded, initial=np.eye(steps.shape[1]))))


def tame(steps: Array) -> bool:
    """Whether motions grow so little that multipliers are those of the fundamental matrices."""
    return steps.shape[1] > PAIRED_UP_TO or between_any(steps) <= GROWTH
