"""Error against the reference beside processor time, one measurement for each method and setting."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from typing import Any, TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

import periodic as per
from periodic.correction.newton import Correction
from periodic.orbit.scheme import Array
from reports.studies.trade.methods.direct import FailedError
from reports.studies.trade.methods.marching import Integrated, RungeKutta
from reports.studies.trade.methods.problems import Problem

REPEATS = 5
"""How many times a solution is timed; the median counts."""

TIMING_SECONDS = 2.0
"""s after which it is not timed again."""

PHASES = np.linspace(0, 2 * np.pi, 1024, endpoint=False)
"""Where orbits are compared."""

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class Measured:
    """family and setting of a method, processor time in s (median), error, and why there is none.

    error: of one orbit the largest error of the scaled states over their largest peak to peak; of a branch
    the largest relative error of its folds' parameter. size: mesh intervals, harmonics, steps or periods.
    """

    family: str
    setting: str
    seconds: float | None = None
    error: float | None = None
    multiplier_error: float | None = None
    size: int | None = None
    failure: str = ""

    def kept(self) -> dict[str, Any]:
        """Return what is kept of it."""
        return asdict(self)


@dataclass(frozen=True, kw_only=True)
class Reference:
    """The orbit that errors are measured from, and how far a second method is from it, over its span."""

    orbit: per.Orbit
    multiplier: float
    agreement: float
    multiplier_agreement: float

    @property
    def span(self) -> float:
        """Largest peak to peak of the scaled states."""
        return self.orbit.span()

    def error(self, phase: Array, state: Array) -> float:
        """Return the error of states (K, n) at phases (K,)."""
        return float(np.abs(state - self.orbit.state(phase)).max()) / self.span


def reference(first: Correction, second: Correction) -> Reference:
    """Return the first of two solutions as the reference; they are compared at the second's mesh points."""
    orbit, phase = first.orbit, second.orbit.mesh.nodes(second.orbit.phases)
    gap = float(np.abs(orbit.state(phase) - second.orbit.nodes).max()) / orbit.span()
    mu, other = largest(first), largest(second)
    return Reference(orbit=orbit, multiplier=mu, agreement=gap, multiplier_agreement=abs(other / mu - 1))


def largest(found: Correction) -> float:
    """Return the largest modulus of the multipliers."""
    return float(np.abs(np.linalg.eigvals(found.monodromy)).max())


def timed(work: Callable[[], T]) -> tuple[T, float]:
    """Return what some work gives and the median of its processor times in s; one BLAS thread."""
    spent: list[float] = []
    with threadpool_limits(limits=1, user_api="blas"):
        while True:
            clock = time.process_time()
            result = work()
            spent.append(time.process_time() - clock)
            if len(spent) == REPEATS or sum(spent) > TIMING_SECONDS:
                return result, statistics.median(spent)


@dataclass(frozen=True)
class Case:
    """A direct method with a setting, of a family that is drawn as one curve."""

    family: str
    setting: str
    solve: Callable[[Problem], Correction]

    def measured(self, problem: Problem, known: Reference) -> Measured:
        """Solve and compare."""
        try:
            self.solve(problem)  # the neighbouring orbit and what is made once
            found, seconds = timed(lambda: self.solve(problem))
        except (FailedError, ValueError) as error:
            return Measured(family=self.family, setting=self.setting, failure=str(error))
        return Measured(
            family=self.family,
            setting=self.setting,
            seconds=seconds,
            error=known.error(PHASES, found.orbit.collocated().state(PHASES)),
            multiplier_error=abs(largest(found) / known.multiplier - 1),
            size=found.orbit.mesh.ntst,
        )


@dataclass(frozen=True)
class March:
    """A time integration with a setting, run for so many blocks of periods."""

    family: str
    setting: str
    way: RungeKutta | Integrated
    blocks: int

    def measured(self, problem: Problem, known: Reference) -> Measured:
        """Run until settled and compare."""
        try:
            with threadpool_limits(limits=1, user_api="blas"):
                run = self.way.settle(problem, self.blocks)
        except ArithmeticError as error:
            return Measured(family=self.family, setting=self.setting, failure=str(error))
        n = min(run.state.shape[1], known.orbit.nodes.shape[1])
        found = known.error(run.phase, run.state[:, :n])
        away = found * known.span
        return Measured(
            family=self.family,
            setting=self.setting,
            seconds=run.cost(away),
            error=found,
            size=run.periods(away),
        )


def digits(value: float) -> int:
    """Return to how many digits two methods agree."""
    return int(np.floor(-np.log10(max(value, 1e-16))))


def measured_all(
    cases: Iterable[Case | March], problem: Problem, known: Reference, tell: Callable[[str], None]
) -> list[Measured]:
    """Measure every case."""
    found = []
    for case in cases:
        tell(f"{case.family}, {case.setting}")
        found.append(case.measured(problem, known))
    return found
