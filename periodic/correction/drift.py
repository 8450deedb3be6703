"""States that nothing holds: a system that drifts freely has no orbit, or a line of them."""

from __future__ import annotations

import numpy as np

from periodic.orbit.scheme import Array
from periodic.system import System

FREE_MOTION = 1e-12
"""Ratio of a stiffness's least singular value to its largest below which nothing holds a motion."""

TAKES_PART = 0.1
"""Part of a free motion's largest component above which a state is one of those that drift."""

AWAY = 0.1
"""Scaled distance from rest at which the stiffness is evaluated as well."""

PHASES = np.linspace(0.0, 2 * np.pi, 4, endpoint=False)


def drifting(system: System, parameter: Array) -> list[str]:
    """Return the names of states that may be moved together without any force; none as a rule.

    See `periodic.correction.discretisation.Discretisation.drifting`.
    """
    state, algebraic = system.rest(parameter)
    many = len(PHASES)
    places = state + AWAY * np.sin(1.0 + np.arange(many))[:, None] * np.ones_like(state)
    places[0] = state
    unknowns = np.tile(algebraic, (many, 1))
    found = system.linearise(np.zeros_like(places), places, unknowns, PHASES, parameter)
    stiffness = np.concatenate([found.d_state, found.d_algebraic], axis=2)
    stiffness = stiffness.reshape(-1, stiffness.shape[2])  # held at one place is held
    if not np.isfinite(stiffness).all():
        return []
    _, sizes, ways = np.linalg.svd(stiffness)
    if len(sizes) == 0 or sizes[-1] > FREE_MOTION * sizes[0]:
        return []
    way = np.abs(ways[-1, : len(state)])
    return [s.name for s, part in zip(system.states, way, strict=True) if part > TAKES_PART * way.max()]
