"""A point of a branch: an orbit with everything that is said of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from periodic import codimension, measure
from periodic.accuracy import ErrorEstimate
from periodic.label import Label
from periodic.orbit import Orbit
from periodic.solve import Solved, Task
from periodic.spectrum import CONSERVED, ROUNDING, without_unit

NOISE = 30.0
"""How much larger than its estimate the error of a small multiplier may be."""


@dataclass(frozen=True, eq=False, repr=False)
class Point:
    """parameter: the continuation parameter (SI); multipliers (n,) complex, largest first.

    minimum, maximum: extremes of each output over the period (SI), by name. slope: d parameter / d
    arclength. trivial: distance from 1 of the multiplier that an autonomous orbit has there (two of a
    conservative one), which tells how accurate the multipliers are; None for a forced orbit. A point is
    stable when all other multipliers lie inside the unit circle (of a conservative orbit: on it, within their
    error); a special point where one is on it is not, nor a `marginal` one of a curve of such points. Of an
    equilibrium the multipliers are the eigenvalues of its Jacobian (1/s), largest real part first, and it is
    stable when all real parts are negative. event: the user's name of the event met there. columns:
    functionals asked for, by name.
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

    def __repr__(self) -> str:
        kind = " ".join(filter(None, [self.label.value, self.event, "stable" if self.stable else "unstable"]))
        return f"Point({self.parameter:.12g}, {kind})"

    @property
    def stable(self) -> bool:
        """Whether small disturbances die away, or of a conservative orbit stay small."""
        if self.marginal or self.label.critical:
            return False
        if self.equilibrium:
            return bool((self.multipliers.real < 0).all())
        slack = CONSERVED * self.error.multiplier + ROUNDING if self.conservative else 0.0
        return bool((np.abs(self.nontrivial) < 1 + slack).all())

    @property
    def equilibrium(self) -> bool:
        """Whether the orbit is constant."""
        return self.orbit.equilibrium

    @property
    def nontrivial(self) -> NDArray[np.complex128]:
        """The multipliers without those that are 1 whatever the parameters, largest first."""
        return without_unit(self.multipliers, 0 if self.trivial is None else 1 + self.conservative)

    @property
    def floor(self) -> float:
        """The noise floor: multipliers of this size or less are only known to be so small.

        NOISE times their error, rounding included, relative to the largest where that exceeds 1.
        """
        largest = float(np.abs(self.multipliers).max(initial=1.0))
        return NOISE * (self.error.multiplier + float(np.finfo(float).eps)) * largest

    def peak_to_peak(self, output: str) -> float:
        """Return maximum minus minimum of an output."""
        return self.maximum[output] - self.minimum[output]


def _distance(multipliers: NDArray[np.complex128], count: int) -> float | None:
    """Distance from 1 of the mean and of the product of the `count` multipliers nearest 1; None of none.

    Unlike those themselves, which all but coincide, they are as accurate as the other multipliers.
    """
    nearest = multipliers[np.abs(multipliers - 1).argsort()[:count]]
    return float(max(abs(nearest.mean() - 1), abs(nearest.prod() - 1))) if count else None


def describe(task: Task, solved: Solved, label: Label, event: str = "") -> Point:
    """Measure a solved orbit."""
    found = measure.extrema(task.system, solved.orbit)
    names = [output.name for output in task.system.outputs]
    multipliers = np.linalg.eigvals(solved.correction.monodromy).astype(np.complex128)
    order = -multipliers.real if solved.orbit.equilibrium else -np.abs(multipliers)
    return Point(
        orbit=solved.orbit,
        parameter=float(solved.orbit.parameter[task.index]),
        label=label,
        multipliers=multipliers[np.argsort(order, kind="stable")],
        minimum=dict(zip(names, map(float, found.minimum), strict=True)),
        maximum=dict(zip(names, map(float, found.maximum), strict=True)),
        error=solved.error,
        residual=solved.correction.residual,
        iterations=solved.correction.iterations,
        slope=solved.tangent.parameter,
        trivial=_distance(multipliers, task.unit),
        conservative=task.unit > 1,
        marginal=codimension.marginal(task),
        event=event,
        columns=task.watch.measured(task.system, solved.orbit),
    )
