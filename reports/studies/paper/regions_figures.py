"""Maps of speed against waviness, preload or viscosity, with the regions where there are two motions."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from periodic import Branch, Label
from periodic.results.betweenpoints import smooth
from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.paper.branches.regions_curves import (
    AMPLITUDE,
    PRELOAD,
    RANGES,
    SCENE,
    UNITS,
    VISCOSITY,
    as_thin_as,
    doubled_folds,
    doublings,
    folds,
    half,
    level,
    peaks,
)
from reports.studies.paper.common.discs import MICRO, OIL_B, RPM_SHOWN
from reports.studies.paper.common.figures import SPEED, legend
from reports.studies.paper.common.scenes import nominal
from reports.studies.paper.common.tracing import speed
from symbolic.arrays import Array
from symbolic.scenes.axes import RPM

AXES = {AMPLITUDE: "waviness amplitude (µm)", PRELOAD: "preload (N)", VISCOSITY: "viscosity (Pa s)"}
SPEEDS = {AMPLITUDE: (180.0, 620.0), PRELOAD: (60.0, 900.0), VISCOSITY: (100.0, 620.0)}
ZOOM = {
    AMPLITUDE: ((262.0, 286.0), (0.0, 0.5)),
    PRELOAD: ((150.0, 380.0), (200.0, 2500.0)),
    VISCOSITY: ((120.0, 262.0), (0.02, 20.0)),
}
"""Speeds and values of each map's second panel."""

PAPER_SPEEDS = (100.0, 500.0)
"""Range of the paper's frequency plots, rev/min."""


def drawn(second: str) -> Figure:
    """The whole map over one second parameter, and what lies about the resonance in it."""
    figure, (left, right) = panels(1, 2, height=4.2, gridspec_kw={"width_ratios": (3, 2)})
    for axes in (left, right):
        _regions(axes, second)
        _points(axes, second)
        axes.set(xlabel=SPEED, yscale="linear" if second == AMPLITUDE else "log")
    low, high = (value / UNITS[second][0] for value in RANGES[second])
    left.set(xlim=SPEEDS[second], ylim=(0 if second == AMPLITUDE else low, high), ylabel=AXES[second])
    right.set(xlim=ZOOM[second][0], ylim=ZOOM[second][1])
    legend(figure, left, ncols=2, size=8)
    return figure


def _regions(axes: Any, second: str) -> None:
    halves = (half(second),) if second == VISCOSITY else ()
    for curves, color, width, label in (
        (folds(second), TRUSTED, 1.2, "two motions of one period"),
        (halves, SECOND, 1.2, "two motions of one period (2:1)"),
        (doublings(second), PAPER, 1.0, "motion of one period unstable"),
    ):
        lines = [_curve(found, second) for found in curves]
        if lines:
            _fill(axes, lines, color, label)
        for x, y in lines:
            axes.plot(x, y, color=color, linewidth=width)
    x, y = _curve(doubled_folds(second), second)
    axes.plot(x, y, color="tab:orange", linewidth=1.4, label="fold of the motions of two periods")
    for found in (*folds(second), *halves):
        for cusp in found.labelled(Label.CUSP):
            axes.plot(speed(SCENE, cusp.orbit), cusp.parameter / UNITS[second][0], "kv", markersize=6)


def _points(axes: Any, second: str) -> None:
    if second == PRELOAD:
        axes.plot(*_curve(peaks(second), second), "k:", linewidth=1.2, label="x peak to peak largest")
        axes.plot(*_curve(level(), second), "k--", linewidth=0.9, label="x peak to peak 10 µm")
    values = {
        AMPLITUDE: [nominal(SCENE)[AMPLITUDE] / MICRO],
        PRELOAD: [810.0, 2100.0],
        VISCOSITY: [nominal(SCENE)[VISCOSITY], as_thin_as(OIL_B)],
    }[second]
    for value in values:
        axes.plot(PAPER_SPEEDS, (value, value), "-", color="0.35", linewidth=1.0)
        axes.plot(RPM_SHOWN, value, "o", color="k", markersize=5)
    axes.plot([], [], "-o", color="0.35", markerfacecolor="k", label="speeds of the paper; 360 rev/min")


def _curve(found: Branch, second: str) -> tuple[Array, Array]:
    """Speed in rev/min and the second parameter in the axis's unit, smooth between the points."""
    return smooth(found.column("speed") / RPM, found.column(second) / UNITS[second][0])


def _fill(axes: Any, curves: list[tuple[Array, Array]], color: str, label: str) -> None:
    """Shade what lies between two curves, or inside one that turns."""
    x, y = curves[0]
    if len(curves) == 2:
        (ax, ay), (bx, by) = [(x, y) if y[0] < y[-1] else (x[::-1], y[::-1]) for x, y in curves]
        x, y = np.append(ax, bx[::-1]), np.append(ay, by[::-1])
    axes.fill(x, y, color=color, alpha=0.25, linewidth=0, label=label)
