"""Whole branches: what is traced, how, and the error of the folds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

import periodic as per
from reports.app.sweep import Settled, SweepSettings, sweep
from reports.studies.trade.methods.direct import tolerance as tolerance_of
from reports.studies.trade.methods.measure import Measured, timed
from reports.studies.trade.methods.names import BALANCE, DIAL, SHOOTING, SWEEP, power
from reports.studies.trade.methods.problems import Problem, settled

APART = 5e-4
"""How far before a fold, as a part of its parameter, another method sets out for it."""


@dataclass(frozen=True, kw_only=True)
class Traced:
    """A trace from one bound to the other with a method and settings."""

    family: str
    setting: str
    tol: float | per.Tolerance
    method: per.extend.Discretisation

    def branch(self, problem: Problem) -> per.Branch:
        """Return the branch."""
        return per.trace(
            problem.system,
            problem.parameter,
            problem.bounds,
            start=problem.start,
            guess=settled(problem, problem.start) if problem.begin is None else None,
            tol=self.tol,
            method=self.method,
            watch=per.Watch(stop={"LP": problem.folds} if problem.folds else {}),
        )

    def measured(self, problem: Problem, folds: Sequence[float]) -> Measured:
        """Trace, time and compare."""
        branch, seconds = timed(lambda: self.branch(problem))
        found = [p.parameter for p in branch.labelled(per.Label.FOLD)]
        if len(found) != len(folds):
            failure = f"{len(found)} folds of {len(folds)}; {branch.stop}"
            return Measured(family=self.family, setting=self.setting, failure=failure)
        return Measured(
            family=self.family,
            setting=self.setting,
            seconds=seconds,
            error=worst(found, folds),
            size=len(branch),
        )


@dataclass(frozen=True, kw_only=True)
class Swept:
    """Time integration to steady state at equally spaced values, up and down; the jumps tell the folds."""

    count: int

    def measured(self, problem: Problem, folds: Sequence[float]) -> Measured:
        """Sweep, time and compare: each jump lies in the middle of a step."""
        values = [float(v) for v in np.linspace(*problem.bounds, self.count)]
        settings = SweepSettings(tolerance=1e-6)
        ways, seconds = timed(
            lambda: [
                sweep(problem.system, problem.parameter, way, settings) for way in (values, values[::-1])
            ]
        )
        found = [jump(way) for way in ways]
        return Measured(
            family=SWEEP,
            setting=f"{self.count} values each way",
            seconds=seconds,
            error=worst(sorted(found), sorted(folds)),
            size=2 * self.count,
        )


def jump(way: Sequence[Settled]) -> float:
    """Return where the amplitude changes most from one value to the next."""
    swing = np.array([s.maximum - s.minimum for s in way])
    place = int(np.abs(np.diff(swing)).argmax())
    return (way[place].parameter + way[place + 1].parameter) / 2


def worst(found: Sequence[float], folds: Sequence[float]) -> float:
    """Return the largest relative difference."""
    return float(np.abs(np.array(found) / np.array(folds) - 1).max())


def dialled(tolerances: Sequence[float], ncol: int = 5) -> Iterator[Traced]:
    """Yield collocation at tolerances."""
    for tolerance in tolerances:
        yield Traced(
            family=f"Radau {ncol}, anchored",
            setting=f"tol {power(tolerance)}",
            tol=tolerance_of(tolerance),
            method=per.Collocation(scheme=per.Scheme(per.Family.RADAU, ncol)),
        )


def accuracies() -> Iterator[Traced]:
    """Yield draft, standard and fine."""
    for accuracy in per.Accuracy:
        yield Traced(
            family=DIAL,
            setting=accuracy.name.lower(),
            tol=accuracy,
            method=per.Collocation(),
        )


def balanced(tolerances: Sequence[float], most: int = 64) -> Iterator[Traced]:
    """Yield harmonic balance with as many harmonics as the tolerance asks for, up to `most`."""
    for tolerance in tolerances:
        yield Traced(
            family=BALANCE,
            setting=f"tol {power(tolerance)}",
            tol=tolerance_of(tolerance),
            method=per.HarmonicBalance(most=most),
        )


def swept(counts: Sequence[int]) -> Iterator[Swept]:
    """Yield sweeps in time."""
    for count in counts:
        yield Swept(count=count)


def shot(tolerances: Sequence[float]) -> Iterator[Traced]:
    """Yield single shooting."""
    for tolerance in tolerances:
        yield Traced(
            family=SHOOTING,
            setting=f"tol {power(tolerance)}",
            tol=tolerance_of(1e3 * tolerance),
            method=per.Shooting(tolerance=tolerance, scheme=per.Scheme(per.Family.RADAU, 6)),
        )


def folds_near(
    problem: Problem, branch: per.Branch, method: per.extend.Discretisation, tol: per.Tolerance
) -> list[float]:
    """Return the folds of a branch located anew by another method, from the last points before them.

    Raises ArithmeticError where the other method does not find one.
    """
    found = []
    for index, point in enumerate(branch):
        if point.label is per.Label.FOLD:
            away = [p for p in branch.points[:index] if abs(p.parameter / point.parameter - 1) > APART]
            near = away[-1]
            again = _about(problem, near, point.parameter, method, tol)
            found += [p.parameter for p in again.labelled(per.Label.FOLD)]
    return found


def _about(
    problem: Problem, near: per.Point, fold: float, method: per.extend.Discretisation, tol: per.Tolerance
) -> per.Branch:
    """Trace from a point over a fold and no further. Raises ArithmeticError where that does not succeed."""
    branch = per.trace(
        problem.system,
        problem.parameter,
        (near.parameter, 2 * fold - near.parameter),
        start=near.parameter,
        guess=near.orbit,
        tol=tol,
        method=method,
        watch=per.Watch(stop={"LP": 1}),
    )
    if not branch.labelled(per.Label.FOLD):
        raise ArithmeticError(f"the fold at {fold:.6g} was not found again: {branch.stop}")
    return branch
