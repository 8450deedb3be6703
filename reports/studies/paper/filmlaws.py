"""Readings of the film law: what they give for the steady film, and what of it matters to the motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure

from periodic import Branch, Label
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import panels
from reports.studies.paper.branches import films
from reports.studies.paper.common.discs import MICRO
from reports.studies.paper.common.figures import COLOURS, SPEED, SWING, curve
from reports.studies.paper.common.tracing import at_speed, branch
from symbolic.scenes.axes import RPM

NAMES = {
    "calibrated": "calibrated to the paper's 3.85 µm (default)",
    "equation-5": "eq. (5) as printed, U* to the power 0.625",
    "constant-one-body": "K as printed, one-body modulus",
    "constant-two-body": "K as printed, two-body modulus",
    "hamrock-dowson": "Hamrock-Dowson minimum film",
}
"""What the readings are called; the keys are values of film.thickness in a scene."""

SHORT = ("calibrated", "eq. (5)", "K, one body", "K, two bodies", "Hamrock-Dowson")
"""The same in a figure's legend."""


def numbers() -> dict[str, float]:
    """Return the key numbers, those of all branches among them (rev/min, um)."""
    found = films.exponent_numbers() | films.film_for_damping()
    for name in films.READINGS:
        found |= films.reading_numbers(name) | films.fold_numbers(name, films.reading_branch(name))
        found[f"{name} second direction"] = films.directions(name)
    for floor in films.FLOORS:
        found |= films.floor_numbers(floor)
    low = films.lower_branch(1e-4).labelled(Label.FOLD)
    squeezed = at_speed(branch(films.SCENE, at=(250.0, films.TUNED_SPEED)), 250.0)
    return found | {
        "tuned orbits difference": films.tuned_difference(),
        "least log load at the upper fold": films.least_load(),
        "ambient share": films.ambient_share(),
        "floor 0.0001 lower fold rpm": low[0].parameter / RPM,
        "floor 0.0001 at 100 rpm um": films.floor_branch(1e-4)[-1].peak_to_peak("x") / MICRO,
        "calibrated at 250 rpm um": max(p.peak_to_peak("x") for p in squeezed) / MICRO,
    }


def compute(tell: Tell) -> Found:
    """Trace the disc with every reading and with every floor."""
    tell("readings of the film law")
    figures = {"filmlaws-readings": _reading_figure(), "filmlaws-floor": _floor_figure()}
    return Found(numbers=numbers(), figures=figures)


def context(kept: Kept) -> Mapping[str, Any]:
    """Return what the readings and floors are, their number of folds, and which floors have one."""
    n = kept.numbers
    folded = [floor for floor in films.FLOORS if f"floor {floor:g} fold 1 rpm" in n]
    return {
        "names": NAMES,
        "floors": films.FLOORS,
        "exponents": films.EXPONENTS,
        "folds": {key: sum(name.startswith(f"{key} fold") for name in n) // 2 for key in NAMES},
        "worst": max(n[f"{key} second direction"] for key in NAMES),
        "folded": max(folded),
        "open_ended": min(set(films.FLOORS) - set(folded)),
    }


SECTION = Section(
    title="Readings of the film law, and a film that cavitates", compute=compute, context=context
)


def _reading_figure() -> Figure:
    figure, both = panels(1, 2, height=3.6)
    for axes in both:
        for name, short, color in zip(NAMES, SHORT, COLOURS, strict=False):
            curve(axes, films.reading_branch(name), color, (short, ""))
        axes.set(xlabel=SPEED, ylabel=SWING)
    both[0].set(xlim=(100, 450), ylim=(0, None))
    both[1].set(xlim=(232, 258), ylim=(14, 30))
    both[0].legend(loc="upper right", fontsize="x-small")
    return figure


def _floor_figure() -> Figure:
    figure, axes = panels(1, 1, height=3.6)
    for floor, color in zip(films.FLOORS[2:], COLOURS, strict=False):
        _folding(axes, films.floor_branch(floor), color, f"floor {floor:.0e} Q")
    _folding(axes, films.reading_branch("calibrated"), "black", "squeeze film")
    axes.set(xlabel=SPEED, ylabel=SWING, xlim=(100, 400), yscale="log")
    axes.legend(loc="upper right", fontsize="x-small")
    return figure


def _folding(axes: Any, found: Branch, color: str, name: str) -> None:
    """Draw a branch and its upper fold."""
    curve(axes, found, color, (name, ""))
    for fold in found.labelled(Label.FOLD)[:1]:
        at = fold.parameter / RPM, fold.peak_to_peak("x") / MICRO
        axes.plot(*at, "o", color=color, markersize=5, zorder=5)
