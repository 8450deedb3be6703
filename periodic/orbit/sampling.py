"""From a simulated motion to an orbit: the start of a branch that cannot be reached from rest."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import ArrayLike

from periodic.orbit.layout import Layout, Quantity, layout_of
from periodic.orbit.mesh import MIN_INTERVALS, EventNode, Mesh, uniform
from periodic.orbit.orbit import FORCED, LEAST_SPAN, Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import Kind, System, index_of, resets_of, surfaces_of

PER_PERIOD = 96
"""Equal intervals in each period of the excitation, used where they resolve the samples."""

GRADED = tuple(384 * 2**k for k in range(6))
"""Intervals in each period, placed between samples, of a motion that equal ones do not resolve: the first
that do, and no more than there are samples."""

LEAST_WIDTH = 1e-9
"""Least distance, in periods, of an interval's end from that of the period."""

FARTHEST_SAMPLE = 0.01
"""Largest distance of the samples from the orbit, in peaks to peak."""


def sampled(
    phase: ArrayLike | None = None,
    state: ArrayLike | Mapping[str, ArrayLike] = (),
    algebraic: ArrayLike | Mapping[str, ArrayLike] | None = None,
    parameter: ArrayLike | Mapping[str, float] = (),
    *,
    times: ArrayLike | None = None,
    system: System | None = None,
    modes: Sequence[int] = (),
) -> Orbit:
    """Return the orbit through samples of a settled motion: a guess for `trace`.

    With numbers by name, in SI, `sampled(times=t, state={"x": x, "x'": v}, parameter={"Omega": 2.0},
    system=system)`; or with the arrays of a simulation, `sampled(phase, state, algebraic, parameter)`.

    Parameters
    ----------
    phase : array_like, optional
        Phases tau (rad), shape (K,): they rise over a whole number of excitation periods 2 pi, both ends
        included. Of a system with impacts one that is given twice is an impact, with the states before and
        after it.
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
        What names, times and modes refer to.
    modes : sequence of int, optional
        Those of the system's surfaces, as a simulation has them at its end: relays that do not switch stay in
        theirs. By default such a relay is off where the samples have not been above its upper threshold.

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
    if len(modes) and (system is None or len(modes) != len(surfaces_of(system))):
        raise ValueError(f"modes are {tuple(modes)}; they must be one for each surface of a given system")
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
    if (np.diff(tau) == 0).any():
        orbit = _through_impacts(system, tau, periods, x, z, values)
    else:
        orbit = _through(tau, periods, x, z, values)
    if system is not None and len(modes):
        orbit = replace(orbit, mesh=replace(orbit.mesh, modes=_of_relays(system, modes)))
    return orbit if layout is None else orbit.expressed_in(layout, "the sampled orbit")


def _of_relays(system: System, modes: Sequence[int]) -> tuple[tuple[int, int], ...]:
    """The modes of relays as meshes have them, by their guards."""
    both = zip(surfaces_of(system), modes, strict=True)
    return tuple((surface.switch, mode) for surface, mode in both if surface.kind == Kind.RELAY)


def _through(phase: Array, periods: int, state: Array, algebraic: Array, parameter: Array) -> Orbit:
    """The orbit on equal intervals, or on intervals that end at samples where equal ones miss something."""
    sizes, most = np.maximum(np.ptp(state, axis=0), LEAST_SPAN), len(phase) - 1
    counts = [ntst * periods for ntst in GRADED if ntst * periods < most] or [GRADED[0] * periods]
    orbit = _on(uniform(Scheme(), PER_PERIOD * periods, FORCED * periods), phase, state, algebraic, parameter)
    for ntst in counts:
        missed = np.abs(orbit.state(phase) - state).max(axis=0)
        if (missed <= FARTHEST_SAMPLE * sizes).all():
            break
        orbit = _on(_graded(phase, state, ntst), phase, state, algebraic, parameter)
    return orbit


def _graded(phase: Array, state: Array, ntst: int) -> Mesh:
    """Intervals that end at samples, of about equal arclength over phase and scaled states."""
    sizes = np.maximum(np.ptp(state, axis=0), LEAST_SPAN)
    steps = np.diff(np.column_stack([FORCED * state / sizes, phase]), axis=0)
    length = np.append(0.0, np.cumsum(np.linalg.norm(steps, axis=1)))
    chosen = np.unique(np.searchsorted(length, np.linspace(0, length[-1], ntst + 1)))
    period = FORCED * round((phase[-1] - phase[0]) / FORCED)
    inside = np.sort(np.mod(phase[chosen[:-1]], period)) / period
    breaks = np.concatenate([[0.0], inside[(inside > LEAST_WIDTH) & (inside < 1 - LEAST_WIDTH)], [1.0]])
    return Mesh(Scheme(), (breaks,), (), period)


def _on(mesh: Mesh, phase: Array, state: Array, algebraic: Array, parameter: Array) -> Orbit:
    """Samples interpolated on a mesh."""
    grid = mesh.grid(np.zeros(0))
    stages = grid.left[:, None] + grid.width[:, None] * mesh.scheme.points

    def at(tau: Array, values: Array) -> Array:
        place = phase[0] + np.mod(tau - phase[0], mesh.period)
        if values.shape[1] == 0:
            return np.zeros((*tau.shape, 0))
        return np.asarray(scipy.interpolate.PchipInterpolator(phase, values, axis=0)(place))

    nodes = at(mesh.nodes(np.zeros(0)), state)
    nodes[-1] = nodes[0]
    return Orbit(mesh, nodes, at(stages, state), at(stages, algebraic), np.zeros(0), parameter)


def _through_impacts(
    system: System | None, phase: Array, periods: int, state: Array, algebraic: Array, parameter: Array
) -> Orbit:
    """The motion in pieces between impacts, each at the switch that is nearest to its level there."""
    resets = [] if system is None else list(resets_of(system))
    if system is None or not resets:
        raise ValueError("phases are given twice; they must rise, but at the impacts of a system= with some")
    second = np.flatnonzero(np.diff(phase) == 0) + 1
    values = np.abs(system.switch(state[second - 1], phase[second - 1], parameter)[:, resets])
    switches = [resets[k] for k in values.argmin(axis=1)]
    events = tuple(EventNode(k, system.switches[k].direction) for k in switches)
    first, period = second[0], FORCED * periods
    tau = np.concatenate([phase[first:], phase[1:first] + period])
    x, z = (np.concatenate([a[first:], a[1:first]]) for a in (state, algebraic))
    cuts = [0, *(second[1:] - first), len(tau)]
    lengths = np.diff(np.append(phase[second], phase[first] + period))
    counts = np.maximum(np.ceil(PER_PERIOD * lengths / FORCED).astype(int), MIN_INTERVALS)
    breaks = tuple(np.linspace(0, 1, count + 1) for count in counts)
    mesh = Mesh(Scheme(), breaks, events, period)
    grid = mesh.grid(phase[second])
    stages = grid.left[:, None] + grid.width[:, None] * mesh.scheme.points
    nodes, inner, unknown = [], [], []
    for cut, end, start, count in zip(cuts[:-1], cuts[1:], mesh.starts, counts, strict=True):
        part = slice(start, start + count)
        curve = scipy.interpolate.PchipInterpolator(tau[cut:end], x[cut:end], axis=0)
        nodes.append(curve(grid.left[part]))
        inner.append(curve(stages[part]))
        near = np.clip(np.searchsorted(tau[cut:end], stages[part]), 0, end - cut - 1)
        unknown.append(z[cut:end][near])
    knots = np.concatenate([*nodes, nodes[0][:1]])
    both = np.concatenate(inner), np.concatenate(unknown)
    return Orbit(mesh, knots, *both, phase[second], parameter)


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
    if phase.ndim != 1 or len(np.unique(phase)) < 4 or not (np.diff(phase) >= 0).all():
        raise ValueError("phases of the samples must be at least 4 rising numbers")
    length = float(phase[-1] - phase[0]) / FORCED
    periods = round(length) if math.isfinite(length) else 0
    if periods < 1 or abs(length - periods) > 1e-6:
        raise ValueError(
            f"the samples last {length:g} excitation periods; they must last a whole number of them"
        )
    return periods
