"""Figures of what the paper could not see."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from periodic import Branch, Label, Point
from reports.curve import draw_curve, solid
from reports.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.paper.contact import LOST
from reports.view import MICRO, RPM

Array = NDArray[np.float64]
COLORS = ("tab:blue", "tab:orange", "tab:green", "tab:red", "tab:purple", "tab:brown")
TITLES = {
    "vitrea79-810N": "Vitrea 79, 810 N",
    "vitrea79-2100N": "Vitrea 79, 2100 N",
    "turbo33-810N": "Turbo 33, 810 N",
    "turbo33-2100N": "Turbo 33, 2100 N",
}


def _xy(branch: Branch) -> tuple[Array, Array]:
    return branch.values / RPM, branch.peak_to_peak("x") / MICRO


def branches(found: Mapping[str, Branch]) -> Figure:
    """Four whole branches, with folds and with what loses contact marked."""
    figure, axes = panels(2, 2, height=2.8, sharex=True)
    for panel, (name, branch) in zip(axes.flat, found.items(), strict=True):
        speed, swing = _xy(branch)
        draw_curve(panel, speed, swing, solid(branch), color=TRUSTED)
        preload = float(name.rpartition("-")[2].removesuffix("N"))
        lost = np.array([p.minimum["load"] < LOST * preload for p in branch])
        panel.plot(speed[lost], swing[lost], ".", color=PAPER, markersize=3, label="contact lost")
        for fold in branch.labelled(Label.FOLD):
            at = fold.parameter / RPM, fold.peak_to_peak("x") / MICRO
            panel.plot(*at, "ko", markersize=4)
            panel.annotate(f"{at[0]:.1f}", at, xytext=(-4, 4), textcoords="offset points", ha="right")
        panel.set(title=TITLES[name], xlim=(100, 500), ylim=(0, 1.12 * swing.max()))
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    for panel in axes[1]:
        panel.set_xlabel("speed (rev/min)")
    for panel in axes[:, 0]:
        panel.set_ylabel("x peak to peak (µm)")
    return figure


def orbits(branch: Branch, found: Mapping[str, tuple[Point, Array, Array]], names: list[str]) -> Figure:
    """Six orbits: where they lie, x, film and load over a period, and the phase portrait."""
    figure, axes = panels(3, 2, height=2.7)
    place, x_axes, film_axes, load_axes, portrait, zoom = axes.flat
    draw_curve(place, *_xy(branch), solid(branch), color="0.6", labels=("", ""))
    for (letter, (point, tau, values)), color in zip(found.items(), COLORS, strict=True):
        at = point.parameter / RPM, point.peak_to_peak("x") / MICRO
        place.plot(*at, "o", color=color, markersize=5)
        place.annotate(letter, at, xytext=(5, 3), textcoords="offset points", color=color)
        turn = tau / (2 * np.pi)
        x, film, load = (values[:, names.index(name)] for name in ("x", "film", "load"))
        style = "-" if point.stable or point.label is Label.FOLD else "--"
        label = f"{letter}  {at[0]:.1f} rev/min"
        x_axes.plot(turn, x / MICRO, style, color=color, label=label)
        film_axes.plot(turn, film / MICRO, style, color=color)
        load_axes.semilogy(turn, np.maximum(load, 1e-30), style, color=color)
        rate = np.gradient(x, tau) * point.parameter * 120
        portrait.plot(x / MICRO, rate * 1e3, style, color=color)
        zoom.plot(turn, load / 1e3, style, color=color)
    place.set(xlabel="speed (rev/min)", ylabel="x peak to peak (µm)", xlim=(200, 400))
    x_axes.set(xlabel="excitation periods", ylabel="x (µm)")
    film_axes.set(xlabel="excitation periods", ylabel="film (µm)")
    load_axes.set(xlabel="excitation periods", ylabel="load (N)", ylim=(1e-24, 1e5))
    portrait.set(xlabel="x (µm)", ylabel="dx/dt (mm/s)")
    zoom.set(xlabel="excitation periods", ylabel="load (kN)")
    figure.legend(*x_axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def damping(found: Mapping[str, list[tuple[float, float]]]) -> Figure:
    """Damping ratio of free motion about the orbits against their size."""
    figure, axes = panels(1, 1, height=3.2)
    for (name, curve), color in zip(found.items(), COLORS, strict=False):
        swing, ratio = np.array(curve).T
        axes.semilogy(swing / MICRO, ratio, ".-", color=color, label=TITLES[name])
    axes.set(xlabel="x peak to peak of the orbit (µm)", ylabel="damping ratio ζ from the multipliers")
    axes.legend(loc="lower right")
    return figure


def doubled(small: Branch, found: Branch, main: Branch) -> Figure:
    """The orbits of one and of two periods about twice the natural speed."""
    figure, axes = panels(1, 1, height=3.4)
    draw_curve(axes, *_xy(main), solid(main), color=TRUSTED, labels=("", ""))
    draw_curve(axes, *_xy(small), solid(small), color=TRUSTED, labels=("one period", "one period, unstable"))
    draw_curve(axes, *_xy(found), solid(found), color=PAPER, labels=("two periods", "two periods, unstable"))
    for label, marker in ((Label.FOLD, "o"), (Label.DOUBLING, "D")):
        points = [*found.labelled(label), *(small.labelled(label) if label is Label.DOUBLING else ())]
        across = [p.parameter / RPM for p in points]
        up = [p.peak_to_peak("x") / MICRO for p in points]
        name = "fold" if label is Label.FOLD else "period doubling"
        axes.plot(across, up, marker, color="k", markersize=4, label=name)
    height = found[0].peak_to_peak("x") / MICRO
    axes.plot(500, height, "^", color=SECOND, label="time integration after a knock")
    axes.set(xlabel="speed (rev/min)", ylabel="x peak to peak (µm)", xlim=(430, 640), ylim=(0, None))
    axes.legend(loc="upper right")
    return figure


def motion(found: tuple[Array, Array], names: list[str]) -> Figure:
    """The doubled orbit at 500 rev/min over its two periods."""
    tau, values = found
    figure, (left, right) = panels(1, 2, height=2.6)
    left.plot(tau / (2 * np.pi), values[:, names.index("x")] / MICRO, color=TRUSTED)
    left.set(xlabel="excitation periods", ylabel="x (µm)")
    right.plot(tau / (2 * np.pi), values[:, names.index("load")] / 1e3, color=TRUSTED)
    right.set(xlabel="excitation periods", ylabel="load (kN)")
    return figure
