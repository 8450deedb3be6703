"""A branch: the points of one continuation, with the names and units needed to read them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from periodic.checkpoint import Checkpoint
from periodic.label import Label
from periodic.point import Point
from periodic.scheme import Array
from periodic.stop import Stop


class BranchFileError(ValueError):
    """A file that is not a readable branch; the message says what is wrong with it."""


@dataclass(frozen=True)
class Quantity:
    """Name, unit and SI value of one internal unit of a state, unknown, output or parameter."""

    name: str
    unit: str
    scale: float = 1.0


@dataclass(frozen=True)
class Layout:
    """What the columns of a branch's arrays mean."""

    states: tuple[Quantity, ...]
    algebraics: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    parameters: tuple[Quantity, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Branch:
    """Points in order along the branch; `parameter` names the one that was continued in.

    `stop` says why the branch ended; a branch traced both ways from its start has a second reason in
    `stop_backwards`. `elapsed` in s. `checkpoints` are where its runs (one or two) stand, for `trace` to
    resume them; the first `backwards` points are those of the first of two runs. `made`: with what settings.
    """

    parameter: str
    layout: Layout
    points: tuple[Point, ...]
    stop: Stop
    stop_backwards: Stop | None = None
    newton_iterations: int = 0
    elapsed: float = 0.0
    versions: dict[str, str] = field(default_factory=dict)
    checkpoints: tuple[Checkpoint, ...] = ()
    backwards: int = 0
    made: dict[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"Branch({self.parameter}, {len(self)} points, {self.stop})"

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: int) -> Point:
        return self.points[index]

    def __iter__(self) -> Iterator[Point]:
        return iter(self.points)

    @property
    def special_points(self) -> tuple[Point, ...]:
        """The labelled points, in order along the branch."""
        return tuple(p for p in self.points if p.label is not Label.NONE)

    def labelled(self, label: Label) -> tuple[Point, ...]:
        """The points with one label."""
        return tuple(p for p in self.points if p.label is label)

    @property
    def values(self) -> Array:
        """The continuation parameter along the branch (SI), shape (points,)."""
        return np.array([p.parameter for p in self.points])

    @property
    def stable(self) -> np.ndarray:
        """Whether each point is stable, shape (points,)."""
        return np.array([p.stable for p in self.points], dtype=bool)

    def peak_to_peak(self, output: str) -> Array:
        """Maximum minus minimum of an output along the branch (SI), shape (points,)."""
        return np.array([p.peak_to_peak(output) for p in self.points])

    def column(self, name: str) -> Array:
        """A column asked for, or a parameter (SI), along the branch, shape (points,)."""
        names = [q.name for q in self.layout.parameters]
        if name in names:
            return np.array([p.orbit.parameter[names.index(name)] for p in self.points])
        known = [*names, *(self.points[0].columns if self.points else ())]
        if name not in known:
            raise ValueError(f"column is {name!r}; it must be one of {', '.join(known)}")
        return np.array([p.columns[name] for p in self.points])

    def table(self) -> str:
        """Return one line per point: parameter, peak to peak of each output, largest multiplier, label.

        Of equilibria the outputs themselves and the largest real part of the eigenvalues.
        """
        names = [q.name for q in self.layout.outputs]
        measured, largest = (" p-p", "|mu| max")
        if any(p.equilibrium for p in self.points):
            measured, largest = ("", "Re lambda max")
        head = ["label", self.parameter, *(n + measured for n in names), largest, "stable", "error"]
        rows = [head, *([*_cells(p, names)] for p in self.points)]
        widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
        return "\n".join(
            "  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows
        )

    def save(self, path: str | Path) -> None:
        """Write the branch, its orbits included, to a NetCDF file (replacing it in one move)."""
        from periodic import storage

        storage.save(self, Path(path))

    @staticmethod
    def load(path: str | Path) -> Branch:
        """Read a branch from a NetCDF file. Raises BranchFileError, in one sentence, if it is not one."""
        from periodic import storage

        return storage.load(Path(path))


def _cells(point: Point, names: list[str]) -> list[str]:
    take = point.maximum.__getitem__ if point.equilibrium else point.peak_to_peak
    ripple = [f"{take(name):.9g}" for name in names]
    largest = point.multipliers.real if point.equilibrium else np.abs(point.multipliers)
    size = f"{largest.max():.9f}"
    stable = "yes" if point.stable else "no"
    return [point.label.value, f"{point.parameter:.12g}", *ripple, size, stable, f"{point.error.orbit:.1e}"]
