"""A cell of a map: values of its parameters, and what became of its branch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from periodic.checks import named, plain

Cell = tuple[float, ...]
"""Values (SI) of the parameters that a map varies, in its order."""

Chunk = tuple[Cell, ...]
"""Neighbouring cells, each computed from the one before. A killed run loses one for each process."""


@dataclass(frozen=True)
class Arrangement:
    """How cells lie in a result: dimensions with their sizes, coordinates as xarray takes them, and the cells
    in C order.
    """

    dimensions: Mapping[str, int]
    coordinates: Mapping[str, tuple[str, Sequence[float]]]
    cells: Sequence[Cell]


@dataclass(frozen=True)
class Outcome:
    """What became of a cell.

    numbers: those of the task by name, each one value or several; empty where there is a reason. reason: why
    there are none. lost: whether its worker died, so that it has not been computed at all.
    """

    cell: Cell
    numbers: Mapping[str, float | Sequence[float]] = field(default_factory=dict)
    reason: str = ""
    lost: bool = False
    points: int = 0
    newton: int = 0
    seconds: float = 0.0

    def __post_init__(self) -> None:
        named("numbers", self.numbers, "numbers")
        object.__setattr__(self, "reason", plain(self.reason))  # of a file, or what a user's function raised

    def plain(self) -> dict[str, Any]:
        """Return it as plain data."""
        return {**vars(self), "cell": list(self.cell), "numbers": dict(self.numbers)}

    @classmethod
    def of(cls, plain: Mapping[str, Any]) -> Outcome:
        """Return the outcome that plain data stand for."""
        return cls(**{**plain, "cell": tuple(plain["cell"])})
