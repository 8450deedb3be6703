"""What the study's figures share: curves of branches, marks of their special points, axes and legends."""

from __future__ import annotations

from typing import Any

from periodic import Branch, Label
from periodic.results.plots.curve import draw_curve
from reports.studies.paper.common.discs import MICRO
from reports.studies.paper.common.tracing import xy
from symbolic.scenes.axes import RPM

COLOURS = ("tab:blue", "tab:orange", "tab:green", "tab:red", "tab:purple", "tab:brown")

SPEED, SWING = "speed (rev/min)", "x peak to peak (µm)"
"""Labels of axes."""

MARKERS = {Label.FOLD: "o", Label.DOUBLING: "D"}


def curve(
    axes: Any, found: Branch, color: str, labels: tuple[str, str] = ("", ""), linewidth: float = 1.4
) -> None:
    """Draw x over speed along a branch, stable parts solid, unstable ones dashed."""
    draw_curve(axes, *xy(found), found.stable_between, color=color, labels=labels, linewidth=linewidth)


def mark(axes: Any, found: Branch, unit: float = RPM, color: str = "k") -> None:
    """Mark the folds and period doublings of a branch over a parameter with a unit in SI."""
    for label, marker in MARKERS.items():
        for point in found.labelled(label):
            at = point.parameter / unit, point.peak_to_peak("x") / MICRO
            axes.plot(*at, marker, color=color, markersize=4)


def outer(axes: Any, xlabel: str, ylabel: str) -> None:
    """Label the lowest and the leftmost of a grid of axes."""
    for panel in axes[-1]:
        panel.set_xlabel(xlabel)
    for panel in axes[:, 0]:
        panel.set_ylabel(ylabel)


def legend(figure: Any, axes: Any, where: str = "lower", ncols: int = 3, size: float | None = None) -> None:
    """Give a figure one legend outside its axes, of what one of them shows."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc=f"outside {where} center", ncols=ncols, fontsize=size)
