"""Peak to peak of outputs that a branch watches: where they are greatest or least, and how far steps may go.

A reader sees them between the points too, as cubics through the points with their slopes
(`periodic.results.betweenpoints`). Steps are so long that these are right to PART of their range, and where
one is stationary in a step the branch gets a point.

How far off they are is told by the cubic of the step before, continued: at the end of this step it is off by
m''''/24 (s - a)^2 (s - b)^2, a and b its ends, and its slope by the derivative of that. The cubic of this
step is off by m'''' h^4/384 in its middle. The larger of the two m'''' counts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.correction.measured import measured
from periodic.correction.solution import Solution
from periodic.orbit.scheme import Array
from periodic.results.point import Point

PART = 1e-2
"""Largest error of the cubic between two points, in parts of the range of a measure along the branch."""

BEHIND = 0.5
"""Least length of what is continued over a step, in steps: rounding grows as its inverse's cube."""


@dataclass
class _Ranges:
    """The least and the greatest of each along a branch, over as many of its points as were looked at."""

    seen: int = 0
    low: Array = field(default_factory=lambda: np.array(np.inf))
    high: Array = field(default_factory=lambda: np.array(-np.inf))

    def over(self, points: Sequence[Point], values: Callable[[Point], Array]) -> None:
        """Look at the points that have come since; at all of a branch that has been cut."""
        if len(points) < self.seen:
            self.seen, self.low, self.high = 0, np.array(np.inf), np.array(-np.inf)
        for point in points[self.seen :]:
            found = values(point)
            self.low, self.high = np.minimum(self.low, found), np.maximum(self.high, found)
        self.seen = len(points)


@dataclass(frozen=True)
class WatchedSwings:
    """Peak to peak of outputs along a branch.

    Parameters
    ----------
    tests : mapping of str to TestFunction
        By output, the test function of its stationary points.
    tolerance : float
        Of orbits: what is as small as the error of a peak to peak is no peak.
    least : mapping of str to float
        By output, the peak to peak (SI) at which it is at rest: errors are compared with no less.
    """

    tests: Mapping[str, TestFunction] = field(default_factory=dict)
    tolerance: float = 0.0
    least: Mapping[str, float] = field(default_factory=dict)
    _ranges: _Ranges = field(default_factory=_Ranges, init=False, repr=False, compare=False)

    def stationary(self, before: Point, new: Solution, ds: float) -> dict[int, TestFunction]:
        """Return those that have a peak or trough in a step.

        Parameters
        ----------
        before : Point
            Where the step begins.
        new : Solution
            Its end.
        ds : float
            Its length in arclength.

        Returns
        -------
        dict of int to TestFunction
            By index of the output, of those whose slopes have opposite signs at its ends. Where one of them
            is 0, within the error of the peak to peak over the step, that end is as high.
        """
        if not self.tests or before.equilibrium or new.orbit.equilibrium:
            return {}
        begin, end, rows = self._at(before), self._ends(new), self._rows(new)
        way = ds * np.minimum(np.abs(begin[1]), np.abs(end[1]))
        turned = (begin[1] * end[1] < 0) & (way > self._noise(np.maximum(begin[0], end[0])))
        each = zip(rows, self.tests.values(), turned, strict=True)
        return {row: test for row, test, here in each if here}

    def turns_twice(self, before: Point, new: Solution, ds: float) -> bool:
        """Return whether one of them has a peak and a trough in a step, by its cubic.

        Parameters
        ----------
        before, new, ds
            As of `stationary`, which sees neither: the slopes have the same sign at both ends.

        Returns
        -------
        bool
            Whether the way between both exceeds the errors of the peak to peaks. Not told from a grazing,
            where slopes are others on either side.
        """
        if not self.tests or before.equilibrium or new.orbit.equilibrium or before.label is Label.GRAZING:
            return False
        (a, a_slope), (b, b_slope) = self._at(before), self._ends(new)
        back = _back(b - a, ds * a_slope, ds * b_slope)
        return bool((back > 2 * self._noise(np.maximum(a, b))).any())

    def _noise(self, swing: Array) -> Array:
        """The errors that peak to peaks of a size may have."""
        return self.tolerance * np.maximum(swing, [self.least.get(output, 0.0) for output in self.tests])

    def ratio(self, behind: Sequence[Point], new: Solution, ds: float) -> float:
        """Return how long a step is to one whose cubics would be as far off as they may be.

        Parameters
        ----------
        behind : sequence of Point
            The points so far, the step's begin last.
        new : Solution
            Its end.
        ds : float
            Its length in arclength.

        Returns
        -------
        float
            The largest of all outputs; 0 where nothing tells.
        """
        former = self._former(behind, ds)
        if former is None or new.orbit.equilibrium:
            return 0.0
        begin, length = former
        (a, a_slope), (b, b_slope), (c, c_slope) = begin, self._at(behind[-1]), self._ends(new)
        value, slope = _continued(a, a_slope, b, b_slope, length, ds)
        total = length + ds
        off = np.maximum(
            np.abs(c - value) * ds**2 / (16 * total**2),
            np.abs(c_slope - slope) * ds**3 / (32 * total * (total + ds)),
        )
        self._ranges.over(behind, lambda point: self._at(point)[0])
        low, high = np.minimum(self._ranges.low, c), np.maximum(self._ranges.high, c)
        allowed = PART * (high - low) + self._noise(high)
        with np.errstate(invalid="ignore", divide="ignore"):
            found = np.where(allowed > 0, off / allowed, 0.0)
        return float(np.nan_to_num(found, posinf=0.0).max(initial=0.0) ** 0.25)

    def _former(self, behind: Sequence[Point], ds: float) -> tuple[Array, float] | None:
        """Values and slopes at a point behind, as far from the last one as tells, and how far it is."""
        if not self.tests or behind[-1].label is Label.GRAZING:
            return None
        gone = 0.0
        for point, after in zip(behind[-2::-1], behind[:0:-1], strict=False):
            if point.equilibrium or point.label is Label.GRAZING:
                return None
            gone += self._between(point, after)
            if not np.isfinite(gone):
                return None
            if gone >= BEHIND * ds:
                return self._at(point), gone
        return None

    def _between(self, a: Point, b: Point) -> float:
        """The arclength between two points, by the trapezoidal rule, of what moves most evenly."""
        begin, end = (np.column_stack([[p.parameter, p.slope], self._at(p)]) for p in (a, b))
        way, both = end[0] - begin[0], begin[1] + end[1]
        with np.errstate(invalid="ignore", divide="ignore"):
            bend = np.nan_to_num(np.abs((end[1] - begin[1]) / both), nan=np.inf)
            even = int(bend.argmin())
            return float(2 * way[even] / both[even]) if way.any() else 0.0

    def _at(self, point: Point) -> Array:
        """Values and slopes of a point, shape (2, outputs watched); NaN where a file has no slopes."""
        rising, falling = point.maximum_slope, point.minimum_slope
        pairs = [
            (point.maximum[o] - point.minimum[o], rising.get(o, np.nan) - falling.get(o, np.nan))
            for o in self.tests
        ]
        return np.array(pairs, dtype=float).reshape(-1, 2).T

    def _rows(self, solution: Solution) -> list[int]:
        """The indices of the outputs that are watched."""
        names = [output.name for output in solution.problem.full.outputs]
        return [names.index(output) for output in self.tests]

    def _ends(self, solution: Solution) -> Array:
        """Values and slopes of a solution, shape (2, outputs watched)."""
        found, rows = measured(solution), self._rows(solution)
        return np.array([found.peak_to_peak[rows], found.peak_to_peak_slope[rows]])


def _continued(
    a: Array, a_slope: Array, b: Array, b_slope: Array, length: float, ds: float
) -> tuple[Array, Array]:
    """The cubic through two values with slopes, a length apart, and its slope, `ds` beyond the second."""
    way, first, last = b - a, length * a_slope, length * b_slope
    square, cube = 3 * way - 2 * first - last, first + last - 2 * way
    t = 1 + ds / length
    return a + t * (first + t * (square + t * cube)), (first + t * (2 * square + 3 * t * cube)) / length


def _back(way: Array, first: Array, last: Array) -> Array:
    """How far cubics with slopes of the same sign at 0 and 1 go back in between; 0 where they do not.

    The slope first + 2 s t + 3 c t^2 has its roots r = 2 (s^2 - 3 c first)^(1/2)/(3 |c|) apart, between which
    the cubic goes by |c| r^3/2.
    """
    square, cube = 3 * way - 2 * first - last, first + last - 2 * way
    root = square**2 - 3 * cube * first
    with np.errstate(invalid="ignore", divide="ignore"):
        middle = -square / (3 * cube)
        inside = (first * last > 0) & (first * cube > 0) & (root > 0) & (middle > 0) & (middle < 1)
        return np.where(inside, 4 * np.abs(root) ** 1.5 / (27 * cube**2), 0.0)
