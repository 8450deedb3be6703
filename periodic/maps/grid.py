"""Which cells a map has: all combinations of given values, walked so that neighbours follow each other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from periodic.checks import named, number
from periodic.maps.cell import Arrangement, Cell, Chunk, Outcome
from periodic.maps.task import Task
from periodic.system import check_value, index_of

MOST_CELLS = 1_000_000
"""Cells of a map: what is kept of each takes about a kilobyte of memory."""


class Plan(Protocol):
    """Which cells are computed, and how they are laid out in the result. `Grid` and `Adaptive` are plans."""

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters that are varied."""

    @property
    def total(self) -> int:
        """How many cells there are."""

    def check(self, task: Task) -> None:
        """Check that a task can be mapped so.

        Parameters
        ----------
        task : Task
            The task.

        Raises
        ------
        ValueError
            In one sentence, where it cannot.
        """

    def rounds(self, found: Mapping[Cell, Outcome], size: int) -> Iterator[list[Chunk]]:
        """Yield chunks that can be computed at the same time.

        Parameters
        ----------
        found : mapping of Cell to Outcome
            What is known; it has all cells of a round when the next one is asked for.
        size : int
            Cells in a chunk.

        Yields
        ------
        list of Chunk
            The chunks of a round.
        """

    def arranged(self, found: Mapping[Cell, Outcome]) -> Arrangement:
        """Return how the result is laid out.

        Parameters
        ----------
        found : mapping of Cell to Outcome
            What is known.

        Returns
        -------
        Arrangement
            Dimensions, coordinates and cells.
        """

    def described(self) -> Any:
        """Return plain data that are equal for equal plans."""


@dataclass(frozen=True)
class Grid:
    """All combinations of values of some parameters.

    Parameters
    ----------
    values : mapping of str to sequence of float
        Values (SI) of each parameter, all different.

    Raises
    ------
    ValueError
        For what is no such mapping, for no values, one that is not finite or is there twice.
    """

    values: Mapping[str, Sequence[float]]

    def __post_init__(self) -> None:
        named("grid", self.values, "sequences of values")
        if not self.values:
            raise ValueError("grid is empty; it must give the values of at least one parameter")
        object.__setattr__(self, "values", {name: _values(name, v) for name, v in self.values.items()})
        check_total("grid", self.total)

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters that are varied."""
        return tuple(self.values)

    @property
    def total(self) -> int:
        """How many cells there are."""
        return math.prod(map(len, self.values.values()))

    @cached_property
    def _cells(self) -> list[Cell]:
        return list(itertools.product(*self.values.values()))

    def check(self, task: Task) -> None:
        """Check that the task has the parameters and may have each of their values."""
        check_names("grid", self.names, task)
        check_values(task, self.values)

    def rounds(self, found: Mapping[Cell, Outcome], size: int) -> Iterator[list[Chunk]]:
        """Yield all chunks at once."""
        path = [
            tuple(axis[k] for axis, k in zip(self.values.values(), at, strict=True)) for at in self._path()
        ]
        yield [tuple(path[k : k + size]) for k in range(0, len(path), size)]

    def _path(self) -> list[tuple[int, ...]]:
        """Indices of all cells, each next to the one before: rows are walked there and back."""
        path: list[tuple[int, ...]] = [()]
        for axis in self.values.values():
            ways = (range(len(axis)), range(len(axis) - 1, -1, -1))
            path = [(*at, k) for row, at in enumerate(path) for k in ways[row % 2]]
        return path

    def arranged(self, found: Mapping[Cell, Outcome]) -> Arrangement:
        """Return one dimension for each parameter."""
        sizes = {name: len(values) for name, values in self.values.items()}
        return Arrangement(sizes, {name: (name, v) for name, v in self.values.items()}, self._cells)

    def described(self) -> Any:
        """Return the values by name."""
        return {name: list(values) for name, values in self.values.items()}


def check_total(what: str, total: int) -> None:
    """Refuse more cells than a map can have. Raises ValueError."""
    if total > MOST_CELLS:
        raise ValueError(f"{what} has {total} cells; it must have at most {MOST_CELLS}")


def check_values(task: Task, values: Mapping[str, Sequence[float]]) -> None:
    """Refuse values of parameters that these may not have. Raises ValueError."""
    for name, given in values.items():
        for value in given:
            check_value(task.system.parameters[index_of(task.system, name)], value)


def check_names(what: str, names: Sequence[str], task: Task) -> None:
    """Raise ValueError for parameters that a task cannot be varied in."""
    known = [p.name for p in task.system.parameters]
    for name in names:
        if name not in known:
            raise ValueError(f"{what} has {name!r}; it must be one of the system's {', '.join(known)}")
        for where, taken in (
            ("is continued in", (task.parameter,)),
            ("is determined", task.problem.determined),
            ("is in the task's values", task.values or {}),
        ):
            if name in taken:
                raise ValueError(f"{what} has {name!r}, which {where}; it must be one or the other")


def _values(name: str, given: Any) -> tuple[float, ...]:
    if hasattr(given, "__array__"):
        given = np.asarray(given).tolist()
    if isinstance(given, str | bytes | Mapping) or not np.iterable(given):
        raise ValueError(f"grid has {given!r} for {name}; it must be a sequence of numbers")
    values = tuple(number(f"value of {name}", value) for value in given)
    if not values:
        raise ValueError(f"grid has no values for {name}; it must have at least one")
    for value in values:
        if not np.isfinite(value):
            raise ValueError(f"grid has {value} for {name}; its values must be finite")
    if len(set(values)) < len(values):
        twice = max(values, key=values.count)
        raise ValueError(f"grid has {twice:g} for {name} twice; its values must be different")
    return values
