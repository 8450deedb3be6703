"""The figures of a machine: its branch with special points and marching, and a curve in two parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from periodic import Branch, plots
from periodic.results.plots.curve import draw_curve
from reports.studies.pages.figures import SECOND, TRUSTED, panels

MARKERS = {"LP": "o", "PD": "D", "NS": "s", "BP": "x", "GR": "^"}


@dataclass(frozen=True)
class View:
    """What a figure shows of a branch: an output over the parameter, the names of both, their units in SI."""

    output: str
    names: tuple[str, str]
    unit: float
    size: float


@dataclass(frozen=True)
class Curve:
    """A curve over two parameters, with the names of its axes."""

    x: np.ndarray
    y: np.ndarray
    names: tuple[str, str]


def diagram(view: View, found: Branch, marched: Sequence[tuple[float, float | None]]) -> Figure:
    """Draw the branch, stable solid and unstable dashed, its special points, and settled simulations."""
    figure, axes = panels(1, 1, height=3.4)
    across = np.array([p.parameter for p in found]) / view.unit
    up = found.peak_to_peak(view.output) / view.size
    draw_curve(axes, across, up, found.stable_between, color=TRUSTED)
    for label, marker in MARKERS.items():
        points = [p for p in found.special_points if p.label.value == label]
        if points:
            at = [p.parameter / view.unit for p in points]
            high = [p.peak_to_peak(view.output) / view.size for p in points]
            axes.plot(at, high, marker, color="k", markersize=5, markerfacecolor="w", label=label)
    settled = [(value, high) for value, high in marched if high is not None]
    if settled:
        axes.plot(*zip(*settled, strict=True), "v", color=SECOND, markersize=5, label="time integration")
    axes.set(xlabel=view.names[0], ylabel=view.names[1])
    axes.legend(frameon=False)
    return figure


def spectra(view: View, found: Branch) -> Figure:
    """Draw the spectra of the orbits, each above its value of the parameter."""
    figure, axes = panels(1, 1, height=3.8)
    plots.waterfall(found, view.output, axes)
    return figure


def over_two(curve: Curve) -> Figure:
    """Draw a curve over two parameters."""
    figure, axes = panels(1, 1, height=2.8)
    axes.plot(curve.x, curve.y, "-", color=TRUSTED)
    axes.set(xlabel=curve.names[0], ylabel=curve.names[1])
    return figure
