"""Figures of the section on the paper's method."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from periodic import Branch
from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.paper.common.discs import LOST, LUBRICATED, MICRO, OIL_A, TITLES
from reports.studies.paper.common.figures import SPEED, SWING, curve, legend, outer
from reports.studies.paper.common.scenes import nominal
from reports.studies.paper.marching.breakdown import Band, Outcome, film_rate, real_limit, step_limit
from reports.studies.paper.marching.histories import History, stepped, trusted
from symbolic.arrays import Array
from symbolic.scenes.axes import RPM

COLOURS = {
    Outcome.SETTLED: "#7fb77e",
    Outcome.UNSETTLED: "#cfe3a4",
    Outcome.WRONG: "#f2c879",
    Outcome.UNLOADED: "#c0392b",
    Outcome.DEFLECTION: "#c0392b",
    Outcome.FILM: "#8e44ad",
    Outcome.LOAD: "#34495e",
    Outcome.UNSTABLE: "#8d8d8d",
}


def maps(found: Sequence[Band]) -> Figure:
    """Outcome over speed and step, one panel for each disc."""
    figure, axes = panels(2, 2, height=2.3, sharex=True, sharey=True)
    order = list(COLOURS)
    steps = sorted({band.step for band in found}, reverse=True)
    for panel, name in zip(axes.flat, LUBRICATED, strict=True):
        rows = [band for step in steps for band in found if band.name == name and band.step == step]
        codes = np.array([[order.index(o) for o in band.outcome] for band in rows])
        speeds, lines = rows[0].speeds, np.arange(len(rows) + 1)
        half = (speeds[1] - speeds[0]) / 2
        edges = np.append(speeds - half, speeds[-1] + half)
        colours = ListedColormap(list(COLOURS.values()))
        panel.pcolormesh(edges, lines, codes, cmap=colours, vmin=-0.5, vmax=len(order) - 0.5)
        panel.hlines(lines[1:-1], edges[0], edges[-1], color="white", lw=1)
        panel.set_yticks(lines[:-1] + 0.5, [f"{step * 1e3:g}" for step in steps])
        panel.set_title(f"Shell {TITLES[name]}", fontsize=9)
        panel.grid(False)
    outer(axes, SPEED, "step (ms)")
    seen = {outcome for band in found for outcome in band.outcome}
    keys = [Patch(color=COLOURS[o], label=o.value) for o in order if o in seen]
    figure.legend(handles=keys, loc="outside lower center", ncols=2, fontsize=8)
    return figure


def responses(
    found: Mapping[str, Band],
    branches: Mapping[str, Branch],
    settled: Mapping[str, Sequence[tuple[float, float]]],
) -> Figure:
    """x p-p over speed: the branch, what the paper's method and step gives, and where it gives nothing."""
    figure, axes = panels(2, 2, height=2.6, sharex=True)
    for panel, name in zip(axes.flat, LUBRICATED, strict=True):
        curve(panel, branches[name], TRUSTED, ("branch, stable", "branch, unstable"))
        _stepped(panel, found[name])
        for rpm, height in settled.get(name, ()):
            panel.plot(rpm, height / MICRO, "x", color=SECOND, ms=5)
        panel.set_title(f"Shell {TITLES[name]}", fontsize=9)
        panel.set_ylim(bottom=0)
    first = axes[0, 0]
    first.plot([], [], "x", color=SECOND, ms=5, label="CVODES, same start")
    first.fill_between([], [], [], color=PAPER, alpha=0.15, label="paper's method fails")
    outer(axes, SPEED, SWING)
    legend(figure, first)
    return figure


def _stepped(panel: Any, band: Band) -> None:
    """Draw the amplitudes that the method gives, and shade the speeds at which it fails."""
    settled = np.array([outcome is Outcome.SETTLED for outcome in band.outcome])
    swing, style = band.swing / MICRO, {"color": PAPER, "ls": "none"}
    done, going = np.where(settled, swing, np.nan), np.where(settled, np.nan, swing)
    panel.plot(band.speeds, done, ".", ms=4, label="paper's method, settled", **style)
    panel.plot(band.speeds, going, "o", ms=3, mfc="white", label="not settled after 1 s", **style)
    half = (band.speeds[1] - band.speeds[0]) / 2
    for rpm in band.speeds[[outcome.failure for outcome in band.outcome]]:
        panel.axvspan(rpm - half, rpm + half, color=PAPER, alpha=0.15, lw=0)


def breakdown_at(rpm: float, name: str = OIL_A, end: float = 8e-3) -> Figure:
    """Load and exponent gamma dh/dt over the first ms, by CVODES and by two steps until they fail."""
    figure, axes = panels(2, 1, height=2.2, sharex=True)
    dots = {"ls": "none", "ms": 3}
    for history, label, style in (
        (trusted(name, 0.01, rpm, samples=960).during(0, end), "CVODES", {"color": TRUSTED, "lw": 1.2}),
        (stepped(name, end, rpm), "Runge-Kutta, 0.1 ms", {"color": PAPER, "marker": "o", **dots}),
        (stepped(name, end, rpm, 1e-5), "Runge-Kutta, 0.01 ms", {"color": SECOND, "marker": ".", **dots}),
    ):
        load = np.where(history.load > 0, history.load, np.nan) / nominal(name)["preload"]
        axes[0].semilogy(history.time * 1e3, load, label=label, **style)
        axes[1].plot(history.time * 1e3, exponent(history, name), **style)
    axes[0].axhline(LOST, color="0.5", lw=0.8, ls="--")
    axes[0].set(ylabel="load W/Q", ylim=(1e-12, 20))
    axes[1].set(ylabel="γ dh/dt", xlabel=f"time (ms), {rpm:g} rev/min", ylim=(-20, 75))
    legend(figure, axes[0], "upper")
    return figure


def exponent(history: History, name: str) -> Array:
    """Return gamma dh/dt = -ln(W/Q) - beta ln(h/h0), eq. (13), along a history."""
    preload, beta = nominal(name)["preload"], nominal(name)["beta"]
    with np.errstate(all="ignore"):
        value = -np.log(history.load / preload) - beta * np.log(history.film / history.film[0])
    return np.where(np.isfinite(value), value, np.nan)


def limits(branches: Mapping[str, Branch], step: float) -> Figure:
    """Longest stable step over speed: at rest, and where the load is least on the periodic orbits."""
    figure, axes = panels(1, 2, height=3.2, sharex=True)
    colours, speeds = (TRUSTED, SECOND, "tab:orange", "tab:purple"), np.arange(100.0, 501.0, 20.0)
    for name, colour in zip(LUBRICATED, colours, strict=True):
        rest = [step_limit(name, rpm) * 1e3 for rpm in speeds]
        axes[0].plot(speeds, rest, color=colour, label=f"Shell {TITLES[name]}")
        found = branches[name]
        film, deflection = (np.array([p.minimum[key] for p in found]) for key in ("film", "deflection"))
        rate = film_rate(name, film, np.maximum(deflection, 1e-300), found.values / RPM)
        axes[1].semilogy(found.values / RPM, real_limit() / rate * 1e3, color=colour, lw=1)
    for panel, title in zip(axes, ("at rest", "on the periodic orbit, at its least load"), strict=True):
        panel.axhline(step * 1e3, color=PAPER, ls="--", lw=1)
        panel.set(xlabel=SPEED, ylabel="longest stable step (ms)")
        panel.set_title(title, fontsize=9)
    axes[0].set_ylim(bottom=0)
    # Deeper down the orbits' least deflection is below what their tolerance resolves.
    axes[1].set_ylim(1e-12, 10)
    axes[0].plot([], [], color=PAPER, ls="--", lw=1, label="the paper's step")
    legend(figure, axes[0])
    return figure
