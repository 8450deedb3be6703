"""A functional on every sheet of a branch at one value of its parameter."""

from __future__ import annotations

from dataclasses import dataclass

from periodic.checks import number
from periodic.conditions.functionals import Functional
from periodic.maps.numbers.reading import check_functional, read, unit_of
from periodic.maps.task import Task
from periodic.results.branch import Branch


@dataclass(frozen=True)
class Sheets:
    """A functional at a value of the parameter, once for each orbit that the branch has there.

    Parameters
    ----------
    functional : Functional
        As PeakToPeak("x").
    at : float
        Value of the parameter (SI), within the task's bounds.

    Raises
    ------
    ValueError
        For what is no functional or no number.
    """

    functional: Functional
    at: float

    def __post_init__(self) -> None:
        check_functional(self.functional)
        number("at", self.at)

    @property
    def places(self) -> tuple[float, ...]:
        """Where it needs a point of the branch on every sheet."""
        return (float(self.at),)

    def __call__(self, task: Task, branch: Branch) -> dict[str, list[float]]:
        """Return the values (SI) in order along the branch and, as "stable", 1 for stable ones, else 0."""
        there = [point for point in branch if point.parameter == self.at]
        distinct = [p for k, p in enumerate(there) if k == 0 or p.orbit is not there[k - 1].orbit]
        return {
            "": [read(task.system, point, self.functional) for point in distinct],
            "stable": [float(point.stable) for point in distinct],
        }

    def units(self, task: Task) -> dict[str, str]:
        """Return the unit of the values."""
        return {"": unit_of(task.system, self.functional), "stable": ""}
