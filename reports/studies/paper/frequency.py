"""The frequency domain: amplitude against speed (Figs. 9 and 10) and against preload (Figs. 12a and 12b)."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from periodic import Label
from periodic.results.plots.curve import draw_curve
from reports.studies.pages.content import Found, Section, Tell
from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.paper.branches import preload, resonance
from reports.studies.paper.common.discs import HEAVY, MICRO, OIL_A, OIL_B, RPM_SHOWN, TITLES
from reports.studies.paper.common.figures import SPEED, SWING, curve, legend, mark
from reports.studies.paper.common.scenes import system
from reports.studies.paper.common.tracing import branch, shown

PARTS = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
"""Parts of the paper's waviness whose highest points make the backbone."""

SPEED_810, SPEED_2100 = 275.0, 325.0
"""Resonance speeds that the paper reads off its plots (rows P8 and P9), rev/min."""


def numbers() -> dict[str, float]:
    """Return the section's key numbers."""
    found: dict[str, float] = {}
    for name in (OIL_A, OIL_B, HEAVY):
        rpm, swing = resonance.highest(system(name), branch(name))
        found |= {
            f"{name} natural speed rpm": resonance.natural_speed(system(name)),
            f"{name} linear peak rpm": resonance.linear_peak(name),
            f"{name} branch peak rpm": rpm,
            f"{name} branch peak um": swing / MICRO,
            f"{name} x at 360 rpm um": shown(name, RPM_SHOWN).peak_to_peak("x") / MICRO,
        }
    for speed in preload.SPEEDS:
        for label, word in ((Label.FOLD, "fold"), (Label.DOUBLING, "doubling")):
            points = preload.branch(speed).labelled(label)
            found |= {f"preload {word} {i} at {speed:g} rpm N": p.parameter for i, p in enumerate(points, 1)}
        low, _, sign = preload.trend(speed)
        found |= {f"contact kept down to at {speed:g} rpm N": low, f"sign of dx/dQ at {speed:g} rpm": sign}
    return found


def meeting() -> dict[str, float]:
    """Return how far continuation in preload and in speed differ at their common points, relative."""
    return {
        f"{speed:g} rev/min, {force:g} N": preload.disagreement(speed, force)
        for speed in preload.SPEEDS
        for force in preload.COMMON
    }


def compute(tell: Tell) -> Found:
    """Trace in speed and in preload."""
    tell("traces in speed")
    figures = {
        "frequency-810N": _in_speed((OIL_A, OIL_B), SPEED_810, 3.9),
        "frequency-2100N": _in_speed((HEAVY,), SPEED_2100, 14.5),
    }
    tell("traces in preload")
    figures["frequency-preload"] = _in_preload()
    meets = [{"where": where, "difference": value} for where, value in meeting().items()]
    return Found(numbers=numbers(), rows=meets, figures=figures)


SECTION = Section(title="Frequency domain: Figs. 9, 10 and 12", compute=compute)


def _in_speed(names: tuple[str, ...], reported: float, swing: float) -> Figure:
    figure, axes = panels(1, 1, height=4.4)
    for name, color in zip(names, (TRUSTED, SECOND), strict=False):
        labels = (f"{TITLES[name]}, stable", f"{TITLES[name]}, unstable")
        curve(axes, branch(name), color, labels, linewidth=1.8)
        spine = np.array(resonance.backbone(name, PARTS))
        axes.plot(spine[:, 0], spine[:, 1] / MICRO, ":", color=color, marker=".", linewidth=1.0)
        mark(axes, branch(name), color=color)
    axes.plot([], [], "k:.", linewidth=1.0, label="highest points at 0 to 100 % of the waviness")
    axes.axvline(reported, color=PAPER, linewidth=1.0, label=f"paper's resonance, about {reported:g} rev/min")
    axes.plot(RPM_SHOWN, swing, "x", color=PAPER, markersize=8, label="paper at 360 rev/min")
    axes.set(xlabel=SPEED, ylabel=SWING, xlim=(100, 500), ylim=(0, None))
    legend(figure, axes, ncols=2)
    return figure


def _in_preload() -> Figure:
    figure, both = panels(1, 2, height=3.2)
    for axes, speed, name in zip(both, preload.SPEEDS, "ab", strict=True):
        found = preload.branch(speed)
        draw_curve(axes, found.values, found.peak_to_peak("x") / MICRO, found.stable_between, color=TRUSTED)
        mark(axes, found, 1.0, TRUSTED)
        common = [(p.parameter, p.peak_to_peak("x") / MICRO) for p in found.labelled(Label.USER)]
        rings = {"color": SECOND, "markerfacecolor": "none", "label": "also traced in speed"}
        axes.plot(*np.array(common).T, "o", **rings)
        if speed == RPM_SHOWN:
            axes.plot([810, 2100], [3.9, 14.5], "x", color=PAPER, markersize=8, label="paper (P5, P6)")
        axes.set(xlabel="preload (N)", xlim=(0, 2600), ylim=(0, None), title=f"({name}) {speed:g} rev/min")
        axes.legend(loc="upper right" if speed == 200.0 else "upper left")
    both[0].set_ylabel(SWING)
    return figure
