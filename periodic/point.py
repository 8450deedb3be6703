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


@dataclass(frozen=True, eq=False, repr=False)
class Point:
    """parameter: the continuation parameter (SI); multipliers (n,) complex, largest first.

    minimum, maximum: extremes of each output over the period (SI), by name. slope: d parameter / d
    arclength. trivial: distance from 1 of the multiplier that an autonomous orbit has there, which tells how
    accurate the multipliers are; None for a forced orbit. A point is stable when all other multipliers lie
    inside the unit circle; a special point where one is on it is not, nor a `marginal` one of a curve of such
    points. event: the user's name of the event met there. columns: functionals asked for, by name.
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
    marginal: bool = False
    event: str = ""
    columns: dict[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        kind = " ".join(filter(None, [self.label.value, self.event, "stable" if self.stable else "unstable"]))
        return f"Point({self.parameter:.12g}, {kind})"

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle, the trivial one apart."""
        if self.marginal or self.label.critical:
            return False
        return bool((np.abs(self.nontrivial) < 1).all())

    @property
    def nontrivial(self) -> NDArray[np.complex128]:
        """The multipliers without the trivial one of an autonomous orbit, largest first."""
        if self.trivial is None:
            return self.multipliers
        return np.delete(self.multipliers, np.abs(self.multipliers - 1).argmin())

    def peak_to_peak(self, output: str) -> float:
        """Return maximum minus minimum of an output."""
        return self.maximum[output] - self.minimum[output]


def describe(task: Task, solved: Solved, label: Label, event: str = "") -> Point:
    """Measure a solved orbit."""
    found = measure.extrema(task.system, solved.orbit)
    names = [output.name for output in task.system.outputs]
    multipliers = np.linalg.eigvals(solved.correction.monodromy).astype(np.complex128)
    return Point(
        orbit=solved.orbit,
        parameter=float(solved.orbit.parameter[task.index]),
        label=label,
        multipliers=multipliers[np.argsort(-np.abs(multipliers))],
        minimum=dict(zip(names, map(float, found.minimum), strict=True)),
        maximum=dict(zip(names, map(float, found.maximum), strict=True)),
        error=solved.error,
        residual=solved.correction.residual,
        iterations=solved.correction.iterations,
        slope=solved.tangent.parameter,
        trivial=float(np.abs(multipliers - 1).min()) if task.autonomous else None,
        marginal=codimension.marginal(task),
        event=event,
        columns=task.watch.measured(task.system, solved.orbit),
    )
