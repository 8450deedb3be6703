"""Films in all regimes: the printed values, and the regime of the paper's disc at each speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import symbolic as sym
from reports.studies.machines.machine import rpm
from reports.studies.pages.content import Found, Kept, Section, Tell
from symbolic.parts.films.regressions import Rolling

PRINTED = {(100.0, 10.0): 4.45402, (5.0, 2.0): 2.09965}
"""H at (M, L) of circular contacts, D = 1."""

SPEEDS = (100.0, 200.0, 300.0, 360.0, 500.0)
"""Of the paper's disc, rev/min."""

OILS = {"vitrea79": (0.890, 25.9e-9), "turbo33": (0.034, 21.6e-9)}
"""Viscosity (Pa s) and piezoviscosity (m^2/N)."""


def compute(tell: Tell) -> Found:
    """Return the printed values anew, and thickness and regime of the discs under 810 N."""
    numbers = {f"H({load:g}, {oil:g})": sym.film_regime(load, oil).thickness for load, oil in PRINTED}
    rows: list[dict[str, Any]] = []
    for oil, (viscosity, piezo) in OILS.items():
        for speed in SPEEDS:
            law = sym.RegimeFilm(Rolling(rpm(speed), 0.051, viscosity, piezo))
            found = law.regime(810.0)
            rows.append({"oil": oil, "speed": speed, "H": found.thickness, "regime": found.name})
    return Found(numbers=numbers, rows=rows)


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the printed values beside ours."""
    return {
        "known": [
            (load, oil, value, kept.numbers[f"H({load:g}, {oil:g})"])
            for (load, oil), value in PRINTED.items()
        ],
        "table": [(row["oil"], f"{row['speed']:g}", f"{row['H']:.4f}", row["regime"]) for row in kept.rows],
    }


FILMS = Section(title="Films in all four regimes", compute=compute, context=context)
