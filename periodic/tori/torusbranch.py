"""A family of tori over a parameter, as it was traced."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.display.htmltables import paragraph, table, with_unit
from periodic.orbit.scheme import Array
from periodic.results.interactive.pictures import Shown
from periodic.results.plots.frame import dressed, fresh
from periodic.results.point import Point
from periodic.system import System
from periodic.tori.pages import family_shown
from periodic.tori.toruspoint import TorusPoint

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SPECIAL = ("LP", "BP", "PD", "NS")
"""Labels of special points."""

SHOWN = 40
"""Most points that a table shows."""


@dataclass(frozen=True, eq=False, repr=False)
class TorusBranch(Sequence[TorusPoint]):
    """Tori in order along their family.

    Parameters
    ----------
    parameter : str
        Name of the parameter.
    points : tuple of TorusPoint
        The tori.
    stops : tuple of str
        Why the family ends at its first point, and at its last.
    released : str
        The parameter that changes so that the rotation number stays, "" for none.
    orbits : tuple of Point
        The orbits of some periods of the excitation on which the motion locks, beyond ends and on the way.
    """

    parameter: str
    points: tuple[TorusPoint, ...]
    stops: tuple[str, str]
    released: str = ""
    orbits: tuple[Point, ...] = ()

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: Any) -> Any:
        return self.points[index]

    def __iter__(self) -> Iterator[TorusPoint]:
        return iter(self.points)

    def __repr__(self) -> str:
        return f"TorusBranch({len(self)} tori over {self.parameter}; {self.stops[0]} | {self.stops[1]})"

    def __str__(self) -> str:
        rows = [self._headings, *map(self._row, self.points)]
        widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
        lines = ["  ".join(c.rjust(w) for c, w in zip(row, widths, strict=True)) for row in rows]
        return "\n".join([*lines, f"begins: {self.stops[0]}", f"ends: {self.stops[1]}"])

    def _repr_html_(self) -> str:
        step = max(1, len(self) // SHOWN)
        rows = [self._row(point) for point in self.points[::step]]
        return table(self._headings, rows) + "".join(paragraph(stop) for stop in self.stops)

    def _titled(self, parameter: str) -> str:
        """A parameter's name with its unit."""
        known = {q.name: q.unit for q in self.points[0].torus.layout.parameters}
        return with_unit(parameter, known[parameter])

    @property
    def _headings(self) -> tuple[str, ...]:
        names = [self._titled(name) for name in (self.parameter, self.released) if name]
        return (*names, "rotation number", "size", "largest modulus", "stable", "angles", "tail", "")

    def _row(self, point: TorusPoint) -> tuple[str, ...]:
        other = [f"{point.torus.parameters[self.released]:.9g}"] if self.released else []
        sizes = np.abs(point.multipliers)
        return (
            f"{point.parameter:.9g}",
            *other,
            f"{point.torus.rotation_number:.9f}",
            f"{point.torus.size:.6g}",
            f"{sizes.max():.6g}",
            "yes" if point.stable else "no",
            str(len(point.torus.states)),
            f"{point.torus.tail:.0e}",
            point.label,
        )

    @property
    def values(self) -> Array:
        """The parameter (SI), (K,)."""
        return np.array([point.parameter for point in self.points])

    @property
    def rotation_numbers(self) -> Array:
        """The rotation numbers, (K,)."""
        return np.array([point.torus.rotation_number for point in self.points])

    def labelled(self, label: str) -> list[TorusPoint]:
        """Return the points with a label.

        Parameters
        ----------
        label : str
            "LP", "BP", "PD", "NS", "UZ" or "EP".

        Returns
        -------
        list of TorusPoint
            In order along the family.
        """
        return [point for point in self.points if point.label == label]

    def shown(self, system: System | None = None) -> Shown:
        """Return what the page of it shows: see `per.page`."""
        titles = [self._titled(name) for name in (self.parameter, self.released) if name]
        said = [f"begins: {self.stops[0]}", f"ends: {self.stops[1]}"]
        return family_shown(said, self.points, titles, self.released, system)

    def plot(self, axes: Axes | None = None) -> Axes:
        """Plot the size of the section over the parameter, stable tori drawn through, others dashed.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Where to plot; by default in a figure of its own.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        axes = fresh(axes)
        size = np.array([point.torus.size for point in self.points])
        stable = np.array([point.stable for point in self.points])
        for kind, style, name in ((stable, "-", "stable"), (~stable, "--", "unstable")):
            near = kind | np.roll(kind, 1) | np.roll(kind, -1)
            if kind.any():
                axes.plot(self.values, np.where(near, size, np.nan), style, color="C0", label=name)
        for k, label in enumerate(SPECIAL):
            marked = self.labelled(label)
            if marked:
                at = [point.parameter for point in marked], [point.torus.size for point in marked]
                axes.plot(*at, "os^D"[k], color="C3", label=label)
        return dressed(axes, self._titled(self.parameter), "size of the section (scaled)")
