"""Where a torus's section crosses surfaces, as of contacts: its derivatives jump there.

The events of the motions on a torus are curves on it; those that a section crosses are its breaks. Where
motions pass a surface between two sections the map is smooth.
"""

from __future__ import annotations

import numpy as np
import scipy

from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.tori.grid import FEWEST, TURN
from periodic.tori.section import Section

FINER = 8
"""Angles at which crossings are looked for, for each of the section's."""

NEAR = 1e-6
"""Distance (rad) between two breaks that are one: what jumps there is a second derivative, or higher."""


def breaks_of(system: System, torus: Section) -> Array:
    """Return the angles at which a section crosses surfaces, rising; none where they are too many to tell."""
    if not len(system.switches):
        return np.zeros(0)
    angles = TURN * np.arange(FINER * len(torus.states) + 1) / (FINER * len(torus.states))
    values = _values(system, torus, angles)
    found = [
        _root(system, torus, k, angles[i], angles[i + 1])
        for i, k in zip(*np.nonzero(np.diff(np.sign(values), axis=0)), strict=True)
    ]
    breaks = np.unique(np.mod(np.array(found), TURN)) if found else np.zeros(0)
    apart = np.diff(breaks, append=breaks[:1] + TURN) > NEAR
    breaks = breaks[apart]
    return breaks if 1 < len(breaks) <= len(torus.states) // FEWEST else np.zeros(0)


def moved(before: Array, after: Array) -> bool:
    """Return whether breaks are not where they were."""
    return len(before) != len(after) or bool((np.abs(before - after) > NEAR).any())


def _values(system: System, torus: Section, angles: Array) -> Array:
    """The switch functions at angles, (K, switches)."""
    return system.switch(torus.states_at(angles), np.zeros(len(angles)), torus.parameter)


def _root(system: System, torus: Section, k: int, low: float, high: float) -> float:
    """The angle in a range at which a section crosses the k-th surface."""

    def value(angle: float) -> float:
        return float(_values(system, torus, np.array([angle]))[0, k])

    if value(low) * value(high) > 0:  # at a break the curve has two sides
        return low
    return float(scipy.optimize.brentq(value, low, high, xtol=NEAR / 100))
