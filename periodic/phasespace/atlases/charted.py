"""What a system can do over a parameter, in one picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.atlases.aperiodicranges import aperiodic_ranges
from periodic.phasespace.atlases.atlaspage import shown
from periodic.phasespace.atlases.sheet import Sheet
from periodic.phasespace.atlases.stretches import LETTERS, PLAIN, End, ends, stretches
from periodic.phasespace.motion import Motions
from periodic.results.interactive.pictures import Shown
from periodic.results.plots.frame import dressed
from periodic.results.point import Point
from periodic.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARKERS = "os^vDx"
"""Of a branch's stable stretches."""


@dataclass(frozen=True, eq=False, repr=False)
class Atlas:
    """Everything that was found over a parameter.

    Parameters
    ----------
    parameter, state : str
        The parameter, and the state that the picture shows at tau = 0.
    across, up : str
        What the axes of the picture are called, with units.
    values : ndarray, shape (K,)
        The values (SI) at which motions were looked for.
    motions : tuple of Motions
        What was found at each.
    sheets : tuple of Sheet
        The branches.
    dots : ndarray, shape (D, 2)
        The diagram beneath: values, and the state (SI) of motions that have settled from a few starts.
    remarks : tuple of str
        What could not be done, in words.
    """

    parameter: str
    state: str
    across: str
    up: str
    values: Array
    motions: tuple[Motions, ...]
    sheets: tuple[Sheet, ...]
    dots: Array
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return (
            f"Atlas({len(self.sheets)} branches over {self.parameter} from {self.values[0]:.6g} to "
            f"{self.values[-1]:.6g})"
        )

    def __str__(self) -> str:
        lines = [repr(self)]
        for k, sheet in enumerate(self.sheets, 1):
            lines.append(f"{k}: {sheet.name}; {sheet.branch.stop}")
            lines += self._stretches(k, sheet)
            special = [p for p in sheet.branch if str(p.label) not in PLAIN]
            said = ", ".join(str(End(point.parameter, str(point.label))) for point in special)
            lines += [f"   {said}"] if said else []
        branches = [sheet.branch for sheet in self.sheets]
        lines += aperiodic_ranges(self.values, self.motions, branches)
        return "\n".join([*lines, *self.remarks])

    def _stretches(self, k: int, sheet: Sheet) -> list[str]:
        """Its stable stretches in words; one that is gone through once more, a period later, once."""
        lines, known = list[str](), list[tuple[float, float]]()
        for letter, shares, own in zip(LETTERS, sheet.shares, ends(sheet.branch), strict=False):
            where = own[0].value, own[1].value
            if (shares > 0).any() or not any(np.allclose(where, other, rtol=1e-7) for other in known):
                lines.append(self._stretch(f"{k}{letter}", shares, own))
            known.append(where)
        return lines

    def _stretch(self, name: str, shares: Array, own: tuple[End, End]) -> str:
        """Where a stable stretch begins and ends, and what part of the box leads to it, in words."""
        where = f"   {name} is stable from {own[0]} to {own[1]}"
        there = np.flatnonzero(shares > 0)
        if not len(there):
            return where
        low, high = f"{100 * shares[there].min():.1f}", f"{100 * shares.max():.1f}"
        share = low if low == high else f"{low} to {high}"
        return f"{where}, and attracts {share} % of the box"

    @property
    def box(self) -> dict[str, tuple[float, float]]:
        """The ranges of states (SI) in which motions started, by name."""
        return self.motions[0].box

    def shown(self, system: System | None = None) -> Shown:
        """Return what the page of it shows: see `per.page`."""
        return shown(self)

    def plot(self) -> Figure:
        """Plot the branches over what is seen from many starts, and the shares of their basins below.

        Returns
        -------
        matplotlib.figure.Figure
            The figure.
        """
        import matplotlib.pyplot as plt

        figure, (upper, lower) = plt.subplots(
            2, 1, sharex=True, figsize=(7.0, 6.0), layout="constrained", height_ratios=(3, 1)
        )
        upper.plot(*self.dots.T, ".", color="0.75", ms=2.5, zorder=0, label="settled motions")
        for k, sheet in enumerate(self.sheets):
            for number in range(sheet.periods):
                self._curve(upper, sheet, number, f"C{k % 10}", k + 1)
        for k, sheet in enumerate(self.sheets):
            for number, shares in enumerate(sheet.shares[: len(LETTERS)]):
                there = np.where(shares > 0, 100 * shares, np.nan)
                if shares.any():
                    sign = MARKERS[number % len(MARKERS)]
                    lower.plot(
                        self.values,
                        there,
                        f"{sign}-",
                        color=f"C{k % 10}",
                        ms=4,
                        label=f"{k + 1}{LETTERS[number]}",
                    )
                    self._named(upper, sheet, number, f"{k + 1}{LETTERS[number]}", f"C{k % 10}")
        other = [sum(m.share for m in found.stable if m.point is None) for found in self.motions]
        if any(other):
            lower.plot(self.values, 100 * np.array(other), "x-", color="0.4", label="tori and chaos")
        lower.set_ylim(-5, 105)
        lower.set(xlabel=self.across, ylabel="share of the box, %")
        lower.grid(alpha=0.25)
        lower.legend(fontsize="small", frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
        dressed(upper, "", self.up)
        return figure

    def _named(self, axes: Any, sheet: Sheet, number: int, name: str, colour: str) -> None:
        """Write a stable stretch's name beside the middle of its orbits at the values."""
        own = [
            point
            for point, stretch in zip(sheet.branch, stretches(sheet.branch), strict=True)
            if stretch == number
        ]
        middle = own[len(own) // 2]
        at = middle.parameter, self.state_of(middle, 0.0)
        axes.annotate(name, at, (4, 4), textcoords="offset points", color=colour)

    def state_of(self, point: Point, phase: float) -> float:
        """Return the state (SI) that the picture shows, of an orbit at a phase."""
        layout = point.orbit.layout
        assert layout is not None
        column = layout.column(self.state)
        unit = layout.units(point.orbit.parameter)[self.state]
        return float(unit * point.orbit.state(np.array([phase]))[0, column.index])

    def _curve(self, axes: Any, sheet: Sheet, number: int, colour: str, name: int) -> None:
        """One line of a branch: the state in one of its periods, stable parts drawn through."""
        heights = np.array([self.state_of(point, FORCED * number) for point in sheet.branch])
        across, up, stable = sheet.curve(heights)
        for kind, style in ((stable, "-"), (~stable, ":")):
            near = kind.copy()
            near[1:] |= kind[:-1]
            label = (
                f"{name}: {sheet.name}" if number == 0 and style == ("-" if stable.any() else ":") else None
            )
            if kind.any():
                axes.plot(across, np.where(near, up, np.nan), style, color=colour, lw=1.3, label=label)
