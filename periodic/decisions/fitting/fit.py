"""Parameters from measured responses, by least squares with exact derivatives, on all sheets of a branch.

Each measured point is compared with the nearest motion of its branch (see `match`); SciPy's `least_squares`
moves the parameters, Newton's method the motions. Then branches are traced anew and each point looks for its
nearest sheet again, until none changes its place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from periodic.checks import one_of, shown
from periodic.decisions.fitting.fitted import LOSSES, UNTOLD, Fitted
from periodic.decisions.fitting.match import Match
from periodic.decisions.fitting.matching import matched, sensors_of
from periodic.decisions.fitting.measured import Measured, MeasuredQuantity
from periodic.decisions.responses.box import Box
from periodic.decisions.responses.feature import Count, LostError
from periodic.decisions.responses.follow import Follow
from periodic.decisions.responses.quantity import AbsentError
from periodic.orbit.scheme import Array
from periodic.results.branch import Branch
from periodic.system import System, check_system

GAIN = (0.01, 100.0)
"""Range of an unknown gain."""

OFFSET = 10.0
"""Range of an unknown offset, in largest measured numbers."""

MOST_ROUNDS = 8
"""How often branches are traced anew for the points to look for their sheets."""

AFAR = 3.0
"""Standard deviations from the data, on average, from which on a start is far from them."""

COARSE = (0.1, 0.03, 0.01, 0.003, 0.001)
"""Standard deviations that are added for such a start, one after the other, in parts of the data's spans."""

ROBUST = "cauchy"
"""The loss that makes least of outliers."""

IMPROBABLE = 1e-3
"""Probability of a misfit as large by chance below which another way to the data is tried."""

BETTER = 1e-6
"""Part of the misfit by which another sheet must be nearer for it to be taken."""

PRECISION = 1e-8
"""Relative change of parameters, and of the misfit, at which least squares ends."""


def fit(
    system: System,
    data: Sequence[Measured | MeasuredQuantity] | Measured | MeasuredQuantity,
    free: Mapping[str, tuple[float, float]],
    *,
    start: Mapping[str, float] | None = None,
    loss: str = "linear",
) -> Fitted:
    """Return the parameters for which a model's responses are nearest to what was measured.

    Parameters
    ----------
    system : System
        The equations.
    data : Measured, MeasuredQuantity or a sequence of them
        What was measured: points along responses, on unknown sheets, and single numbers.
    free : mapping of str to (float, float)
        Parameters that are sought, with their ranges (SI).
    start : mapping of str to float, optional
        Where the search begins (SI); by default the system's own values, moved into their ranges.
    loss : {"linear", "soft_l1", "huber", "cauchy"}
        How residuals count; all but the first make little of outliers.

    Returns
    -------
    Fitted
        Values with intervals and correlations, what the data cannot tell apart, and the residuals; or, with a
        reason, what is known so far.

    Raises
    ------
    ValueError
        In one sentence, for what is not allowed, for fewer data than parameters, and where no motion of the
        model is near the data at the start.
    """
    check_system(system)
    box = Box.of(system, free)
    given = [data] if isinstance(data, Measured | MeasuredQuantity) else list(_listed(data))
    one_of("loss", loss, LOSSES)
    search = _Search(system, given, box, tuple(box.names), loss)
    begin = {**box.start(start), **search.sensors}
    count = sum(len(d.places) * len(d.values) if isinstance(d, Measured) else 1 for d in given)
    if count < len(begin):
        raise ValueError(
            f"data are {count} numbers; {len(begin)} values are sought, and there must be no fewer numbers"
        )
    return search.found(begin)


def _listed(data: Any) -> Sequence[Measured | MeasuredQuantity]:
    if not isinstance(data, Sequence) or not data:
        raise ValueError(
            f"data is {shown(data)}; it must be a list of Measured(...) and MeasuredQuantity(...)"
        )
    for each in data:
        if not isinstance(each, Measured | MeasuredQuantity):
            raise ValueError(f"data has {shown(each)}; it must be Measured(...) or MeasuredQuantity(...)")
    return data


@dataclass
class _Search:
    """The search for the parameters of one set of data; `held` are values that stay as they are."""

    system: System
    data: Sequence[Measured | MeasuredQuantity]
    box: Box
    free: tuple[str, ...]
    loss: str
    count: Count = field(default_factory=Count)

    def __post_init__(self) -> None:
        for name, (low, high, value) in self._sensor_ranges.items():
            if name not in self.box.names:
                self.box = self.box.joined(name, low, high, value)

    @property
    def _sensor_ranges(self) -> dict[str, tuple[float, float, float]]:
        found: dict[str, tuple[float, float, float]] = {}
        for each, sensors in zip(self.data, sensors_of(self.data), strict=True):
            if isinstance(each, MeasuredQuantity):
                continue
            for (gain, offset), values in zip(sensors, each.values.values(), strict=True):
                size = OFFSET * (float(np.abs(values).max()) or 1.0)
                found |= {gain: (*GAIN, 1.0)} if gain else {}
                found |= {offset: (-size, size, 0.0)} if offset else {}
        return found

    @property
    def sensors(self) -> dict[str, float]:
        """Gains and offsets to begin with."""
        return {name: value for name, (_, _, value) in self._sensor_ranges.items()}

    def found(self, begin: Mapping[str, float]) -> Fitted:
        """Fit, let each point look for its sheet anew, and fit again until none changes.

        Where the start is far from the data these first get further standard deviations, in steps down to
        none: with distances as in a picture a point sees past the sheets that a start has at wrong places.
        Where what is found leaves more than chance would, a point may be on a wrong sheet: other ways are
        tried.
        """
        try:
            match, _ = self._matched(self.data, begin)
            far = match.misfit > AFAR**2 * match.count
            near = self._approached(begin, self._stage(match)) if far else begin
            found = self._settled(*self._matched(self.data, near))
        except AbsentError as error:
            raise ValueError(f"at the start {error}; start={{...}} nearer to the data may have it") from None
        for way in (self._without_outliers, self._from_afar):
            if found.chance < IMPROBABLE:
                with suppress(AbsentError):
                    again = self._settled(*self._matched(self.data, way(begin, found)))
                    found = min(found, again, key=lambda each: each.match.misfit)
        return replace(found, orbits=self.count.orbits)

    def _without_outliers(self, begin: Mapping[str, float], found: Fitted) -> Mapping[str, float]:
        """Values that make little of the points that what was found is far from. Raises AbsentError."""
        return replace(self, loss=ROBUST)._settled(found.match, found.branches).values

    def _from_afar(self, begin: Mapping[str, float], found: Fitted) -> Mapping[str, float]:
        """Values from the start with the largest further deviations."""
        return self._approached(begin, 0)

    def _settled(self, match: Match, branches: tuple[Branch, ...]) -> Fitted:
        """The fit from a match, on branches, each point on its nearest sheet."""
        why = f"points still changed their sheets after {MOST_ROUNDS} rounds"
        for _ in range(MOST_ROUNDS):
            match, status = self.fitted(match)
            try:
                fresh, branches = self._matched(self.data, match.values)
            except AbsentError as error:
                why = str(error)
                break
            if not fresh.misfit < match.misfit * (1 - BETTER):
                why = status
                break
            match = fresh
        return Fitted(
            reason=why,
            system=self.system,
            match=match,
            box=self.box,
            data=tuple(self.data),
            loss=self.loss,
            branches=branches,
            orbits=self.count.orbits,
            again=self.fitted,
        )

    def _stage(self, match: Match) -> int:
        """Index of the smallest of the further standard deviations with which a match is near the data."""
        near = [part for part in COARSE if match.loosened(part) <= AFAR**2 * match.count]
        return max(len(near) - 1, 0)

    def _approached(self, begin: Mapping[str, float], stage: int) -> Mapping[str, float]:
        """Return values nearer to the data, fitted with ever smaller further deviations, from one of them on.

        What such data do not tell stays where it was, as if its range were its distribution.
        """
        values = begin
        for part in COARSE[stage:]:
            coarse = [d.loosened(part) if isinstance(d, Measured) else d for d in self.data]
            with suppress(AbsentError):  # with smaller ones the branch may have motions near
                values = self.fitted(self._matched(coarse, values)[0], prior=1 / UNTOLD)[0].values
        return values

    def fitted(self, match: Match, held: Sequence[str] = (), prior: float = 0.0) -> tuple[Match, str]:
        """Return the best match with each motion followed on its sheet, and why it is not known to be best.

        Values named in `held` stay as they are; `prior` is the weight of changes, in parts of the ranges.
        """
        follow = Follow(self.box, match)
        moving = np.array([name not in held for name in self.box.names])
        begin = self.box.scaled(match.values)
        if not moving.any():
            return match, ""

        inside = np.clip(begin[moving], 1e-9, 1 - 1e-9)

        def full(x: Array) -> Array:
            found = begin.copy()
            found[moving] = x
            return found

        def residual(x: Array) -> Array:
            try:
                found = self._at(follow, full(x)).residual  # with its derivatives, or it is refused
            except (AbsentError, LostError):
                found = np.full(len(match.residual), np.nan)
            return np.append(found, prior * (x - inside))

        def slopes(x: Array) -> Array:
            found = (self._at(follow, full(x)).jacobian * self.box.widths)[:, moving]
            return np.concatenate([found, prior * np.eye(len(x))])

        if not np.isfinite(residual(inside)).all():
            return match, "the motions nearest to the data are lost beside where the fit begins"
        solved: OptimizeResult = least_squares(
            residual,
            inside,
            jac=slopes,
            bounds=(0.0, 1.0),
            x_scale="jac",
            loss=cast(Any, self.loss),
            xtol=PRECISION,
            ftol=PRECISION,
            gtol=PRECISION,
            max_nfev=50,
        )
        why = "" if solved.status > 0 else f"least squares ended early: {solved.message}"
        return self._at(follow, full(solved.x)), why

    def _at(self, follow: Follow[Match], scaled: Array) -> Match:
        """The match at values, in parts of the ranges: followed, else anew. Raises AbsentError."""
        try:
            return follow.at(scaled)
        except LostError:
            values = self.box.values(scaled)
            data = list(dict.fromkeys(part.data for part in follow.first.parts))
            return follow.keep(scaled, self._matched(data, values)[0])

    def _matched(
        self, data: Sequence[Measured | MeasuredQuantity], values: Mapping[str, float]
    ) -> tuple[Match, tuple[Branch, ...]]:
        return matched(self.system, data, values, self.free, self.count)
