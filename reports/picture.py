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

PER_SEGMENT = 8
"""Parts that the curve is drawn in between two computed points."""


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
    axes.set_title(scene.title, fontsize="medium")
    axes.grid(alpha=0.25)
    axes.set_ylim(bottom=0)
    axes.margins(x=0.02)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(frameon=False, loc="upper right")
    figure.savefig(path, format="png", dpi=dpi)


def _curve(axes: Axes, view: View, branch: Branch) -> None:
    """Draw the branch as two lines, each broken where the other goes on."""
    if len(branch) < 2:
        return
    across, up = _values(view, branch)
    sound = np.array([point.stable or point.label.value == "LP" for point in branch])
    solid = np.repeat(sound[:-1] & sound[1:], PER_SEGMENT)
    across, up = _smooth(across, up)
    for chosen, style, name in ((solid, "-", "stable"), (~solid, "--", "unstable")):
        if chosen.any():
            x, y = _pieces(across, chosen), _pieces(up, chosen)
            axes.plot(x, y, style, color=BLUE, linewidth=1.8, label=name)


def _values(view: View, branch: Branch) -> tuple[np.ndarray, np.ndarray]:
    """Return both coordinates of every point."""
    across = [view.abscissa.value(point) for point in branch]
    up = [view.height.value(point) for point in branch]
    return np.array(across, dtype=float), np.array(up, dtype=float)


def _smooth(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a curve through the points, each segment in PER_SEGMENT parts.

    Monotone cubics of the chord length: they turn in speed at the computed folds and nowhere else.
    """
    from scipy.interpolate import PchipInterpolator

    spans = [max(float(np.ptp(values)), np.finfo(float).tiny) for values in (x, y)]
    chords = np.hypot(np.diff(x) / spans[0], np.diff(y) / spans[1])
    length = np.concatenate([[0.0], np.cumsum(np.maximum(chords, 1e-9))])
    parts = np.arange(len(x) - 1)[:, None] + np.arange(PER_SEGMENT) / PER_SEGMENT
    where = np.interp(np.append(parts, len(x) - 1), np.arange(len(x)), length)
    curve = PchipInterpolator(length, np.column_stack([x, y]))(where)
    return curve[:, 0], curve[:, 1]


def _pieces(values: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return the ends of the chosen segments, a gap before each that does not go on from the last."""
    line: list[float] = []
    for k in np.flatnonzero(chosen):
        begins = not (k and chosen[k - 1])
        line += [np.nan, values[k], values[k + 1]] if begins else [values[k + 1]]
    return np.array(line)


def _integrated(axes: Axes, below: Points, above: Points) -> None:
    """Draw what time integration reaches."""
    for points, marker, color, way in ((below, "^", GREEN, "rising"), (above, "v", ORANGE, "falling")):
        if len(points):
            x, y = np.array(points, dtype=float).T
            name = f"time integration, speed {way}"
            axes.plot(x, y, marker, color=color, markersize=5, markerfacecolor="none", label=name)


def _marks(axes: Axes, view: View, branch: Branch) -> None:
    """Mark and name the folds, and the point where a trace failed, on the side away from the branch."""
    across, up = _values(view, branch)
    for k, point in enumerate(branch):
        if point.label.value not in ("LP", "MX"):
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
