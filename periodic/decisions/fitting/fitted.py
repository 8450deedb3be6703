"""The result of a fit: values with intervals, what the data cannot tell apart, and residuals."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import bisect, brentq
from scipy.stats import chi2, norm, t

from periodic.checks import between, one_of
from periodic.conditions.functionals import Smooth
from periodic.decisions.fitting.match import Foot, Match
from periodic.decisions.fitting.measured import Measured, MeasuredQuantity
from periodic.decisions.fitting.picture import draw
from periodic.decisions.fitting.proposal import proposal
from periodic.decisions.responses.box import Box
from periodic.decisions.responses.feature import LostError
from periodic.decisions.responses.quantity import AbsentError
from periodic.orbit.scheme import Array
from periodic.results.branch import Branch
from periodic.system import System

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FAR = 5.0
"""Standard deviations from which on a measured point is said not to be of the model."""

UNLIKELY = 1e-4
"""Probability of a misfit as large by chance below which it is said to be none."""

UNTOLD = 1 / np.sqrt(12)
"""Standard deviation of a number of which nothing but its range is known, in parts of the range."""

MENTIONED = 0.1
"""Smallest component of a direction that is named in a sentence about it."""

WIDEST = 8.0
"""How many of the linear interval's half widths a profile is searched for its ends."""

Loss = Callable[[Array], Array]

LOSSES: dict[str, tuple[Loss, Loss]] = {
    "linear": (lambda z: z, np.ones_like),
    "soft_l1": (lambda z: 2 * (np.sqrt(1 + z) - 1), lambda z: (1 + z) ** -0.5),
    "huber": (
        lambda z: np.where(z <= 1, z, 2 * np.sqrt(z) - 1),
        lambda z: np.where(z <= 1, 1.0, np.maximum(z, 1.0) ** -0.5),
    ),
    "cauchy": (np.log1p, lambda z: 1 / (1 + z)),
}
"""SciPy's losses of squared residuals z, and their derivatives, the weights."""


@dataclass(frozen=True, repr=False, kw_only=True)
class Fitted:
    """Parameters from measured responses.

    Parameters
    ----------
    reason : str
        Why it is not known to be the best fit; empty where it is.
    system : System
        The equations.
    match : Match
        The model with the motions nearest to what was measured.
    box : Box
        What was sought, with its ranges.
    data : tuple of Measured or MeasuredQuantity
        What was measured.
    loss : str
        How residuals count.
    branches : tuple of Branch
        The model's responses, one for each of the data.
    orbits : int
        How many orbits were solved for.
    again : callable
        Fits again from a match with some values held.
    """

    reason: str
    system: System
    match: Match
    box: Box
    data: tuple[Measured | MeasuredQuantity, ...]
    loss: str
    branches: tuple[Branch, ...]
    orbits: int
    again: Callable[[Match, Sequence[str]], tuple[Match, str]] = field(repr=False)

    @property
    def ok(self) -> bool:
        """Whether it is known to be the best fit near."""
        return not self.reason

    @property
    def values(self) -> dict[str, float]:
        """Parameters, gains and offsets (SI), by name."""
        return dict(self.match.values)

    @property
    def freedom(self) -> int:
        """Number of measured numbers less that of values sought."""
        return self.match.count - len(self.box.names)

    @property
    def scale(self) -> float:
        """Factor on all standard deviations: 1 where they were given, else estimated.

        Infinite of no more numbers than values sought, which leave nothing to estimate it from.
        """
        if not self._estimated:
            return 1.0
        z = self.match.residual**2
        left = float(np.sum(z * LOSSES[self.loss][1](z)))
        return float(np.sqrt(left / self.freedom)) if self.freedom > 0 else np.inf

    @property
    def _estimated(self) -> bool:
        """Whether the scatter of the data is to be estimated from what the fit leaves."""
        return any(isinstance(each, Measured) and each.scaled for each in self.data)

    @property
    def chance(self) -> float:
        """The probability that chance alone leaves as much; 1 where the scatter was estimated from it."""
        known = self.freedom > 0 and self.loss == "linear" and not self._estimated
        return float(chi2.sf(self.match.misfit, self.freedom)) if known else 1.0

    @property
    def covariance(self) -> Array:
        """Covariance of the values (SI), infinite on what the data do not tell at all, shape (n, n)."""
        _, singular, directions = self._singular
        lost = singular <= np.finfo(float).eps * len(self.match.residual) * singular[0]
        variances = np.where(lost, np.inf, self.scale**2 / np.where(lost, 1.0, singular) ** 2)
        found = np.zeros((len(directions), len(directions)))
        for variance, direction in zip(variances, directions, strict=True):
            square = np.outer(direction, direction)
            told = np.abs(square) > 1e-12
            found[told] += variance * square[told]
        return found * np.outer(self.box.widths, self.box.widths)

    @property
    def errors(self) -> dict[str, float]:
        """Standard errors of the values (SI), by name."""
        return dict(zip(self.box.names, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    @property
    def correlation(self) -> Array:
        """Correlation of the values, shape (n, n); 0 of those that the data do not tell at all."""
        covariance = self.covariance
        deviations = np.sqrt(np.diag(covariance))
        known = np.isfinite(np.outer(deviations, deviations))
        return np.where(known, covariance, 0.0) / np.where(known, np.outer(deviations, deviations), 1.0)

    def interval(self, name: str, confidence: float = 0.95, *, profile: bool = False) -> tuple[float, float]:
        """Return an interval (SI) that holds the true value with a confidence.

        Parameters
        ----------
        name : str
            A value that was sought.
        confidence : float
            Between 0 and 1.
        profile : bool
            Whether to find it by profile likelihood: the values at which the least sum of squares, all others
            fitted anew, has risen by as much as chance would. Else it is linear, value +- error times a
            quantile of the normal distribution, or Student's where the scatter was estimated.

        Returns
        -------
        tuple of float
            Its ends; an end of the range where it does not end before.

        Raises
        ------
        ValueError
            For an unknown name.
        """
        k = self.box.names.index(one_of("name", name, self.box.names))
        part = 0.5 + between("confidence", confidence, 0.0, 1.0) / 2
        student = self._estimated and self.freedom > 0
        factor = float(t.ppf(part, self.freedom) if student else norm.ppf(part))
        half, value = factor * self.errors[name], self.values[name]
        ends = (max(value - half, self.box.low[k]), min(value + half, self.box.high[k]))
        if not profile:
            return float(ends[0]), float(ends[1])
        reach = min(half, self.box.widths[k])
        return self._profiled(name, factor, -reach), self._profiled(name, factor, reach)

    def _profiled(self, name: str, factor: float, step: float) -> float:
        """The value on one side at which the least cost has risen by the factor squared."""
        value, k = self.values[name], self.box.names.index(name)
        low, high = float(self.box.low[k]), float(self.box.high[k])
        known = {value: self.match}

        def risen(at: float) -> float:
            near = known[min(known, key=lambda other: abs(other - at))]
            try:
                known[at] = self.again(near.at({**near.values, name: at}), [name])[0]
            except (LostError, AbsentError):  # the model has no such motions there
                return np.inf
            rise = max(self._cost_of(known[at]) - self._cost_of(self.match), 0.0) / self.scale**2
            return float(np.sqrt(rise)) - factor

        inner, outer = value, float(np.clip(value + step, low, high))
        while risen(outer) < 0:
            if outer in (low, high) or abs(outer - value) > WIDEST * abs(step):
                return outer
            inner, outer = outer, float(np.clip(outer + step / 2, low, high))
        solved = brentq if np.isfinite(risen(outer)) else bisect
        return float(
            solved(lambda at: -factor if at == value else risen(at), inner, outer, xtol=1e-3 * abs(step))
        )

    def _cost_of(self, match: Match) -> float:
        return float(np.sum(LOSSES[self.loss][0](match.residual**2)))

    @cached_property
    def _singular(self) -> tuple[Array, Array, Array]:
        """Singular values and directions of the weighted derivatives, in parts of the ranges."""
        weights = np.sqrt(LOSSES[self.loss][1](self.match.residual**2))
        found = np.linalg.svd(weights[:, None] * self.match.jacobian * self.box.widths, full_matrices=False)
        return found[0], found[1], found[2]

    @property
    def untold(self) -> tuple[dict[str, float], ...]:
        """Directions in which the data tell less than the ranges of the values do, the worst first.

        Changes of the values (SI) by name that belong together, scaled so that the misfit rises by one: each
        is what cannot be told apart, or a single value that is not determined.
        """
        _, singular, directions = self._singular
        found = []
        for size, direction in sorted(
            zip(singular, directions, strict=True), key=lambda pair: float(pair[0])
        ):
            spread = self.scale / size if size > 0 else np.inf
            if spread < UNTOLD:
                break
            named = np.abs(direction) >= MENTIONED
            first = direction[int(np.argmax(named))]
            step = np.sign(first) * direction * min(spread, 1.0) * self.box.widths
            found.append({n: float(s) for n, s, yes in zip(self.box.names, step, named, strict=True) if yes})
        return tuple(found)

    @cached_property
    def remarks(self) -> tuple[str, ...]:
        """What a reader should know: what is not told, values at ends of ranges, points far away."""
        said = [f"not known to be the best fit: {self.reason}"] if self.reason else []
        if self.chance < UNLIKELY:
            said.append(
                f"chi squared is {self.match.misfit:.3g} with {self.freedom} degrees of freedom, which "
                f"chance has with a probability of {self.chance:.0e}: model or standard deviations are "
                f"wrong, or another start={{...}} is needed"
            )
        for branch in self.branches:
            if any(stop.reason.numerical for stop in branch.stops):
                said.append(f"the branch over {branch.parameter} stopped early: {branch.ending}")
        said += [self._untold(step) for step in self.untold]
        for name, value in self.values.items():
            k = self.box.names.index(name)
            if min(value - self.box.low[k], self.box.high[k] - value) <= 1e-6 * self.box.widths[k]:
                said.append(f"{name} is at an end of its range, {value:.6g}: a wider one may fit better")
        said += [f"{each} standard deviations from the model" for each in self._far]
        return tuple(said)

    def _untold(self, step: Mapping[str, float]) -> str:
        """What the data do not tell in a direction, and what would."""
        changes = ", ".join(f"{name} by {change:+.3g}" for name, change in step.items())
        if len(step) == 1:
            said = f"{next(iter(step))} is not determined by these data: {changes} changes nothing that shows"
        else:
            said = f"{' and '.join(step)} cannot be told apart: {changes} together change nothing that shows"
        both = zip(self.data, self.branches, strict=True)
        tests = [(d, branch) for d, branch in both if isinstance(d, Measured)]
        better = proposal(self.system, tests, step)
        return f"{said}; {better} would tell" if better else f"{said}, nor would another amplitude or phase"

    @property
    def _far(self) -> list[str]:
        found = []
        for part in self.match.parts:
            size = float(np.linalg.norm(part.difference)) / self.scale
            if size > FAR:
                found.append(f"{part} is {size:.1f}")
        return found

    def plot(self, functional: Smooth | None = None) -> Axes:
        """Plot measured points beside the model's branches, above their residuals.

        Parameters
        ----------
        functional : functional, optional
            What is plotted; by default what was measured first.

        Returns
        -------
        matplotlib.axes.Axes
            The upper axes.

        Raises
        ------
        ValueError
            For a functional of which no points were measured.
        """
        both = zip(self.data, self.branches, strict=True)
        return draw(self.match, [(d, b) for d, b in both if isinstance(d, Measured)], functional)

    def table(self) -> str:
        """Return a line for each value: the value, its error, its 95 % interval; then the remarks.

        Returns
        -------
        str
            A heading and the lines, of one width, and the remarks.
        """
        rows = [["", "value", "error", "95 % from", "to"]]
        for name in self.box.names:
            low, high = self.interval(name)
            rows.append(
                [name, f"{self.values[name]:.8g}", f"{self.errors[name]:.2g}", f"{low:.6g}", f"{high:.6g}"]
            )
        widths = [max(len(row[i]) for row in rows) for i in range(5)]
        lines = ["  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows]
        return "\n".join([*lines, *self.remarks])

    def __str__(self) -> str:
        return self.table()

    def __repr__(self) -> str:
        kind = "ok" if self.ok else "not settled"
        return (
            f"Fitted({', '.join(self.box.names)}, {self.match.count} numbers, {kind}, {self.orbits} orbits)"
        )

    def __getitem__(self, name: str) -> float:
        return self.values[one_of("name", name, self.box.names)]

    @property
    def differences(self) -> Mapping[str, Array]:
        """Residuals of all points over their standard deviations, by the names of the tests; place first."""
        found: dict[str, list[Array]] = {}
        for part in self.match.parts:
            name = part.spot.measured.name if isinstance(part, Foot) else str(part)
            found.setdefault(name, []).append(part.difference)
        return {key: np.array(rows) for key, rows in found.items()}
