"""The picture of a branch: stable parts solid, unstable dashed, folds labelled."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.results.peaks import PEAK_OF
from periodic.results.plots.curve import draw_curve
from periodic.results.plots.labels import placed
from symbolic.scenes.schema import Scene

from ..drawing import BLUE, GREEN, INK, ORANGE, figure, legend, write
from ..view import View, view_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from periodic import Branch

Settlements = tuple[list[tuple[float, float]], list[tuple[float, float]]]
"""What time integration settles to coming from below, and from above: parameter and height as shown."""


def draw(path: Path, scene: Scene, branch: Branch, integrated: Settlements | None = None) -> None:
    """Write the picture of a branch as a PNG file, with what time integration settles to."""
    drawn = figure(5.0)
    axes, view = drawn.add_subplot(), view_of(scene)
    name, size = view.drawn
    across, up = branch.curve(name)
    draw_curve(axes, across / view.unit, up / size, branch.stable_between, color=BLUE)
    if integrated is not None:
        _integrated(axes, integrated, view.stem)
    _asked_for(axes, view, branch)
    _marks(axes, view, branch)
    axes.set(xlabel=view.axes[0], ylabel=view.axes[1])
    axes.grid(alpha=0.25)
    axes.set_ylim(bottom=0)
    axes.margins(x=0.02)
    legend(axes)
    write(path, drawn, axes, scene.title)


def _values(view: View, branch: Branch) -> tuple[np.ndarray, np.ndarray]:
    """Return both coordinates of every point."""
    across = [view.abscissa.value(point) for point in branch]
    up = [view.height.value(point) for point in branch]
    return np.array(across, dtype=float), np.array(up, dtype=float)


def _integrated(axes: Axes, settled: Settlements, parameter: str) -> None:
    """Draw what time integration settles to, with the parameter rising and falling."""
    looks = (("^", GREEN, "rising"), ("v", ORANGE, "falling"))
    for points, (marker, color, way) in zip(settled, looks, strict=True):
        if points:
            x, y = np.array(points, dtype=float).T
            name = f"time integration, {parameter} {way}"
            axes.plot(x, y, marker, color=color, markersize=5, markerfacecolor="none", label=name)


def _asked_for(axes: Axes, view: View, branch: Branch) -> None:
    """Mark the points at values asked for."""
    chosen = [point.label.value == "UZ" for point in branch]
    if any(chosen):
        across, up = (values[chosen] for values in _values(view, branch))
        look: dict[str, Any] = {"color": ORANGE, "markersize": 7, "markerfacecolor": "none", "zorder": 4}
        axes.plot(across, up, "s", label="values asked for", **look)


def _marks(axes: Axes, view: View, branch: Branch) -> None:
    """Mark and name special points and where a trace failed, each name where it covers nothing."""
    own = PEAK_OF + view.drawn[0].rpartition(" ")[0]
    for point, *at in zip(branch, *_values(view, branch), strict=True):
        if point.label.value in ("", "EP", "UZ") or (point.label.value == "PK" and point.event != own):
            continue
        x, y = map(float, at)
        axes.plot(x, y, "o", color=INK, markersize=5, zorder=5)
        placed(axes).add(f"{point.label.value}\n{x:.5g}", (x, y))
