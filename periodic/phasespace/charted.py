"""What a system can do over a parameter, in one picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.motion import Motions
from periodic.results.branch import Branch
from periodic.results.plots.frame import dressed
from periodic.results.point import Point

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LETTERS, MARKERS = "abcdefghijklmnopqrstuvwxyz", "os^vDx"
"""Names of a branch's stable stretches, and their marks."""

PLAIN = ("EP", "UZ", "")
"""Labels of points at which nothing happens."""


def stretches(branch: Branch) -> list[int]:
    """Return for each point of a branch the number of the stable stretch that it is on, -1 where unstable."""
    found, last, before = list[int](), -1, False
    for point in branch:
        last, before = last + (point.stable and not before), point.stable
        found.append(last if point.stable else -1)
    return found


@dataclass(frozen=True, eq=False)
class Sheet:
    """A branch of an atlas.

    Parameters
    ----------
    branch : Branch
        The orbits.
    periods : int
        After how many excitation periods they come back.
    sections : list of list of (int, ndarray)
        At each of the atlas's values its orbits there: the number of the stable stretch, -1 where unstable,
        and the states once in each period.
    shares : ndarray, shape (stretches, K)
        The part of the box that leads to the orbits of each of its stable stretches, at each value.
    """

    branch: Branch
    periods: int
    sections: list[list[tuple[int, Array]]]
    shares: Array

    @property
    def name(self) -> str:
        """What its orbits are, in words."""
        return "one period" if self.periods == 1 else f"{self.periods} periods"


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
            lines += [
                self._attracts(f"{k}{letter}", shares)
                for letter, shares in zip(LETTERS, sheet.shares, strict=False)
                if (shares > 0).any()
            ]
            lines += [
                f"   {point.label} at {point.parameter:.9g}"
                for point in sheet.branch
                if str(point.label) not in PLAIN
            ]
        for value, found in zip(self.values, self.motions, strict=True):
            others = [motion for motion in found.stable if motion.point is None]
            lines += [f"at {value:.6g}: {motion.name}, {motion.tells}" for motion in others]
        return "\n".join([*lines, *self.remarks])

    def _attracts(self, name: str, shares: Array) -> str:
        """What part of the box leads to a stable stretch, and where, in words."""
        there = np.flatnonzero(shares > 0)
        low, high = 100 * shares[there].min(), 100 * shares.max()
        first, last = self.values[there[0]], self.values[there[-1]]
        return f"   {name} attracts {low:.1f} to {high:.1f} % of the box from {first:.6g} to {last:.6g}"

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
        at = middle.parameter, self._up(middle, 0.0)
        axes.annotate(name, at, (4, 4), textcoords="offset points", color=colour)

    def _up(self, point: Point, phase: float) -> float:
        """The state (SI) of an orbit at a phase."""
        layout = point.orbit.layout
        assert layout is not None
        column = layout.column(self.state)
        unit = layout.units(point.orbit.parameter)[self.state]
        return float(unit * point.orbit.state(np.array([phase]))[0, column.index])

    def _curve(self, axes: Any, sheet: Sheet, number: int, colour: str, name: int) -> None:
        """One line of a branch: the state in one of its periods, stable parts drawn through."""
        points = list(sheet.branch)
        across = np.array([point.parameter for point in points])
        up = np.array([self._up(point, FORCED * number) for point in points])
        stable = np.array([point.stable for point in points])
        for kind, style in ((stable, "-"), (~stable, ":")):
            near = kind.copy()
            near[1:] |= kind[:-1]
            label = (
                f"{name}: {sheet.name}" if number == 0 and style == ("-" if stable.any() else ":") else None
            )
            if kind.any():
                axes.plot(across, np.where(near, up, np.nan), style, color=colour, lw=1.3, label=label)
