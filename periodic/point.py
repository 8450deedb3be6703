"""A point of a branch: an orbit with everything that is said of it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from periodic import measure
from periodic.accuracy import ErrorEstimate
from periodic.orbit import Orbit
from periodic.solve import Solved, Task


class Label(Enum):
    """Special points, as the field names them."""

    NONE = ""
    END = "EP"
    FOLD = "LP"
    DOUBLING = "PD"
    TORUS = "NS"
    BRANCH = "BP"
    USER = "UZ"
    FAILED = "MX"

    @property
    def critical(self) -> bool:
        """Whether a multiplier is on the unit circle there."""
        return self in (Label.FOLD, Label.DOUBLING, Label.TORUS, Label.BRANCH)


@dataclass(frozen=True, eq=False, repr=False)
class Point:
    """parameter: the continuation parameter (SI); multipliers (n,) complex, largest first.

    minimum, maximum: extremes of each output over the period (SI), by name. slope: d parameter / d
    arclength. trivial: distance from 1 of the multiplier that an autonomous orbit has there, which tells how
    accurate the multipliers are; None for a forced orbit. A point is stable when all other multipliers lie
    inside the unit circle; a special point where one is on it is not.
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

    def __repr__(self) -> str:
        kind = " ".join(filter(None, [self.label.value, "stable" if self.stable else "unstable"]))
        return f"Point({self.parameter:.12g}, {kind})"

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle, the trivial one apart."""
        return not self.label.critical and bool((np.abs(self.nontrivial) < 1).all())

    @property
    def nontrivial(self) -> NDArray[np.complex128]:
        """The multipliers without the trivial one of an autonomous orbit, largest first."""
        if self.trivial is None:
            return self.multipliers
        return np.delete(self.multipliers, np.abs(self.multipliers - 1).argmin())

    def peak_to_peak(self, output: str) -> float:
        """Return maximum minus minimum of an output."""
        return self.maximum[output] - self.minimum[output]


def describe(task: Task, solved: Solved, label: Label) -> Point:
    """Measure a solved orbit."""
    low, high = measure.extrema(task.system, solved.orbit)
    names = [output.name for output in task.system.outputs]
    multipliers = np.linalg.eigvals(solved.correction.monodromy).astype(np.complex128)
    return Point(
        orbit=solved.orbit,
        parameter=float(solved.orbit.parameter[task.index]),
        label=label,
        multipliers=multipliers[np.argsort(-np.abs(multipliers))],
        minimum=dict(zip(names, map(float, low), strict=True)),
        maximum=dict(zip(names, map(float, high), strict=True)),
        error=solved.error,
        residual=solved.correction.residual,
        iterations=solved.correction.iterations,
        slope=solved.tangent.parameter,
        trivial=float(np.abs(multipliers - 1).min()) if task.autonomous else None,
    )
