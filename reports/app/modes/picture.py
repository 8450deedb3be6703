"""The picture of a nonlinear mode: its frequency and its damping ratio over the amplitude."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import numpy as np

import periodic as per
from periodic.decisions.modebranch import RATIO
from periodic.results.betweenpoints import PER_SEGMENT, smooth
from periodic.results.plots.labels import placed

from ..drawing import BLUE, INK, figure, write


class FoundLike(Protocol):
    """What is drawn."""

    @property
    def title(self) -> str: ...
    @property
    def branch(self) -> per.Branch: ...
    @property
    def size(self) -> float: ...
    @property
    def headings(self) -> list[str]: ...


def draw(path: Path, found: FoundLike) -> None:
    """Write the picture as a PNG file."""
    drawn = figure(5.5)
    upper, lower = drawn.subplots(2, 1, sharex=True)
    across = found.branch.values / found.size
    omega = [point.orbit.omega for point in found.branch]
    for axes, heights in ((upper, np.array(omega)), (lower, found.branch.column(RATIO))):
        axes.plot(*smooth(across, heights, PER_SEGMENT), color=BLUE)
    for point, x, w in zip(found.branch, across, omega, strict=True):
        if point.label.value not in ("", "EP", "UZ"):
            for axes, y in ((upper, w), (lower, point.columns[RATIO])):
                axes.plot(x, y, "o", color=INK, markersize=5, zorder=5)
            placed(upper).add(f"{point.label.value}\n{x:.5g}", (x, w))
    upper.set(ylabel=found.headings[1])
    lower.set(xlabel=found.headings[0], ylabel=RATIO)
    for axes in (upper, lower):
        axes.grid(alpha=0.25)
        axes.margins(x=0.02)
    lower.set_ylim(bottom=min(0.0, lower.get_ylim()[0]))
    write(path, drawn, upper, found.title)
