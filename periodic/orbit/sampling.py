"""From a simulated motion to an orbit: the start of a branch that cannot be reached from rest."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import scipy
from numpy.typing import ArrayLike

from periodic.orbit.layout import Layout, Quantity, layout_of
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import System, index_of

PER_PERIOD = 96
"""Intervals in each period of the excitation."""


def sampled(
    phase: ArrayLike | None = None,
    state: ArrayLike | Mapping[str, ArrayLike] = (),
    algebraic: ArrayLike | Mapping[str, ArrayLike] | None = None,
    parameter: ArrayLike | Mapping[str, float] = (),
    *,
    times: ArrayLike | None = None,
    system: System | None = None,
) -> Orbit:
    """Return the orbit through samples of a settled motion: a guess for `trace`.

    With numbers by name, in SI, `sampled(times=t, state={"x": x, "x'": v}, parameter={"Omega": 2.0},
    system=system)`; or with the arrays of a simulation, `sampled(phase, state, algebraic, parameter)`.

    Parameters
    ----------
    phase : array_like, optional
        Phases tau (rad), shape (K,): they rise over a whole number of excitation periods 2 pi, both ends
        included.
    state : array_like or mapping
        States scaled as in the system, shape (K, n); or by name in SI, shape (K,) each, `x'` being the
        velocity dx/dt.
    algebraic : array_like or mapping, optional
        Unknowns, shape (K, m), or by name, shape (K,) each; by default those of the system at rest.
    parameter : array_like or mapping
        Parameters in SI, shape (p,); or by name, the others at their nominal values.
    times : array_like, optional
        In the place of phases: times t in s, tau = Omega t.
    system : System, optional
        What names and times refer to.

    Returns
    -------
    Orbit
        The motion on a uniform mesh, between samples a monotone cubic: no solution before it is corrected.

    Raises
    ------
    ValueError
        For other shapes, lengths and names, values that are not finite, and names or times without a system.
    """
    if (phase is None) == (times is None):
        raise ValueError("phase and times are both given or both missing; just one of them must be given")
    by_name = any(isinstance(given, Mapping) for given in (state, algebraic, parameter))
    if system is None and (by_name or times is not None):
        raise ValueError("samples by name and times are those of a system; it must be given, system=")
    values = _parameters(system, parameter)
    layout = None if system is None else layout_of(system)
    tau = np.asarray(phase if times is None else times, dtype=float)
    if layout is not None and times is not None:
        tau = layout.omega(values) * tau
    periods = _periods(tau)
    x = _scaled("state", state, () if layout is None else layout.states, values, layout)
    rest = np.zeros(0) if system is None else system.rest(values)[1]
    given = np.tile(rest, (len(tau), 1)) if algebraic is None else algebraic
    z = _scaled("algebraic", given, () if layout is None else layout.algebraics, values, layout)
    if not (x.ndim == z.ndim == 2 and len(x) == len(z) == len(tau)):
        raise ValueError(
            f"states and unknowns have shapes {x.shape} and {z.shape}; "
            f"each must have one row for each of the {len(tau)} phases"
        )
    if not (np.isfinite(x).all() and np.isfinite(z).all()):
        raise ValueError("the samples have values that are not finite; all of them must be")
    orbit = _through(tau, periods, x, z, values)
    return orbit if layout is None else orbit.expressed_in(layout, "the sampled orbit")


def _through(phase: Array, periods: int, state: Array, algebraic: Array, parameter: Array) -> Orbit:
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
    return Orbit(mesh, nodes, at(stages, state), at(stages, algebraic), np.zeros(0), parameter)


def _parameters(system: System | None, given: ArrayLike | Mapping[str, float]) -> Array:
    """All parameters (p,), those that are not given by name at their nominal values."""
    if system is None or not isinstance(given, Mapping):
        return np.array(given, dtype=float)
    values = np.array(system.nominal, dtype=float)
    for name, value in given.items():
        values[index_of(system, name)] = value
    return values


def _scaled(
    kind: str,
    given: ArrayLike | Mapping[str, ArrayLike],
    quantities: Sequence[Quantity],
    parameter: Array,
    layout: Layout | None,
) -> Array:
    """Scaled samples (K, n): those by name are in SI, velocities bring Omega."""
    if layout is None or not isinstance(given, Mapping):
        return _real(kind, given)
    names = [q.name for q in quantities]
    if set(given) != set(names):
        raise ValueError(
            f"{kind} has {', '.join(given) or 'nothing'}; it must have {', '.join(names) or 'none'}"
        )
    columns = [_real(name, given[name]) for name in names]
    if len({column.shape for column in columns}) > 1:
        raise ValueError(f"{kind} has columns of different lengths; each must have one value for each phase")
    places = [layout.column(name) for name in names]
    factors = [c.scale * (layout.omega(parameter) ** c.order if c.order else 1.0) for c in places]
    return np.stack(columns, axis=-1) / factors if columns else np.zeros((0, 0))


def _real(name: str, given: object) -> Array:
    values = np.asarray(given)
    if values.dtype.kind not in "biuf":
        raise ValueError(f"{name} has values of the type {values.dtype}; they must be real numbers")
    return values.astype(float)


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
