"""What the paper could not see: whole branches, loss of contact, damping along them, doubled orbits."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import periodic
from periodic import Label, Orbit, Point
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.paper.branches.doubled import KNOCKED, SCENE, doubled, knocked, small, speeds
from reports.studies.paper.branches.stiffness import WAVES
from reports.studies.paper.common.discs import LOST, LUBRICATED, MICRO, TITLES
from reports.studies.paper.common.figures import COLOURS, SPEED, SWING, curve, legend, mark, outer
from reports.studies.paper.common.scenes import nominal, system
from reports.studies.paper.common.tracing import at_speed, branch, lost_from, xy
from reports.studies.paper.marching.equivalent import exponents, ratio
from symbolic.arrays import Array
from symbolic.motion.linear import modes
from symbolic.scenes.axes import RPM

AT = (360.0, 288.0, 260.0, 245.0)
"""Speeds of the labelled orbits, rev/min, beside the upper fold."""

WORDS = {
    "A": "smooth, the paper's own speed",
    "B": "just above the first loss of contact",
    "C": "contact lost in every cycle, stable",
    "D": "upper fold",
    "E": "between the folds",
    "F": "lower sheet",
}


@cache
def labelled() -> dict[str, Point]:
    """Return six orbits along the branch of oil A at 810 N, by letter."""
    found = branch(SCENE, at=AT)
    a, b, c, (_, e, f) = (at_speed(found, rpm) for rpm in AT)
    return dict(zip(WORDS, (*a, *b, *c, found.labelled(Label.FOLD)[0], e, f), strict=True))


def along(orbit: Orbit, count: int = 2001, periods: int = 1) -> tuple[Array, dict[str, Array]]:
    """Return phases over excitation periods and the outputs there (SI) by name, each (count,)."""
    tau = np.linspace(0, 2 * np.pi * periods, count)
    names = [output.name for output in system(SCENE).outputs]
    return tau, dict(zip(names, periodic.outputs(system(SCENE), orbit, tau).T, strict=True))


def return_phase(point: Point) -> float:
    """Return the phase (rad) in which the load rises from LOST of the preload to the preload itself.

    Of the rise that follows the least load; the orbit must lose contact. To 3e-4 rad.
    """
    tau, values = along(point.orbit, 20001)
    load = values["load"][:-1]
    load = np.roll(load, -int(np.argmin(load))) / nominal(SCENE)["preload"]
    risen = int(np.argmax(load >= 1))
    left = int(np.flatnonzero(load[:risen] < LOST)[-1])
    return float((risen - left) * tau[1])


def damping(name: str) -> list[tuple[float, float]]:
    """Return x peak to peak (m) of the orbits from 500 rev/min down, and the damping ratio of each.

    It is that of small free motion about the orbit, mu = exp(lambda T), zeta = -Re(lambda)/|lambda|, with the
    imaginary part continued from the linear one. It ends where the multipliers become real or unstable.
    """
    rest = modes(system(name), {"speed": 500 * RPM})
    found = exponents(branch(name), rest, lambda point: 2 * np.pi / (WAVES * point.parameter))
    return [(point.peak_to_peak("x"), ratio(value)) for point, value in found]


def numbers() -> dict[str, float]:
    """Return the section's key numbers."""
    found: dict[str, float] = {}
    for name in LUBRICATED:
        for k, fold in enumerate(branch(name).labelled(Label.FOLD), 1):
            found[f"{name} fold {k} rpm"] = fold.parameter / RPM
            found[f"{name} fold {k} x um"] = fold.peak_to_peak("x") / MICRO
        found[f"{name} contact lost below rpm"] = lost_from(name)
        for k, speed in enumerate(speeds(small(name), Label.DOUBLING), 1):
            found[f"{name} doubling {k} rpm"] = speed
    (fold_speed,) = speeds(doubled(), Label.FOLD)
    x = knocked().state[:, 0] * system(SCENE).states[0].scale
    (smallest, first), *_, (largest, last) = damping(SCENE)
    return found | {
        "load back within rad": max(return_phase(labelled()[letter]) for letter in "CDE"),
        "doubled orbits fold rpm": fold_speed,
        f"doubled orbit at {KNOCKED:g} rpm x um": doubled()[0].peak_to_peak("x") / MICRO,
        f"simulated motion at {KNOCKED:g} rpm x um": float(np.ptp(x)) / MICRO,
        f"small orbit at {KNOCKED:g} rpm x um": branch(SCENE)[0].peak_to_peak("x") / MICRO,
        "smallest orbit um": smallest / MICRO,
        "largest orbit um": largest / MICRO,
        "damping of the smallest orbit": first,
        "damping of the largest orbit": last,
    }


def rows() -> list[dict[str, Any]]:
    """Return what the table of the six orbits says."""
    return [
        {
            "letter": letter,
            "rpm": point.parameter / RPM,
            "um": point.peak_to_peak("x") / MICRO,
            "least_N": point.minimum["load"],
            "largest_N": point.maximum["load"],
            "multiplier": float(abs(point.multipliers[0])),
            "words": WORDS[letter],
        }
        for letter, point in labelled().items()
    ]


def compute(tell: Tell) -> Found:
    """Trace whole branches and orbits of two periods, and look along them."""
    tell("traces of the four discs")
    figures = {"unseen-branches": _whole(), "unseen-damping": _damping()}
    tell("orbits of two periods")
    figures |= {"unseen-doubled": _two_periods(), "unseen-doubled-motion": _motion()}
    tell("orbits along the branch")
    figures["unseen-orbits"] = _six()
    return Found(numbers=numbers(), rows=rows(), figures=figures)


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the discs' titles and how many folds each has."""
    n = kept.numbers
    count = {name: sum(f"{name} fold {k} rpm" in n for k in range(1, 9)) for name in TITLES}
    return {"titles": TITLES, "folds": {name: range(1, 1 + k) for name, k in count.items()}}


SECTION = Section(title="What the paper could not see", compute=compute, context=context)


PERIODS = "excitation periods"


def _whole() -> Figure:
    """Four whole branches, with folds and with what loses contact marked."""
    figure, axes = panels(2, 2, height=2.8, sharex=True)
    for panel, name in zip(axes.flat, LUBRICATED, strict=True):
        found = branch(name)
        speed, swing = xy(found)
        curve(panel, found, TRUSTED, ("stable", "unstable"), linewidth=1.8)
        lost = np.array([p.minimum["load"] < LOST * nominal(name)["preload"] for p in found])
        panel.plot(speed[lost], swing[lost], ".", color=PAPER, markersize=3, label="contact lost")
        for fold in found.labelled(Label.FOLD):
            at = fold.parameter / RPM, fold.peak_to_peak("x") / MICRO
            panel.plot(*at, "ko", markersize=4)
            panel.annotate(f"{at[0]:.1f}", at, xytext=(-4, 4), textcoords="offset points", ha="right")
        panel.set(title=TITLES[name], xlim=(100, 500), ylim=(0, 1.12 * swing.max()))
    legend(figure, axes[0, 0])
    outer(axes, SPEED, SWING)
    return figure


def _six() -> Figure:
    """Six orbits: where they lie, x, film and load over a period, and the phase portrait."""
    figure, axes = panels(3, 2, height=2.7)
    place, x_axes, film_axes, load_axes, portrait, zoom = axes.flat
    curve(place, branch(SCENE, at=AT), "0.6", linewidth=1.8)
    for (letter, point), color in zip(labelled().items(), COLOURS, strict=True):
        tau, values = along(point.orbit)
        at, turn = (point.parameter / RPM, point.peak_to_peak("x") / MICRO), tau / (2 * np.pi)
        place.plot(*at, "o", color=color, markersize=5)
        place.annotate(letter, at, xytext=(5, 3), textcoords="offset points", color=color)
        style = "-" if point.stable or point.label is Label.FOLD else "--"
        rate = np.gradient(values["x"], tau) * point.parameter * 120
        x, load = values["x"] / MICRO, values["load"]
        x_axes.plot(turn, x, style, color=color, label=f"{letter}  {at[0]:.1f} rev/min")
        film_axes.plot(turn, values["film"] / MICRO, style, color=color)
        load_axes.semilogy(turn, np.maximum(load, 1e-30), style, color=color)
        portrait.plot(x, rate * 1e3, style, color=color)
        zoom.plot(turn, load / 1e3, style, color=color)
    place.set(xlabel=SPEED, ylabel=SWING, xlim=(200, 400))
    x_axes.set(xlabel=PERIODS, ylabel="x (µm)")
    film_axes.set(xlabel=PERIODS, ylabel="film (µm)")
    load_axes.set(xlabel=PERIODS, ylabel="load (N)", ylim=(1e-24, 1e5))
    portrait.set(xlabel="x (µm)", ylabel="dx/dt (mm/s)")
    zoom.set(xlabel=PERIODS, ylabel="load (kN)")
    legend(figure, x_axes)
    return figure


def _damping() -> Figure:
    """Damping ratio of free motion about the orbits against their size."""
    figure, axes = panels(1, 1, height=3.2)
    for name, color in zip(LUBRICATED, COLOURS, strict=False):
        swing, ratios = np.array(damping(name)).T
        axes.semilogy(swing / MICRO, ratios, ".-", color=color, label=TITLES[name])
    axes.set(xlabel="x peak to peak of the orbit (µm)", ylabel="damping ratio ζ from the multipliers")
    axes.legend(loc="lower right")
    return figure


def _two_periods() -> Figure:
    """The orbits of one and of two periods about twice the natural speed."""
    figure, axes = panels(1, 1, height=3.4)
    curve(axes, branch(SCENE), TRUSTED, linewidth=1.8)
    curve(axes, small(), TRUSTED, ("one period", "one period, unstable"), linewidth=1.8)
    curve(axes, doubled(), PAPER, ("two periods", "two periods, unstable"), linewidth=1.8)
    mark(axes, doubled())
    mark(axes, small())
    axes.plot([], [], "ko", markersize=4, label="fold")
    axes.plot([], [], "kD", markersize=4, label="period doubling")
    height = doubled()[0].peak_to_peak("x") / MICRO
    axes.plot(500, height, "^", color=SECOND, label="time integration after a knock")
    axes.set(xlabel=SPEED, ylabel=SWING, xlim=(430, 640), ylim=(0, None))
    axes.legend(loc="upper right")
    return figure


def _motion() -> Figure:
    """The doubled orbit at 500 rev/min over its two periods."""
    figure, both = panels(1, 2, height=2.6)
    tau, values = along(doubled()[0].orbit, periods=2)
    shown = (values["x"] / MICRO, "x (µm)"), (values["load"] / 1e3, "load (kN)")
    for axes, (up, label) in zip(both, shown, strict=True):
        axes.plot(tau / (2 * np.pi), up, color=TRUSTED)
        axes.set(xlabel=PERIODS, ylabel=label)
    return figure
