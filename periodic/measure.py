"""Outputs along an orbit and their extremes, those of the continuous solution and not of the mesh points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.dense import algebraic_at
from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.system import System

CANDIDATES = 3
"""How many of the highest samples that stand out from their neighbours are looked at more closely."""

ZOOMS = 2
SAMPLES = 9

SHORT = 1e-5
"""Width (rad) of intervals whose points do not count, unless all are as short.

Next to a kink the collocation polynomials overshoot, and a load that falls by twenty powers of ten there
would be read off the overshoot.
"""

OUT = -1e300
"""Stands for samples that do not count."""


def outputs(system: System, orbit: Orbit, tau: Array) -> Array:
    """Return the outputs (SI) at phases tau, shape (len(tau), outputs).

    The unknowns are solved for at each phase from the algebraic rows; they are never interpolated.
    """
    algebraic = algebraic_at(system, orbit, tau)
    return system.output(orbit.rate(tau), orbit.state(tau), algebraic, tau, orbit.parameter)


@dataclass(frozen=True)
class Extremes:
    """Minimum and maximum (SI) of each output over the period and the phases of both, shape (outputs,)."""

    minimum: Array
    maximum: Array
    minimum_phase: Array
    maximum_phase: Array


def extrema(system: System, orbit: Orbit) -> Extremes:
    """Return the extremes of each output over one period."""
    if orbit.equilibrium:
        values = outputs(system, orbit, np.zeros(1))[0]
        return Extremes(values, values, np.zeros_like(values), np.zeros_like(values))
    tau = orbit.stage_phases.ravel()
    flat = (len(tau), -1)
    values = system.output(
        orbit.knot_rates[:, 1:].reshape(flat),
        orbit.stages.reshape(flat),
        orbit.algebraic.reshape(len(tau), orbit.algebraic.shape[2]),
        tau,
        orbit.parameter,
    )
    count = values.shape[1]
    both = np.concatenate([-values, values], axis=1)
    both[np.repeat(_short(orbit), orbit.mesh.scheme.ncol)] = OUT
    index = _candidates(both)
    row = np.repeat(np.arange(2 * count), CANDIDATES)
    signs = np.where(row < count, -1.0, 1.0)
    gaps = np.diff(tau, append=tau[0] + orbit.mesh.period)
    half = np.maximum(gaps, np.roll(gaps, 1))
    best, centre, radius = both[index, row], tau[index], half[index]
    for _ in range(ZOOMS):
        best, centre, radius = _zoom(system, orbit, signs, row % count, best, centre, radius)
    best, centre = best.reshape(2 * count, CANDIDATES), centre.reshape(2 * count, CANDIDATES)
    each, top = np.arange(2 * count), best.argmax(axis=1)
    value, phase = best[each, top], centre[each, top]
    return Extremes(-value[:count], value[count:], phase[:count], phase[count:])


def _candidates(values: Array) -> NDArray[np.int_]:
    """The CANDIDATES highest local maxima of each column of samples around the period, column by column."""
    peaks = (values >= np.roll(values, 1, axis=0)) & (values >= np.roll(values, -1, axis=0))
    ranked = np.argsort(np.where(peaks, values, -np.inf), axis=0)[-CANDIDATES:]
    return ranked.T.ravel()


def _zoom(
    system: System,
    orbit: Orbit,
    signs: Array,
    column: NDArray[np.int_],
    best: Array,
    centre: Array,
    radius: Array,
) -> tuple[Array, Array, Array]:
    """Look for the maximum of signs * output on a finer window around each centre, then at the vertex of
    the parabola through the largest sample and its neighbours."""
    grid = centre[:, None] + radius[:, None] * np.linspace(-1, 1, SAMPLES)
    chosen = _signed(system, orbit, signs, column, grid)
    each, peak = np.arange(len(signs)), chosen.argmax(axis=1)
    vertex = grid[each, peak] + radius * 2 / (SAMPLES - 1) * _offset(chosen, peak)
    grid = np.column_stack([grid[each, peak], vertex, centre])
    chosen = np.column_stack(
        [chosen[each, peak], _signed(system, orbit, signs, column, vertex[:, None])[:, 0], best]
    )
    peak = chosen.argmax(axis=1)
    return chosen[each, peak], grid[each, peak], radius * 2 / (SAMPLES - 1)


def _signed(system: System, orbit: Orbit, signs: Array, column: NDArray[np.int_], grid: Array) -> Array:
    """signs * output at the phases of each row's own output, shape of `grid`."""
    values = outputs(system, orbit, grid.ravel()).reshape(*grid.shape, -1)
    chosen = signs[:, None] * values[np.arange(len(signs)), :, column]
    return np.where(_short(orbit)[orbit.locate(grid.ravel())[0]].reshape(grid.shape), OUT, chosen)


def _short(orbit: Orbit) -> NDArray[np.bool_]:
    """Which intervals do not count, shape (N,)."""
    short = orbit.grid.width < SHORT
    return short & ~short.all()


def _offset(values: Array, peak: Array) -> Array:
    """Place of the parabola's vertex relative to the largest sample, in samples; 0 where it has none."""
    each, middle = np.arange(len(peak)), np.clip(peak, 1, SAMPLES - 2)
    low, top, high = (values[each, middle + k] for k in (-1, 0, 1))
    bend = low - 2 * top + high
    interior = (peak == middle) & (bend < 0)
    return np.where(interior, (low - high) / (2 * np.where(interior, bend, -1.0)), 0.0)
