"""Highest and lowest value of a functional along a branch, at its stationary point and not at a sample."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from periodic.conditions.functionals import Functional
from periodic.maps.numbers.reading import check_functional, parameter_unit, read, settled, unit_of
from periodic.maps.numbers.stationary import stationary
from periodic.maps.task import Task
from periodic.orbit.scheme import Array
from periodic.results.branch import Branch


@dataclass(frozen=True)
class Extreme:
    """The highest or the lowest value of a functional along a branch, and where it is.

    Between points that is where the functional is stationary along the branch, located to its tolerance; else
    it is an end of the branch, or of a range of stable orbits.

    Parameters
    ----------
    functional : Functional
        As PeakToPeak("x").
    stable : bool
        Whether only stable orbits count.

    Raises
    ------
    ValueError
        For what is no functional.
    """

    sign: ClassVar[float]
    functional: Functional
    stable: bool = False

    def __post_init__(self) -> None:
        check_functional(self.functional)

    def __call__(self, task: Task, branch: Branch) -> dict[str, float]:
        """Return the value (SI) and, as "at", the parameter; NaN where no orbit counts."""
        return _extreme(task, branch, self.functional, self.sign, self.stable)

    def units(self, task: Task) -> dict[str, str]:
        """Return the units of value and place."""
        return {"": unit_of(task.system, self.functional), "at": parameter_unit(task)}


class Highest(Extreme):
    """The highest value of a functional along the branch, and where it is: a resonance peak, say.

    Parameters
    ----------
    functional : Functional
        As PeakToPeak("x").
    stable : bool
        Whether only stable orbits count.
    """

    sign = 1.0


class Lowest(Extreme):
    """The lowest value of a functional along the branch, and where it is: the least load of a contact, say.

    Parameters
    ----------
    functional : Functional
        As Minimum("load").
    stable : bool
        Whether only stable orbits count.
    """

    sign = -1.0


def _extreme(
    task: Task, branch: Branch, functional: Functional, sign: float, stable: bool
) -> dict[str, float]:
    """The largest of sign * functional, at points and where it is stationary between them."""
    counts = settled(branch) if stable else np.ones(len(branch), dtype=bool)
    values = np.where(counts, [sign * read(task.system, point, functional) for point in branch], -np.inf)
    if not counts.any():
        return {"": float("nan"), "at": float("nan")}
    best = int(values.argmax())
    value, place = float(values[best]), float(branch[best].parameter)
    if _inside(values, best):
        found = stationary(task, branch, best, functional)
        if found is not None and sign * found[0] >= value:
            value, place = sign * found[0], found[1]
    return {"": sign * value, "at": place}


def _inside(values: Array, best: int) -> bool:
    """Whether points that count lie on both sides of the best one."""
    return bool(0 < best < len(values) - 1 and np.isfinite(values[best - 1 : best + 2]).all())
