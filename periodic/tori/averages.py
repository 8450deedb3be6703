"""Averages over tori, and their motion in time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from periodic.checks import whole
from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.system import System
from periodic.system.ensembles import FOLLOWED
from periodic.tori.section import Function, Section, TorusError

FINE = 1e-11
"""Tolerance of the integration."""

SAMPLES = 128
"""Phases in a period: the average of a smooth torus over them has no error, as over its angles."""


def average(system: System, torus: Section, function: Function, *, samples: int = SAMPLES) -> float:
    """Return the average in time of a function of the states along the motion, which fills the torus.

    Parameters
    ----------
    system : System
        The equations.
    torus : Section
        The torus.
    function : callable
        Of states in SI by their names, as ``lambda s: s["x"] ** 2``.
    samples : int
        Phases in a period; more for tori with kinks.

    Returns
    -------
    float
        The average over the period and the angle.

    Raises
    ------
    TorusError
        Where a motion cannot be followed.
    """
    states = surface(system, torus, whole("samples", samples, 2))
    each = np.asarray(function(_named(torus, states[:, :-1].reshape(-1, states.shape[2]))))
    values = np.broadcast_to(each, len(states) * samples).reshape(-1, samples)
    return float(torus.grid.weights @ values.mean(axis=1))


def surface(system: System, torus: Section, samples: int = SAMPLES) -> Array:
    """Return the states of a torus over its angles and a period, both ends included.

    Parameters
    ----------
    system : System
        The equations.
    torus : Section
        The torus.
    samples : int
        Phases in a period.

    Returns
    -------
    ndarray, shape (M, samples + 1, n)
        Scaled states on the motions that begin at the M angles.

    Raises
    ------
    TorusError
        Where a motion cannot be followed.
    """
    crowd = Crowd(system, torus.parameter, FINE)
    found = crowd.run(crowd.begin(torus.states), samples, torus.period / samples, keep=True)
    if (found.outcome != FOLLOWED).any() or found.sections is None:
        raise TorusError("a motion on the torus cannot be followed")
    return found.sections[:, :, : torus.states.shape[1]]


def in_time(
    system: System, torus: Section, periods: int = 100, samples: int = SAMPLES
) -> tuple[Array, Mapping[str, Array]]:
    """Return the motion on a torus in time, from angle 0.

    Parameters
    ----------
    system : System
        The equations.
    torus : Section
        The torus.
    periods : int
        How many periods.
    samples : int
        Samples in each.

    Returns
    -------
    time : ndarray, shape (K,)
        Time in s.
    states : mapping of str to ndarray
        States in SI by name, (K,) each.

    Raises
    ------
    TorusError
        Where the motion cannot be followed.
    """
    crowd = Crowd(system, torus.parameter, FINE)
    count = whole("periods", periods) * whole("samples", samples, 2)
    angles = torus.rotation * np.arange(float(periods))
    starts = torus.states_at(angles)
    found = crowd.run(crowd.begin(starts), samples, torus.period / samples, keep=True)
    if (found.outcome != FOLLOWED).any() or found.sections is None:
        raise TorusError("a motion on the torus cannot be followed")
    states = found.sections[:, :-1, : starts.shape[1]].reshape(count, -1)
    rate = torus.frequencies[0] / (2 * np.pi)
    return np.arange(count) / (samples * rate), _named(torus, states)


def _named(torus: Section, states: Array) -> Mapping[str, Array]:
    """States (K, n) in SI, by name."""
    return {name: unit * states[:, k] for k, (name, unit) in enumerate(torus.units.items())}
