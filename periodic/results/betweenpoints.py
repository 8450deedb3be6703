"""Curves between the points of a branch, from their tangents: right there as at the points, to fourth order.

Parameter and measure are cubics in arclength in each interval, through both ends with their slopes. How long
an interval is they say themselves: it is the length with which the trapezoidal rule, length times the mean of
both slopes, comes nearest to the way from one end to the other, in parts of the ranges of both.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from periodic.bifurcations.label import Label
from periodic.orbit.scheme import Array
from periodic.results.peaks import PEAK_OF
from periodic.results.point import Point
from periodic.system.precision import SMALLEST

PER_SEGMENT = 8
"""Parts into which the way between two points is cut."""

CORNER = 1e-3
"""Largest slope at a smooth peak, found to 1e-7 of a step, in parts of the larger one of its neighbours. At a
corner, where another of two maxima of a motion becomes the greater, the slope jumps."""

WEIGHTS = {"min": (1.0, 0.0), "max": (0.0, 1.0), "p-p": (-1.0, 1.0)}
"""What measures of an output are made of: parts of its least and of its greatest value."""


def slopes_of(points: Sequence[Point], column: str) -> tuple[Array, Array] | None:
    """Return how the parameter and a column of a branch change along it.

    Parameters
    ----------
    points : sequence of Point
        Points of the branch.
    column : str
        "x p-p", "x min", "x max" of an output x, or of equilibria "x" itself.

    Returns
    -------
    tuple of Array or None
        Derivatives in arclength, shape (points,) each; NaN where they are not known, and where they are
        others on either side: where an event is grazed, and, that of the column, at corners. None of another
        column.
    """
    output, _, measure = column.rpartition(" ")
    if measure not in WEIGHTS:
        output, measure = column, "max"
    if not points or output not in points[0].maximum:
        return None
    least, most = WEIGHTS[measure]
    known = [
        (p.slope, least * p.minimum_slope.get(output, np.nan) + most * p.maximum_slope.get(output, np.nan))
        for p in points
    ]
    found = np.array(known, dtype=float).reshape(-1, 2)
    found[[p.label is Label.GRAZING for p in points]] = np.nan
    found[_corners(points, output), 1] = np.nan
    return found[:, 0], found[:, 1]


def _corners(points: Sequence[Point], output: str) -> list[int]:
    """The indices of the peaks of an output at which the slope of its peak to peak jumps."""
    name = PEAK_OF + output
    slope = [abs(p.maximum_slope.get(output, np.nan) - p.minimum_slope.get(output, np.nan)) for p in points]
    peaks = [k for k in range(1, len(points) - 1) if points[k].event == name]
    return [k for k in peaks if slope[k] > CORNER * max(slope[k - 1], slope[k + 1])]


def lengths(x: Array, y: Array, x_slope: Array, y_slope: Array) -> Array:
    """Return the arclength between neighbouring points; NaN where the slopes do not tell it.

    Parameters
    ----------
    x, y : Array
        Two quantities along a branch, shape (K,).
    x_slope, y_slope : Array
        Their derivatives in arclength; NaN where they are not known.

    Returns
    -------
    Array
        Shape (K - 1,).
    """
    way, mean = np.zeros((2, 2, max(len(x) - 1, 0)))
    for k, (values, slope) in enumerate(((x, x_slope), (y, y_slope))):
        span = float(np.ptp(values)) if len(values) else 0.0
        if not span > 0:
            continue
        begin, end = slope[:-1], slope[1:]
        way[k] = np.diff(values) / span
        mean[k] = np.where(np.isnan(begin), end, np.where(np.isnan(end), begin, (begin + end) / 2)) / span
    size = np.sum(mean**2, axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        found = np.sum(way * mean, axis=0) / size
    return np.where(found > 0, found, np.nan)


def cubics(values: Array, slope: Array, length: Array, theta: Array) -> Array:
    """Return the cubics between neighbouring values at parts theta of the way, shape (K - 1, len(theta)).

    With one slope they are parabolas, without straight.
    """
    way = np.diff(values)
    begin, end = length * slope[:-1], length * slope[1:]
    other = 2 * way - np.where(np.isnan(end), way, end)
    first = np.where(np.isnan(begin), other, begin)
    last = np.where(np.isnan(end), 2 * way - first, end)
    t, w = theta[None, :], way[:, None]
    bend = first[:, None] * t * (1 - t) ** 2 - last[:, None] * t**2 * (1 - t)
    return values[:-1, None] + w * t**2 * (3 - 2 * t) + bend


def curve(x: Array, y: Array, x_slope: Array, y_slope: Array, each: int = PER_SEGMENT) -> tuple[Array, Array]:
    """Return the curve of two quantities along a branch, `each` values an interval and the last one.

    Parameters
    ----------
    x, y, x_slope, y_slope : Array
        As in `lengths`.
    each : int
        Values between one point, which is the first of them, and the next.

    Returns
    -------
    tuple of Array
        x and y, shape ((K - 1) each + 1,).
    """
    if len(x) < 2:
        return x, y
    length, theta = lengths(x, y, x_slope, y_slope), np.arange(each) / each
    return (
        np.append(cubics(x, x_slope, length, theta).ravel(), x[-1:]),
        np.append(cubics(y, y_slope, length, theta).ravel(), y[-1:]),
    )


def smooth(x: Array, y: Array, each: int = PER_SEGMENT) -> tuple[Array, Array]:
    """Return a curve through points of which no slopes are known, `each` values from one to the next.

    Monotone cubics in the chord length: they reverse in x at the points alone.

    Parameters
    ----------
    x, y : Array
        The points, shape (K,).
    each : int
        Values from one point, which is the first of them, to the next.

    Returns
    -------
    tuple of Array
        x and y, shape ((K - 1) each + 1,).
    """
    from scipy.interpolate import PchipInterpolator

    if len(x) < 2:
        return x, y
    spans = [max(float(np.ptp(values)), SMALLEST) for values in (x, y)]
    chords = np.hypot(np.diff(x) / spans[0], np.diff(y) / spans[1])
    length = np.concatenate([[0.0], np.cumsum(np.maximum(chords, 1e-9))])
    parts = np.arange(len(x) - 1)[:, None] + np.arange(each) / each
    where = np.interp(np.append(parts, len(x) - 1), np.arange(len(x)), length)
    points = np.column_stack([x, y])
    found = PchipInterpolator(length, points)(where)
    found[::each] = points
    return found[:, 0], found[:, 1]
