"""How numbers read the points of a branch."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from periodic.conditions.extremes import Maximum, Minimum, PeakToPeak
from periodic.conditions.functionals import Functional, Value, output_index
from periodic.maps.task import Task
from periodic.results.branch import Branch
from periodic.results.point import Point
from periodic.system import System, index_of


def check_functional(functional: Any) -> None:
    """Raise ValueError for what is no functional of an orbit."""
    if isinstance(functional, type) or not callable(functional):
        raise ValueError(f'functional is {functional!r}; it must be one of an orbit, as PeakToPeak("x") is')


def read(system: System, point: Point, functional: Functional) -> float:
    """Return a functional of a point's orbit, without work where the point knows it."""
    if isinstance(functional, Maximum | Minimum | PeakToPeak) and functional.output in point.maximum:
        low, high = point.minimum[functional.output], point.maximum[functional.output]
        return {Maximum: high, Minimum: low, PeakToPeak: high - low}[type(functional)]
    return float(functional(system, point.orbit))


def unit_of(system: System, functional: Functional) -> str:
    """Return the SI unit of a functional, else an empty text. Raises ValueError for no output."""
    if isinstance(functional, Maximum | Minimum | PeakToPeak):
        return system.outputs[output_index(system, functional.output)].unit
    if isinstance(functional, Value):
        return system.parameters[index_of(system, functional.parameter)].unit
    return ""


def parameter_unit(task: Task) -> str:
    """Return the unit of the parameter that is continued in."""
    return unit_of(task.system, Value(task.parameter))


def settled(branch: Branch) -> NDArray[np.bool_]:
    """Whether each point is stable or ends a stable part, as folds do; shape (points,)."""
    stable = branch.stable
    critical = np.array([point.label.critical for point in branch], dtype=bool)
    beside = np.zeros_like(stable)
    beside[1:] |= stable[:-1]
    beside[:-1] |= stable[1:]
    return stable | (critical & beside)
