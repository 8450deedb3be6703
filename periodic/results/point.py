"""A point of a branch: an orbit and what is known of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from periodic.bifurcations.codimension2.codim2 import marginal
from periodic.bifurcations.label import Label
from periodic.bifurcations.ledger import Entry, growth, noise
from periodic.checks import ByName, one_of
from periodic.correction.error import AT_WORST, ErrorEstimate
from periodic.correction.measured import measured
from periodic.correction.solution import Solution
from periodic.display.htmltables import paragraph
from periodic.orbit.extrema import Extremes, apart, extrema
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import ERRORS_FROM_ONE, LOST_FLOW, ROUNDED_ONE, without_trivial
from periodic.system.precision import EPSILON

SHOWN = 8
"""Largest number of multipliers that a notebook shows."""


@dataclass(frozen=True, eq=False, repr=False)
class Point:
    """An orbit of a branch and what is known of it.

    A point is stable when all nontrivial multipliers lie inside the unit circle; of a conservative orbit they
    may lie on it, to within their error. A special point with a multiplier on the circle is not stable, nor
    is a `marginal` point. An equilibrium is stable when all real parts are negative.

    Parameters
    ----------
    orbit : Orbit
        The orbit.
    parameter : float
        The continuation parameter (SI).
    label : Label
        What kind of special point it is, if one.
    multipliers : ndarray of complex, shape (n,)
        Floquet multipliers, largest first; of an equilibrium the eigenvalues of its Jacobian (1/s), largest
        real part first. Where friction holds a joint all along they are those at its given place.
    minimum, maximum : dict
        Extremes of each output over the period (SI), by name.
    error : ErrorEstimate
        Estimated errors of orbit, multipliers and parameter.
    residual : float
        Of the discretised equations.
    iterations : int
        Newton iterations.
    slope : float
        d parameter / d arclength.
    trivial : float, optional
        Distance from 1 of the trivial multiplier of an autonomous orbit (two of a conservative one), which
        measures the accuracy of the multipliers; None for a forced orbit.
    conservative : bool
        Whether two multipliers are 1 whatever the parameters.
    marginal : bool
        Whether it is on a curve of points with a multiplier on the unit circle.
    event : str
        The user's name of the event met there.
    columns : dict
        Functionals asked for, by name.
    minimum_slope, maximum_slope : dict
        d minimum / d arclength and d maximum / d arclength of each output (SI), by name; empty where a file
        is older than they are.
    """

    orbit: Orbit
    parameter: float
    label: Label
    multipliers: NDArray[np.complex128]
    minimum: dict[str, float]
    maximum: dict[str, float]
    error: ErrorEstimate
    residual: float
    iterations: int
    slope: float
    trivial: float | None = None
    conservative: bool = False
    marginal: bool = False
    event: str = ""
    columns: dict[str, float] = field(default_factory=dict)
    minimum_slope: dict[str, float] = field(default_factory=dict)
    maximum_slope: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("minimum", "maximum", "minimum_slope", "maximum_slope"):
            object.__setattr__(self, name, ByName("output", getattr(self, name)))
        object.__setattr__(self, "columns", ByName("column", self.columns))

    def __repr__(self) -> str:
        kind = " ".join(filter(None, [self.label.value, self.event, "stable" if self.stable else "unstable"]))
        return f"Point({self.parameter:.12g}, {kind})"

    def _repr_html_(self) -> str:
        shown = ", ".join(f"{m:.5g}" for m in self.multipliers[:SHOWN])
        kind = "eigenvalues (1/s)" if self.equilibrium else "multipliers"
        return paragraph(f"{self!r}, {kind} {shown}") + self.orbit._repr_html_()

    @property
    def stable(self) -> bool:
        """Whether small disturbances die away, or of a conservative orbit stay small."""
        if self.marginal or self.label.critical:
            return False
        if self.equilibrium:
            return bool((self.multipliers.real < 0).all())
        slack = ERRORS_FROM_ONE * self.error.multiplier + ROUNDED_ONE if self.conservative else 0.0
        return bool((np.abs(self.nontrivial) < 1 + slack).all())

    @property
    def equilibrium(self) -> bool:
        """Whether the orbit is constant."""
        return self.orbit.equilibrium

    @property
    def nontrivial(self) -> NDArray[np.complex128]:
        """The multipliers without those that are 1 whatever the parameters, largest first."""
        return without_trivial(self.multipliers, 0 if self.trivial is None else 1 + self.conservative)

    @property
    def floor(self) -> float:
        """The noise floor: multipliers of this size or less are only known to be so small.

        AT_WORST times their error, rounding included, relative to the largest where that exceeds 1.
        """
        largest = float(np.abs(self.multipliers).max(initial=1.0))
        return AT_WORST * (self.error.multiplier + EPSILON) * largest

    def entry(self, scale: float) -> Entry:
        """Return the point as the ledger of its branch has it.

        Parameters
        ----------
        scale : float
            The parameter's range (SI).

        Returns
        -------
        Entry
            What the ledger needs.
        """
        lost = self.marginal or (self.trivial is not None and self.trivial > LOST_FLOW)
        return Entry(
            label=self.label,
            value=self.parameter,
            slope=self.slope / scale,
            growth=growth(self.nontrivial, self.equilibrium),
            noise=np.inf if lost else noise(self.error, self.multipliers),
            blur=self.error.motion * abs(self.parameter),
            equilibrium=self.equilibrium,
            conservative=self.conservative,
        )

    def peak_to_peak(self, output: str) -> float:
        """Return maximum minus minimum of an output.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        float
            SI value.

        Raises
        ------
        ValueError
            For a name that is none; it says which there are.
        """
        one_of("output", output, self.maximum)
        return self.maximum[output] - self.minimum[output]


def _distance(multipliers: NDArray[np.complex128], count: int) -> float | None:
    """Distance from 1 of the mean and of the product of the `count` multipliers nearest 1; None for none.

    Both are as accurate as the other multipliers; those two, nearly equal, are not.
    """
    nearest = multipliers[np.abs(multipliers - 1).argsort()[:count]]
    return float(max(abs(nearest.mean() - 1), abs(nearest.prod() - 1))) if count else None


def describe(solution: Solution, label: Label, event: str, columns: dict[str, float]) -> Point:
    """Return what is said of a solution: label, the user's name of an event, columns, and all the rest."""
    problem, orbit = solution.problem, solution.problem.expand(solution.orbit)
    measures = measured(solution)
    found = measures.extremes
    names = [output.name for output in problem.full.outputs]

    def by_name(values: Array) -> dict[str, float]:
        return dict(zip(names, map(float, values), strict=True))

    multipliers = solution.spectrum.multipliers
    order = -multipliers.real if orbit.equilibrium else -np.abs(multipliers)
    return Point(
        orbit=orbit,
        parameter=solution.value,
        label=label,
        multipliers=multipliers[np.argsort(order, kind="stable")],
        minimum=by_name(found.minimum),
        maximum=by_name(found.maximum),
        error=_with_peaks(solution, found),
        residual=solution.correction.residual,
        iterations=solution.correction.iterations,
        slope=solution.tangent.parameter,
        trivial=_distance(multipliers, problem.trivial),
        conservative=problem.trivial > 1,
        marginal=marginal(problem),
        event=event,
        columns=columns,
        minimum_slope=by_name(measures.minimum_slope),
        maximum_slope=by_name(measures.maximum_slope),
    )


def _with_peaks(solution: Solution, found: Extremes) -> ErrorEstimate:
    """The error estimate, completed by the error of the outputs' extremes."""
    problem, other, better = solution.problem, solution.estimated, solution.error.better
    if better is None:
        return solution.error
    orbit = problem.expand(other.orbit)
    own = found if other is solution else extrema(problem.full, orbit)
    return replace(solution.error, better=None, peaks=apart(problem.full, orbit, own, better))


def multipliers_of(points: Sequence[Point], states: int) -> NDArray[np.complex128]:
    """Return the multipliers of points, one row a point, rows with fewer than others filled up with NaN.

    There are as many as states; of a system with a condensed linear part only the leading ones are known.
    """
    width = max((len(p.multipliers) for p in points), default=states)
    found = np.full((len(points), width), complex(np.nan, np.nan))
    for row, point in zip(found, points, strict=True):
        row[: len(point.multipliers)] = point.multipliers
    return found


def known_of(multipliers: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Return the multipliers of a row without the NaN that fill it up."""
    return multipliers[~np.isnan(multipliers.real)]
