"""The picture of a branch: stable parts solid, unstable dashed, folds labelled."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from reports.schema import Scene
from reports.view import View, view_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from periodic import Branch

Points = Sequence[tuple[float, float]]

BLUE, ORANGE, GREEN, INK = "#1f5fa8", "#d1661b", "#2b8a57", "#222222"


def draw(
    path: Path, scene: Scene, branch: Branch, integrated: tuple[Points, Points] | None = None, dpi: int = 150
) -> None:
    """Write the picture of a branch as a PNG file.

    `integrated` are the points that time integration reaches coming from below and those it reaches coming
    from above, as (speed in rev/min, x peak to peak in micrometres).
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    view = view_of(scene)
    _curve(axes, view, branch)
    if integrated is not None:
        _integrated(axes, *integrated)
    _folds(axes, view, branch)
    axes.set(xlabel=view.axes[0], ylabel=view.axes[1])
    axes.set_title(scene.title, fontsize="medium")
    axes.grid(alpha=0.25)
    axes.set_ylim(bottom=0)
    axes.margins(x=0.02)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(frameon=False, loc="upper right")
    figure.savefig(path, format="png", dpi=dpi)


def _curve(axes: Axes, view: View, branch: Branch) -> None:
    """Draw the branch as two lines, each broken where the other goes on."""
    if not len(branch):
        return
    across = np.array([view.abscissa.value(point) for point in branch], dtype=float)
    up = np.array([view.height.value(point) for point in branch], dtype=float)
    sound = np.array([point.stable or point.label.value == "LP" for point in branch])
    solid = sound[:-1] & sound[1:]
    for chosen, style, name in ((solid, "-", "stable"), (~solid, "--", "unstable")):
        if chosen.any():
            x, y = _pieces(across, chosen), _pieces(up, chosen)
            axes.plot(x, y, style, color=BLUE, linewidth=1.8, label=name)


def _pieces(values: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return the ends of the chosen segments, a gap before each segment that does not go on from the last."""
    line: list[float] = []
    for k in np.flatnonzero(chosen):
        if k and chosen[k - 1]:
            line.append(values[k + 1])
        else:
            line += [np.nan, values[k], values[k + 1]]
    return np.array(line)


def _integrated(axes: Axes, below: Points, above: Points) -> None:
    """Draw what time integration reaches."""
    kinds = (
        (below, "^", GREEN, "integrated, speed rising"),
        (above, "v", ORANGE, "integrated, speed falling"),
    )
    for points, marker, color, name in kinds:
        if len(points):
            x, y = np.array(points, dtype=float).T
            axes.plot(x, y, marker, color=color, markersize=5, markerfacecolor="none", label=name)


def _folds(axes: Axes, view: View, branch: Branch) -> None:
    """Mark and name the folds and the point where a trace failed."""
    for point in branch.special_points:
        if point.label.value not in ("LP", "MX"):
            continue
        at = float(view.abscissa.value(point) or 0), float(view.height.value(point) or 0)
        axes.plot(*at, "o", color=INK, markersize=5, zorder=5)
        text = f"{point.label.value} {at[0]:.5g}"
        axes.annotate(text, at, xytext=(7, 5), textcoords="offset points", color=INK)
