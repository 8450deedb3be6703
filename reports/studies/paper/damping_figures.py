"""The figures on linear damping."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.paper.branches.causes import PAPER_A, PAPER_B
from reports.studies.paper.common.discs import MICRO, OIL_A, OIL_B
from reports.studies.paper.common.figures import SPEED, SWING, curve
from reports.studies.paper.common.scenes import at_paper_speed, system
from reports.studies.paper.common.tracing import branch, xy
from reports.studies.paper.marching.equivalent import LARGE, ONE, SMALL, orbit_exponents, ratio
from reports.studies.paper.marching.transients import (
    Window,
    crests,
    free_decay,
    free_decay_of,
    record,
    within,
)
from symbolic.motion.frequencyresponse import response
from symbolic.motion.linear import resonance
from symbolic.scenes.axes import RPM

OILS = {OIL_A: "oil A (Vitrea 79)", OIL_B: "oil B (Turbo 33)"}
COLOUR = {OIL_A: TRUSTED, OIL_B: SECOND}
MS = 1e-3

SIZES = (0.05, 0.2, 0.5, 1, 1.5, 2, 3, 4, 5, 6, 7, 7.5, 8, 8.5, 9, 9.5, 10, 11, 12, 13, 14, 16, 18)
"""Compressions (µm) from which the discs are let go."""


def transients() -> Figure:
    """Draw the records of both oils, and what is left of them without the steady motion."""
    figure, axes = panels(2, 2, width=9.0, height=2.8)
    _record(axes[0, 0], OIL_A, (0.0, 0.09), "(a) oil A, 0 to 90 ms")
    _record(axes[0, 1], OIL_B, (0.95, 1.0), "(b) oil B, 950 to 1000 ms")
    _fit(axes[1, 0], OIL_A, (0.0, 0.14), PAPER_A, "(c) oil A, free motion")
    _fit(axes[1, 1], OIL_B, (0.0, 1.0), PAPER_B, "(d) oil B, free motion")
    for panel in axes.flat:
        panel.set_xlabel("time (ms)")
        panel.margins(x=0)
    return figure


def _record(axes: Any, name: str, window: Window, title: str) -> None:
    run = record(name)
    chosen = within(window, run.time)
    axes.plot(run.time[chosen] / MS, run.x[chosen] / MICRO, color=COLOUR[name], linewidth=0.7, label="x")
    steady = (run.x - run.free)[chosen] / MICRO
    for level, label in ((steady.max(), "steady motion"), (steady.min(), "_")):
        axes.axhline(level, color="black", linewidth=0.9, linestyle="--", label=label)
    axes.set(ylabel="x (µm)", title=title, ylim=(-7.9, 7.9))
    axes.legend(loc="upper right", ncols=2)


def _fit(axes: Any, name: str, window: Window, paper: float, title: str) -> None:
    run, fit = record(name), free_decay_of(name)
    chosen = within(window, run.time)
    time = run.time[chosen]
    at, heights = crests(time, np.abs(run.free[chosen]))
    dots = {"markersize": 2, "color": COLOUR[name], "label": "crests of |x - steady|"}
    axes.semilogy(at / MS, heights / MICRO, ".", **dots)
    theirs = fit.size * np.exp(-paper * fit.frequency * time)
    for line, style, color, label in (
        (fit.envelope(time), "-", "black", f"fit 0 to 90 ms: ζ = {fit.ratio:.3g}"),
        (theirs, "--", PAPER, f"paper: ζ = {paper:g}"),
    ):
        axes.semilogy(time / MS, line / MICRO, style, color=color, linewidth=1, label=label)
    axes.set(ylabel="free motion (µm)", title=title)
    axes.legend(loc="lower left")


def amplitudes() -> Figure:
    """Draw the damping ratio against the size of the motion."""
    figure, axes = panels(1, 1, width=7.5, height=4.2)
    for name, oil in OILS.items():
        free = [free_decay(name, size * MICRO) for size in SIZES]
        orbits = [(point.peak_to_peak("x"), ratio(value)) for point, value in orbit_exponents(name)]
        fits = [(np.ptp(record(name, k).x), free_decay_of(name, k).ratio) for k in (SMALL, ONE, LARGE)]
        for found, style, label in (
            (free, "-", "free decay"),
            (orbits, "-.", "about forced orbits"),
            (fits, "o", "fits of transients"),
        ):
            swings, ratios = np.array(found).T
            look = {"color": COLOUR[name], "markersize": 5, "label": f"{oil}: {label}"}
            axes.loglog(swings / MICRO, ratios, style, **look)
        axes.axhline(at_paper_speed(name).damping_ratios[0], color=COLOUR[name], linestyle=":", linewidth=1)
    for value, oil in ((PAPER_A, "A"), (PAPER_B, "B")):
        axes.axhline(value, color=PAPER, linestyle="--", linewidth=1)
        axes.annotate(f"paper, oil {oil}: {value:g}", (0.09, value), color=PAPER, va="bottom", fontsize=8)
    axes.set(xlabel=SWING, ylabel="damping ratio ζ", xlim=(0.08, 50), ylim=(1e-4, 1))
    axes.legend(loc="upper left", ncols=2)
    return figure


def responses() -> Figure:
    """Draw the linear response beside the nonlinear branch."""
    figure, axes = panels(1, 2, width=9.0, height=3.4, sharey=True)
    for place, (name, oil) in zip(axes, OILS.items(), strict=True):
        meeting = resonance(system(name), "speed", (100 * RPM, 500 * RPM))
        speeds = np.unique(np.append(np.linspace(100, 500, 801), [] if meeting is None else meeting / RPM))
        linear = response(system(name), "speed", speeds * RPM).peak_to_peak("x") / MICRO
        place.semilogy(speeds, linear, color="black", linewidth=1, linestyle=":", label="linear")
        curve(place, branch(name), COLOUR[name], ("stable orbits", "unstable orbits"))
        place.plot(*xy(branch(name)), ".", markersize=3, color=COLOUR[name])
        place.set(xlabel=SPEED, title=oil, ylim=(0.8, 400), xlim=(100, 500))
        place.legend(loc="upper right")
    axes[0].set_ylabel(SWING)
    return figure
