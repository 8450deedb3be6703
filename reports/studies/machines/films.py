"""Films: printed values, regimes of the paper's disc, and what a film leaves of the waviness."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

import symbolic as sym
from periodic import Label, trace
from periodic.results.plots.curve import draw_curve
from reports.studies.machines.machine import rpm
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import SECOND, TRUSTED, panels
from reports.studies.paper.branches.resonance import highest
from symbolic.parts.films.regimes import REGIMES
from symbolic.parts.films.regressions import Rolling

PRINTED = {(100.0, 10.0): 4.45402, (5.0, 2.0): 2.09965}
"""H at (M, L) of circular contacts, D = 1."""

SPEEDS = (100.0, 200.0, 300.0, 360.0, 500.0)
"""Of the paper's disc, rev/min."""

OILS = {"vitrea79": (0.890, 25.9e-9), "turbo33": (0.034, 21.6e-9)}
"""Viscosity (Pa s) and piezoviscosity (m^2/N)."""

SCENE, WHOLE, LEFT = "vitrea79-810N", "all of the waviness", "what the film leaves of it"


def regrouped(load: float, oil: float) -> float:
    """Return H at (M, L), D = 1, by the grouping of exponents from which PRINTED comes."""
    parts = sym.films.film_regime(load, oil).asymptotes
    rigid, elastic, viscous_rigid, viscous_elastic = (parts[name] for name in REGIMES)
    s = 1.5 * (1 + math.exp(-1.2 * elastic / rigid))
    isoviscous = (rigid ** (1.5 * s) + (elastic**-4 + 1.8**-4) ** (-3 * s / 8)) ** (2 / (3 * s))
    return float((isoviscous + (viscous_rigid**-8 + viscous_elastic**-8) ** (-s / 8)) ** (1 / s))


def disc(reduced: bool) -> sym.CompiledSystem:
    """Return the paper's disc, with all of the waviness or with what the film leaves of it."""
    return sym.scene(SCENE, {"waviness.reduction": "true"} if reduced else {})


def compute(tell: Tell) -> Found:
    """Return the printed values anew, the regime of the discs under 810 N, and the disc's two branches."""
    numbers = {f"H({load:g}, {oil:g})": sym.films.film_regime(load, oil).thickness for load, oil in PRINTED}
    numbers |= {f"regrouped({load:g}, {oil:g})": regrouped(load, oil) for load, oil in PRINTED}
    rows: list[dict[str, Any]] = []
    for oil, (viscosity, piezo) in OILS.items():
        for speed in SPEEDS:
            found = sym.films.RegimeFilm(Rolling(rpm(speed), 0.051, viscosity, piezo)).regime(810.0)
            rows.append({"oil": oil, "speed": speed, "H": found.thickness, "regime": found.name})
    figure, axes = panels(1, 1, height=3.2)
    for reduced, name, color in ((False, WHOLE, TRUSTED), (True, LEFT, SECOND)):
        tell(name)
        system = disc(reduced)
        branch = trace(system, "speed", (rpm(100), rpm(500)), start=rpm(500))
        swing = branch.peak_to_peak("x") * 1e6
        across = np.array([p.parameter for p in branch]) / rpm(1.0)
        draw_curve(axes, across, swing, branch.stable_between, color=color, labels=(name, ""))
        numbers[f"largest swing (µm), {name}"] = highest(system, branch)[1] * 1e6
        numbers[f"folds, {name}"] = float(len(branch.labelled(Label.FOLD)))
    axes.set(xlabel="speed (rev/min)", ylabel="x peak to peak (µm)")
    axes.legend(frameon=False)
    return Found(numbers=numbers, rows=rows, figures={"reduction": figure})


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the printed values beside ours, and the largest swings of the disc."""
    n = kept.numbers
    names = [(m, oil, value, f"({m:g}, {oil:g})") for (m, oil), value in PRINTED.items()]
    return {
        "known": [(m, oil, value, n[f"regrouped{at}"], n[f"H{at}"]) for m, oil, value, at in names],
        "table": [(row["oil"], f"{row['speed']:g}", f"{row['H']:.4f}", row["regime"]) for row in kept.rows],
        "swings": [
            (what, f"{n[f'largest swing (µm), {what}']:.3f}", int(n[f"folds, {what}"]))
            for what in (WHOLE, LEFT)
        ],
    }


FILMS = Section(title="Films in all four regimes", compute=compute, context=context)
