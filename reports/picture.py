"""The picture of a branch: stable parts solid, unstable dashed, folds labelled."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from reports.curve import draw_curve, solid
from reports.schema import Scene
from reports.view import View, view_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
    _marks(axes, view, branch)
    axes.set(xlabel=view.axes[0], ylabel=view.axes[1])
    axes.grid(alpha=0.25)
    axes.set_ylim(bottom=0)
    axes.margins(x=0.02)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(frameon=False, loc="upper right")
    entitled(path, figure, axes, scene.title, dpi)


def entitled(path: Path, figure: Figure, axes: Axes, title: str, dpi: int) -> None:
    """Write a figure as a PNG file, its axes under a title in any script that is no formula."""
    axes.set_title(title, fontsize="medium", parse_math=False)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing", UserWarning)
        figure.savefig(path, format="png", dpi=dpi)


def _curve(axes: Axes, view: View, branch: Branch) -> None:
    """Draw the branch, stable parts solid."""
    across, up = _values(view, branch)
    draw_curve(axes, across, up, solid(branch), color=BLUE)


def _values(view: View, branch: Branch) -> tuple[np.ndarray, np.ndarray]:
    """Return both coordinates of every point."""
    across = [view.abscissa.value(point) for point in branch]
    up = [view.height.value(point) for point in branch]
    return np.array(across, dtype=float), np.array(up, dtype=float)


def _integrated(axes: Axes, below: Points, above: Points) -> None:
    """Draw what time integration reaches."""
    for points, marker, color, way in ((below, "^", GREEN, "rising"), (above, "v", ORANGE, "falling")):
        if len(points):
            x, y = np.array(points, dtype=float).T
            name = f"time integration, speed {way}"
            axes.plot(x, y, marker, color=color, markersize=5, markerfacecolor="none", label=name)


def _marks(axes: Axes, view: View, branch: Branch) -> None:
    """Mark and name folds, doublings and where a trace failed, on the side away from the branch."""
    across, up = _values(view, branch)
    for k, point in enumerate(branch):
        if point.label.value not in ("LP", "PD", "MX"):
            continue
        neighbours = across[max(k - 1, 0) : k + 2]
        side = 1 if across[k] >= neighbours.mean() else -1
        axes.plot(across[k], up[k], "o", color=INK, markersize=5, zorder=5)
        axes.annotate(
            f"{point.label.value}\n{across[k]:.5g}",
            (across[k], up[k]),
            xytext=(7 * side, 0),
            textcoords="offset points",
            horizontalalignment="left" if side > 0 else "right",
            verticalalignment="top",
            fontsize="small",
            color=INK,
        )
