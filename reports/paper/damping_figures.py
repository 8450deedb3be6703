"""The figures on linear damping."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import periodic
from reports.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.paper.causes import OIL_A, OIL_B, PAPER_A, PAPER_B
from reports.paper.damping import OILS, PARTS, READ, ratios
from reports.paper.equivalent import at_paper_speed, orbit_exponents, ratio
from reports.paper.scenes import branch, system
from reports.paper.transients import crests, decay, free_decay, record, within
from reports.view import MICRO, RPM
from symbolic.linear import resonance
from symbolic.response import response

COLOUR = {OIL_A: TRUSTED, OIL_B: SECOND}
MS = 1e-3


def transients() -> Figure:
    """Draw the records of both oils, and what is left of them without the steady motion."""
    figure, axes = panels(2, 2, width=9.0, height=2.8)
    _record(axes[0, 0], OIL_A, (0.0, 0.09), "(a) oil A, 0 to 90 ms")
    _record(axes[0, 1], OIL_B, (0.95, 1.0), "(b) oil B, 950 to 1000 ms")
    _fit(axes[1, 0], OIL_A, (0.0, 0.14), PAPER_A, "(c) oil A, free motion")
    _fit(axes[1, 1], OIL_B, (0.0, 1.0), PAPER_B, "(d) oil B, free motion")
    return figure


def _record(axes: Any, name: str, window: tuple[float, float], title: str) -> None:
    run = record(name)
    chosen = within(window, run.time)
    axes.plot(run.time[chosen] / MS, run.x[chosen] / MICRO, color=COLOUR[name], linewidth=0.7, label="x")
    steady = (run.x - run.free)[chosen]
    axes.axhline(steady.max() / MICRO, color="black", linewidth=0.9, linestyle="--", label="steady motion")
    axes.axhline(steady.min() / MICRO, color="black", linewidth=0.9, linestyle="--")
    axes.set(xlabel="time (ms)", ylabel="x (µm)", title=title, ylim=(-7.9, 7.9))
    axes.margins(x=0)
    axes.legend(loc="upper right", ncols=2)


def _fit(axes: Any, name: str, window: tuple[float, float], paper: float, title: str) -> None:
    run = record(name)
    chosen = within(window, run.time)
    time, free = run.time[chosen], np.abs(run.free[chosen])
    at, heights = crests(time, free)
    fit = decay(run.time, run.free, READ)
    axes.semilogy(
        at / MS, heights / MICRO, ".", markersize=2, color=COLOUR[name], label="crests of |x - steady|"
    )
    label = f"fit 0 to 90 ms: ζ = {fit.ratio:.3g}"
    axes.semilogy(time / MS, fit.envelope(time) / MICRO, color="black", linewidth=1, label=label)
    theirs = fit.size * np.exp(-paper * fit.frequency * time)
    axes.semilogy(
        time / MS, theirs / MICRO, color=PAPER, linewidth=1, linestyle="--", label=f"paper: ζ = {paper:g}"
    )
    axes.set(xlabel="time (ms)", ylabel="free motion (µm)", title=title)
    axes.margins(x=0)
    axes.legend(loc="lower left")


def amplitudes() -> Figure:
    """Draw the damping ratio against the size of the motion."""
    figure, axes = panels(1, 1, width=7.5, height=4.2)
    for name, oil in OILS.items():
        colour = COLOUR[name]
        swings, decays = np.array([free_decay(name, size * MICRO) for size in _SIZES]).T
        axes.loglog(swings / MICRO, decays, color=colour, label=f"{oil}: free decay")
        orbits = [(point.peak_to_peak("x") / MICRO, ratio(value)) for point, value in orbit_exponents(name)]
        axes.loglog(*np.array(orbits).T, color=colour, linestyle="-.", label=f"{oil}: about forced orbits")
        fits = [(np.ptp(record(name, part).x) / MICRO, ratios(name).transient[part]) for part in PARTS]
        axes.loglog(*np.array(fits).T, "o", color=colour, markersize=5, label=f"{oil}: fits of transients")
        axes.axhline(at_paper_speed(name).damping_ratios[0], color=colour, linestyle=":", linewidth=1)
    for value, oil in ((PAPER_A, "A"), (PAPER_B, "B")):
        axes.axhline(value, color=PAPER, linestyle="--", linewidth=1)
        axes.annotate(f"paper, oil {oil}: {value:g}", (0.09, value), color=PAPER, va="bottom", fontsize=8)
    axes.set(xlabel="x peak to peak (µm)", ylabel="damping ratio ζ", xlim=(0.08, 50), ylim=(1e-4, 1))
    axes.legend(loc="upper left", ncols=2)
    return figure


_SIZES = (0.05, 0.2, 0.5, 1, 1.5, 2, 3, 4, 5, 6, 7, 7.5, 8, 8.5, 9, 9.5, 10, 11, 12, 13, 14, 16, 18)
"""Compressions (µm) from which the discs are let go."""


def responses() -> Figure:
    """Draw the linear response beside the nonlinear branch."""
    figure, axes = panels(1, 2, width=9.0, height=3.4, sharey=True)
    for place, (name, oil) in zip(axes, OILS.items(), strict=True):
        meeting = resonance(system(name), "speed", (100 * RPM, 500 * RPM))
        speeds = np.unique(np.append(np.linspace(100, 500, 801), [] if meeting is None else meeting / RPM))
        linear = response(system(name), "speed", speeds * RPM).peak_to_peak("x") / MICRO
        place.semilogy(speeds, linear, color="black", linewidth=1, linestyle=":", label="linear")
        _branch(place, branch(name), COLOUR[name])
        place.set(xlabel="speed (rev/min)", title=oil, ylim=(0.8, 400), xlim=(100, 500))
        place.legend(loc="upper right")
    axes[0].set_ylabel("x peak to peak (µm)")
    return figure


def _branch(axes: Any, traced: periodic.Branch, colour: str) -> None:
    """Draw a branch: stable solid, unstable dashed."""
    across, up = traced.values / RPM, traced.peak_to_peak("x") / MICRO
    sound = np.array([p.stable or p.label is periodic.Label.FOLD for p in traced])
    solid = sound[:-1] & sound[1:]
    for chosen, style, label in ((solid, "-", "stable orbits"), (~solid, "--", "unstable orbits")):
        for begin, end in _runs(chosen):
            part = slice(begin, end + 1)
            axes.semilogy(across[part], up[part], style, marker=".", markersize=3, color=colour, label=label)
            label = "_"


def _runs(chosen: np.ndarray) -> list[tuple[int, int]]:
    """Return begin and end (points) of each run of chosen segments."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], chosen.astype(int), [0]])))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
