"""Maps of speed against waviness, preload or viscosity, with the regions where there are two motions."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from periodic import Branch, Label, Value
from reports.curve import smooth
from reports.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.paper.regions_curves import (
    AMPLITUDE,
    OTHER_OIL,
    PRELOAD,
    RANGES,
    SCENE,
    VISCOSITY,
    as_thin_as,
    doubled_folds,
    doublings,
    folds,
    half,
    level,
    peaks,
)
from reports.paper.scenes import system
from reports.paper.stiffness import nominal
from reports.view import MICRO, RPM

Array = NDArray[np.float64]

UNITS = {AMPLITUDE: MICRO, PRELOAD: 1.0, VISCOSITY: 1.0}
AXES = {
    AMPLITUDE: "waviness amplitude (µm)",
    PRELOAD: "preload (N)",
    VISCOSITY: "viscosity (Pa s)",
}
SPEEDS = {AMPLITUDE: (180.0, 620.0), PRELOAD: (60.0, 900.0), VISCOSITY: (100.0, 620.0)}
ZOOM = {
    AMPLITUDE: ((262.0, 286.0), (0.0, 0.5)),
    PRELOAD: ((150.0, 380.0), (200.0, 2500.0)),
    VISCOSITY: ((120.0, 262.0), (0.02, 20.0)),
}
"""Speeds and values of each map's second panel."""

PAPER_SPEEDS, PAPER_SPEED = (100.0, 500.0), 360.0
"""Range of the paper's frequency plots and speed of its time histories, rev/min."""

DOUBLED = "tab:orange"


def drawn(second: str) -> Figure:
    """The whole map over one second parameter, and what lies about the resonance in it."""
    figure, (left, right) = panels(1, 2, height=4.2, gridspec_kw={"width_ratios": (3, 2)})
    for axes in (left, right):
        _regions(axes, second)
        _points(axes, second)
        axes.set(xlabel="speed (rev/min)")
        if second != AMPLITUDE:
            axes.set_yscale("log")
    low, high = (value / UNITS[second] for value in RANGES[second])
    left.set(xlim=SPEEDS[second], ylim=(0 if second == AMPLITUDE else low, high), ylabel=AXES[second])
    right.set(xlim=ZOOM[second][0], ylim=ZOOM[second][1])
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=8)
    return figure


def _regions(axes: Any, second: str) -> None:
    pair = [_curve(curve, second) for curve in folds(second)]
    _fill(axes, pair, TRUSTED, "two motions of one period")
    for x, y in pair:
        axes.plot(x, y, color=TRUSTED, linewidth=1.2)
    if second == VISCOSITY:
        x, y = _curve(half(second), second)
        _fill(axes, [(x, y)], SECOND, "two motions of one period (2:1)")
        axes.plot(x, y, color=SECOND, linewidth=1.2)
    tongue = [_curve(curve, second) for curve in doublings(second)]
    _fill(axes, tongue, PAPER, "motion of one period unstable")
    for x, y in tongue:
        axes.plot(x, y, color=PAPER, linewidth=1.0)
    x, y = _curve(doubled_folds(second), second)
    axes.plot(x, y, color=DOUBLED, linewidth=1.4, label="fold of the motions of two periods")
    for curve in [*folds(second), *([half(second)] if second == VISCOSITY else [])]:
        for cusp in curve.labelled(Label.CUSP):
            speed = Value("speed")(system(SCENE), cusp.orbit) / RPM
            axes.plot(speed, cusp.parameter / UNITS[second], "kv", markersize=6)


def _points(axes: Any, second: str) -> None:
    if second == PRELOAD:
        x, y = _curve(peaks(second), second)
        axes.plot(x, y, "k:", linewidth=1.2, label="x peak to peak largest")
        x, y = _curve(level(), second)
        axes.plot(x, y, "k--", linewidth=0.9, label="x peak to peak 10 µm")
    values = {
        AMPLITUDE: [nominal(SCENE)[AMPLITUDE] / MICRO],
        PRELOAD: [810.0, 2100.0],
        VISCOSITY: [nominal(SCENE)[VISCOSITY], as_thin_as(OTHER_OIL)],
    }[second]
    for value in values:
        axes.plot(PAPER_SPEEDS, (value, value), "-", color="0.35", linewidth=1.0)
        axes.plot(PAPER_SPEED, value, "o", color="k", markersize=5)
    axes.plot([], [], "-o", color="0.35", markerfacecolor="k", label="speeds of the paper; 360 rev/min")


def _curve(curve: Branch, second: str) -> tuple[Array, Array]:
    """Speed in rev/min and the second parameter in the axis's unit, smooth between the points."""
    return smooth(curve.column("speed") / RPM, curve.column(second) / UNITS[second])


def _fill(axes: Any, curves: list[tuple[Array, Array]], color: str, label: str) -> None:
    """Shade what lies between two curves, or inside one that turns."""
    rising = [(x, y) if y[0] < y[-1] else (x[::-1], y[::-1]) for x, y in curves]
    if len(rising) == 1:
        x, y = curves[0]
    else:
        (ax, ay), (bx, by) = rising
        x, y = np.append(ax, bx[::-1]), np.append(ay, by[::-1])
    axes.fill(x, y, color=color, alpha=0.25, linewidth=0, label=label)
