"""Outputs along an orbit and their extremes, those of the continuous solution and not of the mesh points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.construction import as_read_by
from periodic.orbit.native import outputs as native
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.system.precision import LARGEST

CANDIDATES = 3
"""How many of the highest samples that stand out from their neighbours are looked at more closely."""

RISE = 2.0
"""By how much more than it exceeds its neighbours such a sample may be exceeded by what lies between them."""

ZOOMS = 2
SAMPLES = 9
PLACES = np.linspace(-1, 1, SAMPLES)

SHORT_INTERVAL = 1e-5
"""Width (rad) of intervals whose points do not count, unless all are as short.

Next to a kink the collocation polynomials overshoot, and a load that falls by twenty powers of ten there
would be read off the overshoot.
"""

OUT = -LARGEST
"""Stands for samples that do not count."""


def outputs(system: System, orbit: Orbit, tau: Array) -> Array:
    """Return the outputs at phases tau.

    The unknowns are solved for at each phase from the algebraic rows; they are never interpolated.

    Parameters
    ----------
    system : System
        The system, or an equal one with other scales.
    orbit : Orbit
        The orbit.
    tau : Array
        Phases in rad, shape (K,); tau = Omega t.

    Returns
    -------
    Array
        SI values, shape (K, outputs).

    Raises
    ------
    ValueError
        Where the orbit's names or units are not the system's.
    """
    return _outputs(system, as_read_by(system, orbit), tau)


def _outputs(system: System, orbit: Orbit, tau: Array) -> Array:
    compiled = native.outputs(system, orbit, tau)
    if compiled is not None:
        return compiled
    algebraic = algebraic_at(system, orbit, tau)
    return system.output(orbit.rate(tau), orbit.state(tau), algebraic, tau, orbit.parameter)


@dataclass(frozen=True)
class Extremes:
    """Minimum and maximum of each output over the period.

    Parameters
    ----------
    minimum, maximum : Array
        SI values, shape (outputs,).
    minimum_phase, maximum_phase : Array
        Where they are: phases in rad, shape (outputs,).
    """

    minimum: Array
    maximum: Array
    minimum_phase: Array
    maximum_phase: Array


def extrema(system: System, orbit: Orbit) -> Extremes:
    """Return the extremes of each output over one period, those of the continuous solution.

    Parameters
    ----------
    system : System
        The system, or an equal one with other scales.
    orbit : Orbit
        The orbit.

    Returns
    -------
    Extremes
        Values and phases.

    Raises
    ------
    ValueError
        Where the orbit's names or units are not the system's.
    """
    orbit = as_read_by(system, orbit)
    if orbit.equilibrium:
        values = outputs(system, orbit, np.zeros(1))[0]
        return Extremes(values, values, np.zeros_like(values), np.zeros_like(values))
    compiled = native.extremes(system, orbit)
    return _searched(system, orbit) if compiled is None else Extremes(*compiled)


def apart(system: System, orbit: Orbit, found: Extremes, better: Callable[[], Orbit]) -> float:
    """Return how far an orbit's extremes are at the most from those of a better one, over the peak to peak.

    They are compared at their phases, where it does not matter to first order that those of the better orbit
    are others; and as far beside them as its events are from the orbit's: outputs jump or have kinks there.

    Parameters
    ----------
    system : System
        The system.
    orbit : Orbit
        The orbit.
    found : Extremes
        Its extremes.
    better : callable
        Returns the same orbit on a finer mesh.

    Returns
    -------
    float
        Of the outputs that are no states; 0 where all are.
    """
    states = {state.name for state in system.states}
    own = [k for k, output in enumerate(system.outputs) if output.name not in states]
    if not own:
        return 0.0
    low, high = found.minimum[own], found.maximum[own]
    finer = better()
    late = float(np.abs(finer.phases - orbit.phases).max(initial=0.0))
    beside = np.array([-late, 0.0, late] if late else [0.0])
    at = np.array([found.minimum_phase[own], found.maximum_phase[own]])[:, :, None] + beside
    values = outputs(system, finer, at.ravel())[:, own].reshape(*at.shape, len(own))
    same = np.einsum("ekbk->ekb", values)
    errors = np.abs([same[0].min(axis=1) - low, same[1].max(axis=1) - high]).max(axis=0)
    scale = np.maximum(high - low, LEAST_SPAN * np.maximum(np.abs(low), np.abs(high)))
    return float(np.max(errors / np.where(scale > 0, scale, 1.0)))


def _searched(system: System, orbit: Orbit) -> Extremes:
    """The extremes of an orbit that is no equilibrium."""
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
    if (short := _short(orbit)).any():
        both[np.repeat(short, orbit.mesh.scheme.ncol)] = OUT
    row, index = _candidates(both)
    signs = np.where(row < count, -1.0, 1.0)
    gaps = np.diff(tau, append=tau[0] + orbit.mesh.period)
    half = np.maximum(gaps, np.roll(gaps, 1))
    best, phase = _zoomed(system, orbit, signs, row % count, both[index, row], tau[index], half[index])
    order = np.lexsort((best, row))
    top = order[np.searchsorted(row[order], np.arange(2 * count), side="right") - 1]
    value, phase = best[top], phase[top]
    return Extremes(-value[:count], value[count:], phase[:count], phase[count:])


def _candidates(values: Array) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """Columns and indices, column by column, of the CANDIDATES highest local maxima in samples around the
    period, without those that cannot become the highest.
    """
    before, after = np.roll(values, 1, axis=0), np.roll(values, -1, axis=0)
    peaks = np.where((values >= before) & (values >= after), values, -np.inf)
    ranked = np.argsort(peaks, axis=0)[-CANDIDATES:]
    highest = np.take_along_axis(peaks, ranked, axis=0)
    rise = highest - np.take_along_axis(np.minimum(before, after), ranked, axis=0)
    column, rank = np.nonzero((highest + RISE * rise >= highest[-1]).T)
    return column, ranked[rank, column]


def _zoomed(
    system: System,
    orbit: Orbit,
    signs: Array,
    column: NDArray[np.int_],
    best: Array,
    centre: Array,
    radius: Array,
) -> tuple[Array, Array]:
    """Look for the maximum of signs * output on finer and finer windows around each centre, the next at the
    vertex of the parabola through the largest sample and its neighbours; return it and its phase.
    """
    each, phase = np.arange(len(signs)), centre
    for _ in range(ZOOMS):
        grid = centre[:, None] + radius[:, None] * PLACES
        chosen = _signed(system, orbit, signs, column, grid)
        peak = chosen.argmax(axis=1)
        best, phase = _better(best, phase, chosen[each, peak], grid[each, peak])
        radius = radius * 2 / (SAMPLES - 1)
        centre = grid[each, peak] + radius * _offset(chosen, peak)
    return _better(best, phase, _signed(system, orbit, signs, column, centre[:, None])[:, 0], centre)


def _better(best: Array, phase: Array, value: Array, at: Array) -> tuple[Array, Array]:
    """The larger of two values, and its phase."""
    return np.maximum(best, value), np.where(value > best, at, phase)


def _signed(system: System, orbit: Orbit, signs: Array, column: NDArray[np.int_], grid: Array) -> Array:
    """signs * output at the phases of each row's own output, shape of `grid`."""
    values = _outputs(system, orbit, grid.ravel()).reshape(*grid.shape, -1)
    chosen = signs[:, None] * values[np.arange(len(signs)), :, column]
    short = _short(orbit)
    if not short.any():
        return chosen
    return np.where(short[orbit.locate(grid.ravel())[0]].reshape(grid.shape), OUT, chosen)


def _short(orbit: Orbit) -> NDArray[np.bool_]:
    """Which intervals do not count, shape (N,)."""
    short = orbit.grid.width < SHORT_INTERVAL
    return short & ~short.all()


def _offset(values: Array, peak: Array) -> Array:
    """Place of the parabola's vertex relative to the largest sample, in samples; 0 where it has none."""
    each, middle = np.arange(len(peak)), np.clip(peak, 1, SAMPLES - 2)
    low, top, high = (values[each, middle + k] for k in (-1, 0, 1))
    bend = low - 2 * top + high
    interior = (peak == middle) & (bend < 0)
    return np.where(interior, (low - high) / (2 * np.where(interior, bend, -1.0)), 0.0)
