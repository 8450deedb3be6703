"""Cells where a number changes most, chosen while the map is computed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from periodic.checks import named, number, whole
from periodic.maps.cell import Arrangement, Cell, Chunk, Outcome
from periodic.maps.grid import check_names, check_total, check_values
from periodic.maps.task import Task

ROUND = 16
"""Cells that are chosen together: they do not depend on how many processes there are, nor which is faster."""


@dataclass(frozen=True)
class Adaptive:
    """Cells of a box of parameters where one number changes most, by the sampler of the package adaptive.

    Each cell is computed for itself. One that failed counts as its nearest neighbour in that choice.

    Parameters
    ----------
    bounds : mapping of str to (float, float)
        Range (SI) of each parameter.
    number : str
        The number that decides: one of which a branch has a single value.
    cells : int
        How many there shall be.

    Raises
    ------
    ValueError
        For ranges that are none, and counts that are none.

    References
    ----------
    Nijholt, Weston, Hoofwijk, Akhmerov: Adaptive, doi 10.5281/zenodo.1182437.
    """

    bounds: Mapping[str, tuple[float, float]]
    number: str
    cells: int = 200
    total: int = field(init=False, repr=False)

    def __post_init__(self) -> None:
        named("bounds", self.bounds, "ranges")
        if not self.bounds:
            raise ValueError("bounds is empty; it must give the range of at least one parameter")
        for name, ends in self.bounds.items():
            _rising(name, ends)
        object.__setattr__(self, "total", whole("cells", self.cells, 2 ** len(self.bounds)))
        check_total("map", self.total)

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters that are varied."""
        return tuple(self.bounds)

    def check(self, task: Task) -> None:
        """Check that the task has the parameters and the number, and that there is the sampler."""
        check_names("bounds", self.names, task)
        check_values(task, self.bounds)
        known = [n for n in task.numbers if self.number == n or self.number.startswith(f"{n} ")]
        if not known:
            raise ValueError(f"number is {self.number!r}; it must be one of {', '.join(task.numbers)}")
        self._learner()

    def _learner(self) -> Any:
        try:
            import adaptive
        except ImportError:
            raise ValueError(
                "grid is Adaptive; its sampler must be installed (pip install adaptive)"
            ) from None
        ranges = [tuple(map(float, ends)) for ends in self.bounds.values()]
        if len(ranges) == 1:
            return adaptive.Learner1D(None, ranges[0])
        return adaptive.Learner2D(None, ranges) if len(ranges) == 2 else adaptive.LearnerND(None, ranges)

    def rounds(self, found: Mapping[Cell, Outcome], size: int) -> Iterator[list[Chunk]]:
        """Yield the corners of the box, then round after round where the number changes most."""
        learner, chosen = self._learner(), 0
        while chosen < self.total:
            points, _ = learner.ask(min(ROUND, self.total - chosen))
            cells = [tuple(map(float, np.atleast_1d(point))) for point in points]
            yield [(cell,) for cell in cells]
            chosen += len(cells)
            for point, value in zip(points, self._values(cells, found), strict=True):
                learner.tell(point, value)

    def _values(self, cells: list[Cell], found: Mapping[Cell, Outcome]) -> list[float]:
        """The number in each cell; where there is none that of the nearest cell."""
        known = {cell: self._number(outcome) for cell, outcome in found.items()}
        finite = {cell: value for cell, value in known.items() if np.isfinite(value)}
        width = np.array([high - low for low, high in self.bounds.values()])
        return [_nearest(np.array(cell) / width, finite, width) for cell in cells]

    def _number(self, outcome: Outcome) -> float:
        value = outcome.numbers.get(self.number, float("nan"))
        if not isinstance(value, float):
            raise ValueError(f"number is {self.number!r}, of which a branch has several; it must have one")
        return value

    def arranged(self, found: Mapping[Cell, Outcome]) -> Arrangement:
        """Return the cells that are known, one after the other."""
        cells = sorted(found)
        columns = zip(*cells, strict=True) if cells else [()] * len(self.names)
        coordinates = {name: ("cell", column) for name, column in zip(self.names, columns, strict=True)}
        return Arrangement({"cell": len(cells)}, coordinates, cells)

    def described(self) -> Any:
        """Return the box, the number and how many cells."""
        ranges = {name: list(map(float, ends)) for name, ends in self.bounds.items()}
        return {"adaptive": ranges, "number": self.number, "cells": self.cells}


def _nearest(at: np.ndarray, finite: Mapping[Cell, float], width: np.ndarray) -> float:
    """The value of the cell nearest to a place, in widths of the box; 0 where none is known."""
    if not finite:
        return 0.0
    apart = np.linalg.norm(np.array(list(finite)) / width - at, axis=1)
    return list(finite.values())[int(apart.argmin())]


def _rising(name: str, ends: Any) -> None:
    try:
        low, high = (number("bound", end) for end in ends)
    except (TypeError, ValueError):
        low = high = np.nan
    if not (np.isfinite(low) and np.isfinite(high) and low < high):
        raise ValueError(f"bounds of {name} are {ends}; they must be two rising finite numbers")
