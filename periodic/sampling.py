"""From a simulated motion to an orbit: the start of a branch that cannot be reached from rest."""

from __future__ import annotations

import math

import numpy as np
import scipy

from periodic.mesh import uniform
from periodic.orbit import FORCED, Orbit
from periodic.scheme import Array, Scheme

PER_PERIOD = 96
"""Intervals in each period of the excitation."""


def sampled(phase: Array, state: Array, algebraic: Array, parameter: Array) -> Orbit:
    """Return the orbit through samples of a settled motion: a guess for `trace`.

    phase (N,) rises over a whole number of excitation periods 2 pi, both ends included; state (N, n) and
    algebraic (N, m) scaled as in the system, parameter (p,) in SI. Raises ValueError for any other shape
    or length.
    """
    phase, state, algebraic = (np.asarray(a, dtype=float) for a in (phase, state, algebraic))
    periods = _periods(phase)
    if not (state.ndim == algebraic.ndim == 2 and len(state) == len(algebraic) == len(phase)):
        raise ValueError(
            f"states and unknowns have shapes {state.shape} and {algebraic.shape}; "
            f"each must have one row for each of the {len(phase)} phases"
        )
    if not (np.isfinite(state).all() and np.isfinite(algebraic).all()):
        raise ValueError("the samples have values that are not finite; all of them must be")
    mesh = uniform(Scheme(), PER_PERIOD * periods, FORCED * periods)
    left, width = mesh.grid(np.zeros(0)).left, mesh.grid(np.zeros(0)).width
    stages = left[:, None] + width[:, None] * mesh.scheme.points

    def at(tau: Array, values: Array) -> Array:
        place = phase[0] + np.mod(tau - phase[0], mesh.period)
        if values.shape[1] == 0:
            return np.zeros((*tau.shape, 0))
        return np.asarray(scipy.interpolate.PchipInterpolator(phase, values, axis=0)(place))

    nodes = at(mesh.nodes(np.zeros(0)), state)
    nodes[-1] = nodes[0]
    return Orbit(mesh, nodes, at(stages, state), at(stages, algebraic), np.zeros(0), np.array(parameter))


def _periods(phase: Array) -> int:
    if phase.ndim != 1 or len(phase) < 4 or not (np.diff(phase) > 0).all():
        raise ValueError("phases of the samples must be at least 4 rising numbers")
    length = float(phase[-1] - phase[0]) / FORCED
    periods = round(length) if math.isfinite(length) else 0
    if periods < 1 or abs(length - periods) > 1e-6:
        raise ValueError(
            f"the samples last {length:g} excitation periods; they must last a whole number of them"
        )
    return periods
