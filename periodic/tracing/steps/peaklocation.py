"""Where peak to peaks are stationary in a step: by Hermite's interpolation of all that is known within it.

An orbit solved for within a step tells the peak to peaks of all outputs and their slopes. A polynomial
through those of the nearest orbits predicts where a slope vanishes; once it predicts nearly the same place
with one more orbit, the orbit there is the one sought. Peaks of several outputs at one resonance share what
is known.

Where another of two maxima of a motion becomes the greater, the slope jumps: that corner is a peak as well.
No polynomial predicts it; the tangents of both ends meet there.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from periodic.bifurcations.location import refined_place
from periodic.bifurcations.testfunction import TestFunction
from periodic.bifurcations.turningpoint import Found
from periodic.bifurcations.withinstep import WithinStep
from periodic.correction.measured import measured
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.orbit.scheme import Array
from periodic.results.betweenpoints import CORNER

HALVED = 0.5
"""Part of itself to which four orbits shorten the interval in which a slope changes sign, or its end tangents
tell the next: where the step is long beside a peak, as beside a grazing, polynomials do not predict it."""

APART = 0.05
"""Least distance, in lengths of that interval, of a further orbit from it through which a polynomial is laid:
nearer ones say little more, and their rounding counts as the inverse of its fourth power."""

ROUNDED = 1e-9
"""Imaginary part up to which a root of a polynomial is real, and part of its largest coefficient up to which
its last ones are none. Where values differ by less than this part of themselves, slopes alone tell."""

ALIKE = 1e-3
"""Distance from a place predicted, in parts of the precision, up to which a known orbit is taken for it."""

EDGE = 0.01
"""Least distance from an end of it, in parts, at which both tangents may meet; else they tell nothing."""


def peaks(
    solver: Solver,
    base: Solution,
    new: Solution,
    ds: float,
    tests: Mapping[int, TestFunction],
    *,
    corners: bool = True,
) -> list[Found]:
    """Return the points of a step at which peak to peaks are stationary, in any order.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    base, new : Solution
        Its ends, on one mesh.
    ds : float
        Its length in arclength.
    tests : mapping of int to TestFunction
        By index of the output, the test function of its stationary points, of opposite signs at the ends.
    corners : bool
        Whether slopes may jump at them, as at a branch point where a doubled orbit becomes a plain one, and
        comes back through the orbits it came by.

    Returns
    -------
    list of Found
        Of each output one, or none where its slope has the same sign at both ends, or jumps and may not.

    Raises
    ------
    RejectedError
        Where there is no orbit within the step.
    """
    within = WithinStep(solver, base, {0.0: base, ds: new}, ds)
    return [found for output, test in tests.items() for found in _peak(within, output, test, ds, corners)]


def _peak(
    within: WithinStep, output: int, test: TestFunction, ds: float, corners: bool = True
) -> Iterator[Found]:
    """Yield the point of one output, if its slope vanishes, or if it changes sign."""
    precision, lengths = test.precision * ds, [np.inf] * 4
    while True:
        places, values, slopes = _known(within, output)
        (turns,) = np.nonzero(slopes[:-1] * slopes[1:] <= 0)
        if not len(turns):
            return
        k = int(turns[0])
        low, high = places[k], places[k + 1]
        place = _vertex(places, values, slopes, k)
        nearest = float(places[np.abs(places - place).argmin()])
        if abs(nearest - place) <= precision or high - low <= precision:
            break
        slow = high - low > HALVED * lengths[-4]
        lengths.append(high - low)
        within.at(_corner(places, values, slopes, k) if slow else place)
    slope = float(np.abs(slopes[places == nearest]).max())
    if not corners and slope > CORNER * max(abs(slopes[0]), abs(slopes[-1])):
        return
    at = nearest if abs(nearest - place) <= ALIKE * precision else place
    yield refined_place(within.solver, at, within.at(at), ds, test)


def _known(within: WithinStep, output: int) -> tuple[Array, Array, Array]:
    """Places of the orbits that are known within the step, the output's peak to peak and its slope there.

    Places are measured along the tangent of the base, slopes along that of each orbit.
    """
    found, base = sorted(within.known.items(), key=lambda item: item[0]), within.base
    along = within.solver.constraint(base.orbit, base.tangent, 0.0)
    each = [(measured(solution), along.rate(solution.tangent)) for _, solution in found]
    return (
        np.array([place for place, _ in found]),
        np.array([one.peak_to_peak[output] for one, _ in each]),
        np.array([one.peak_to_peak_slope[output] / rate for one, rate in each]),
    )


def _vertex(places: Array, values: Array, slopes: Array, turn: int) -> float:
    """Where the slope vanishes between `turn` and the next place, by a polynomial.

    It is laid through values and slopes at both and, where there is one no nearer, at the next place.
    """
    low, high = places[turn], places[turn + 1]
    if slopes[turn] == 0 or slopes[turn + 1] == 0:
        return float(low if slopes[turn] == 0 else high)
    length = high - low
    t, step = (places - low) / length, length * slopes
    chord = float(low + length * step[turn] / (step[turn] - step[turn + 1]))
    if np.abs(step[turn : turn + 2]).max() <= ROUNDED * np.abs(values[turn : turn + 2]).max():
        return chord
    away = np.abs(t - 0.5) - 0.5
    others = np.flatnonzero(away >= APART)
    chosen = [turn, turn + 1, *others[away[others].argsort()[:1]]]
    powers = np.arange(2 * len(chosen))
    rows = [t[chosen, None] ** powers, powers * t[chosen, None] ** np.maximum(powers - 1, 0)]
    known = np.concatenate([values[chosen] - values[turn], step[chosen]])
    derivative = np.polynomial.Polynomial(np.linalg.solve(np.vstack(rows), known)).deriv()
    short = derivative.trim(ROUNDED * float(np.abs(derivative.coef).max()))
    roots = np.asarray(short.roots(), dtype=np.complex128)
    inside = roots.real[(np.abs(roots.imag) < ROUNDED) & (roots.real > 0) & (roots.real < 1)]
    return float(low + length * inside[0]) if len(inside) == 1 else chord


def _corner(places: Array, values: Array, slopes: Array, turn: int) -> float:
    """Where the tangents at `turn` and at the next place meet; midway where that is beside one of them."""
    low, high = places[turn], places[turn + 1]
    step = (high - low) * slopes[turn : turn + 2]
    t = (values[turn + 1] - values[turn] - step[1]) / (step[0] - step[1])
    return float(low + (high - low) * (t if EDGE < t < 1 - EDGE else 0.5))
