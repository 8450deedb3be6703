"""The design whose worst peak is least, or what else a response shall be, by exact gradients of features.

A quantity such as the highest peak is the largest of several features, one for each peak, sheet and end:

    minimise t   subject to   f_i(p) <= t,   c_j(p) <= bound,   low <= p <= high.

SciPy's SLSQP solves it while every feature is followed by Newton's method from the design before: an orbit
for each, instead of branches. Then all branches are traced anew at the optimum; a peak that was not there
before joins the problem, until nothing is found that the optimum did not know of.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from scipy.optimize import minimize

from periodic.checks import shown
from periodic.decisions.optimising.optimum import Optimum, Share, optimum
from periodic.decisions.responses.box import Box
from periodic.decisions.responses.feature import Count, Feature, LostError
from periodic.decisions.responses.follow import Follow
from periodic.decisions.responses.quantity import AbsentError, Constraint, Quantity
from periodic.decisions.responses.readquantities import Reading, traced
from periodic.orbit.scheme import Array
from periodic.system import System, check_system

SETTLED = 1e-6
"""Part of the objective by which branches traced anew may differ from it."""

MOST_ROUNDS = 40
"""How often branches are traced anew before the search is given up."""

SHRINK = 0.25
"""By how much the region of the search shrinks where a feature is lost in it."""

LEAST_REGION = 1e-6
"""Smallest region of the search, in parts of the ranges."""

AT_EDGE = 0.999
"""Part of the region within which its edge does not decide where the search ended."""

FTOL = 1e-15
"""SLSQP's own tolerance, of the scaled objective: it goes on until rounding stops it."""


def optimise(
    system: System,
    free: Mapping[str, tuple[float, float]],
    *,
    minimise: Quantity | None = None,
    maximise: Quantity | None = None,
    subject_to: Sequence[Constraint] = (),
    start: Mapping[str, float] | None = None,
) -> Optimum:
    """Return the values of parameters for which a quantity of a response is least, or greatest.

    Parameters
    ----------
    system : System
        The equations.
    free : mapping of str to (float, float)
        Parameters that may change, with their ranges (SI).
    minimise, maximise : Quantity
        One of the two, as Response("Omega", (0.5, 2)).highest(PeakToPeak("x")).
    subject_to : sequence of Constraint
        As response.place("LP") >= 1.2.
    start : mapping of str to float, optional
        Where the search begins (SI); by default the system's own values, moved into their ranges.

    Returns
    -------
    Optimum
        The design, what decides it, and its derivatives in all other parameters; or the reason why none was
        found, with the best design so far.

    Raises
    ------
    ValueError
        In one sentence, for what is not allowed, and where the response has nothing of what is asked at the
        start.
    """
    check_system(system)
    box = Box.of(system, free)
    asked = [(q, sense) for q, sense in ((minimise, 1.0), (maximise, -1.0)) if q is not None]
    if len(asked) != 1:
        raise ValueError("minimise and maximise are both given, or neither; it must be one of the two")
    ((objective, sense),) = asked
    for constraint in _checked(objective, subject_to):
        if not isinstance(constraint, Constraint):
            raise ValueError(f"subject_to has {shown(constraint)}; it must be a quantity <= or >= a number")
    return _Search(system, box, objective, sense, list(subject_to)).found(box.start(start))


def _checked(objective: object, subject_to: object) -> Sequence[Constraint]:
    if not isinstance(objective, Quantity):
        raise ValueError(
            f"objective is {shown(objective)}; it must be a quantity, as response.highest(...) is"
        )
    if not isinstance(subject_to, Sequence):
        raise ValueError(f"subject_to is {shown(subject_to)}; it must be a list of constraints")
    return subject_to


@dataclass
class _Search:
    """The search for one optimum."""

    system: System
    box: Box
    objective: Quantity
    sense: float
    constraints: list[Constraint]
    count: Count = field(default_factory=Count)
    traces: int = 0

    @property
    def quantities(self) -> list[Quantity]:
        return [self.objective, *(constraint.quantity for constraint in self.constraints)]

    def found(self, start: Mapping[str, float]) -> Optimum:
        """Search, trace anew, and search again until both agree."""
        try:
            reading = self._traced(start)
        except AbsentError as error:
            raise ValueError(f"at the start {error}") from None
        region, why = 1.0, ""
        for _ in range(MOST_ROUNDS):
            reached, why = self._descended(reading, region)
            better = self._merit(reached) < self._merit(reading)
            way = float(np.abs(self.box.scaled(reached.values) - self.box.scaled(reading.values)).max())
            try:
                fresh = self._traced(reached.values)
            except AbsentError as error:
                why = str(error)
            else:
                reading = fresh
                inside = region == 1 or way < AT_EDGE * region
                if not why and inside and self._is_known(reached, fresh):
                    break
            region = min(1.0, region / SHRINK) if better or not why else region * SHRINK
            if region < LEAST_REGION:
                break
        else:
            why = why or f"{MOST_ROUNDS} rounds did not settle it"
        return optimum(self, reading, why)

    def _traced(self, values: Mapping[str, float]) -> Reading:
        self.traces += 1
        return traced(self.system, self.quantities, values, self.count)

    def _is_known(self, reached: Reading, fresh: Reading) -> bool:
        """Whether a fresh trace has no decisive feature of another value than the followed ones."""
        pairs = zip(reached.numbers, fresh.numbers, strict=True)
        return all(abs(a - b) <= SETTLED * max(abs(a), abs(b)) for a, b in pairs)

    def shares(self, reading: Reading) -> list[Share]:
        """Return the features that make up the problem: those of the objective, then those of constraints."""
        found = [Share(f, self.sense, 0.0, True) for f in self._own(reading, 0, self.sense)]
        for k, constraint in enumerate(self.constraints, start=1):
            own = self._own(reading, k, constraint.side)
            found += [Share(f, constraint.side, constraint.side * constraint.bound, False) for f in own]
        return found

    def _own(self, reading: Reading, k: int, side: float) -> Sequence[Feature]:
        """Features of a quantity that must all lie on one side; the decisive one where one of them may."""
        each = reading.features[k]
        return each if reading.quantities[k].sign * side > 0 else [reading.decisive[k]]

    def _descended(self, reading: Reading, region: float) -> tuple[Reading, str]:
        """The best design near a reading while its features are followed, and what was lost on the way."""
        follow = Follow(self.box, reading)
        begin = self.box.scaled(reading.values)
        low, high = np.maximum(begin - region, 0.0), np.minimum(begin + region, 1.0)
        size = max(abs(reading.numbers[0]), np.finfo(float).tiny)
        number_of = len(begin)

        def rows(x: Array) -> list[Share]:
            asked.append(x[:number_of])
            return self.shares(follow.at(x[:number_of]))

        def slack(x: Array) -> Array:
            return np.array([s.slack(x[-1] * size) / (size if s.aim else s.size) for s in rows(x)])

        def slopes(x: Array) -> Array:
            return np.array([self._slope(s, size) for s in rows(x)])

        top = max(share.signed for share in self.shares(reading) if share.aim) / size
        last = np.append(np.zeros(number_of), 1.0)
        asked: list[Array] = []
        said = ""
        try:
            cast(Any, minimize)(
                lambda x: x[-1],
                np.append(begin, top),
                jac=lambda x: last,
                method="SLSQP",
                bounds=[*zip(low, high, strict=True), (None, None)],
                constraints=[{"type": "ineq", "fun": slack, "jac": slopes}],
                options={"ftol": FTOL, "maxiter": 200},
            )
        except LostError as error:  # which may have ceased to be there, or to matter
            said = str(error)
            with suppress(AbsentError):
                follow.keep(asked[-1], self._traced(self.box.values(asked[-1])))
        return follow.best(self._merit), said

    def _slope(self, share: Share, size: float) -> Array:
        gradient = -share.side * np.array([share.feature.gradient[name] for name in self.box.names])
        scaled = gradient * self.box.widths / (size if share.aim else share.size)
        return np.append(scaled, 1.0 if share.aim else 0.0)

    def _merit(self, reading: Reading) -> tuple[float, float]:
        """How much constraints are missed by, then the objective: less is better."""
        shares = self.shares(reading)
        missed = max((-s.slack(0.0) / s.size for s in shares if not s.aim), default=0.0)
        return (max(missed - SETTLED, 0.0), max(s.signed for s in shares if s.aim))
