"""Where a branch has special points, and where it is stable."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.bifurcations.label import Label
from periodic.checks import one_of
from periodic.conditions.functionals import Functional
from periodic.maps.numbers.reading import check_functional, parameter_unit, read, settled, unit_of
from periodic.maps.task import Task
from periodic.results.branch import Branch


@dataclass(frozen=True)
class Places:
    """The parameter, or a functional, at the special points of a kind, in order along the branch.

    Parameters
    ----------
    label : str
        "LP" for folds, "PD", "NS", or the name of an event that the task watches.
    functional : Functional, optional
        What to read there, the parameter by default.

    Raises
    ------
    ValueError
        For a label that is no text, and what is no functional.
    """

    label: str
    functional: Functional | None = None

    def __post_init__(self) -> None:
        if not (isinstance(self.label, str) and self.label):
            raise ValueError(
                f"label is {self.label!r}; it must be one of {', '.join(Label.known())} or an event"
            )
        if self.functional is not None:
            check_functional(self.functional)

    def __call__(self, task: Task, branch: Branch) -> list[float]:
        """Return the values (SI), as many as there are points."""
        points = branch.labelled(self.label)
        if self.functional is None:
            return [point.parameter for point in points]
        return [read(task.system, point, self.functional) for point in points]

    def units(self, task: Task) -> dict[str, str]:
        """Return the unit of the values. Raises ValueError for a label that branches do not have."""
        own = () if task.watch is None else (*task.watch.events, *task.watch.asked)
        one_of("label", self.label, [*map(str, Label.known()), *own])
        given = self.functional
        return {"": parameter_unit(task) if given is None else unit_of(task.system, given)}


@dataclass(frozen=True)
class StableRanges:
    """The stable parts of the branch: the parameter at both ends of each, in order along it."""

    def __call__(self, task: Task, branch: Branch) -> dict[str, list[float]]:
        """Return where they begin ("from") and end ("to"), SI."""
        stable = settled(branch) & ~_alone(branch)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], stable, [False]]).astype(int)))
        values, pairs = branch.values, edges.reshape(-1, 2)
        return {"from": [float(values[a]) for a, _ in pairs], "to": [float(values[b - 1]) for _, b in pairs]}

    def units(self, task: Task) -> dict[str, str]:
        """Return the unit of both ends."""
        return dict.fromkeys(("from", "to"), parameter_unit(task))


def _alone(branch: Branch) -> NDArray[np.bool_]:
    """Special points between two stable parts of the branch, at which the orbit itself is not stable."""
    stable = branch.stable
    both = np.zeros_like(stable)
    both[1:-1] = stable[:-2] & stable[2:] & ~stable[1:-1]
    return both
