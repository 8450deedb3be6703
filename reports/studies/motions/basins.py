"""Basins on a plane, and how long they take."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any, cast

from matplotlib.figure import Figure

import periodic as per
import symbolic as sym
from reports.studies.motions.known import oscillator
from reports.studies.pages.content import Found, Kept, Section, Tell


def basins(tell: Tell) -> Found:
    """Compute the basins of two wells and of the gear pair, 300 x 300 starts each."""
    wells, gears = oscillator(k=-1.0, c=0.15, force=0.1), sym.scene("gear-pair")
    cases: dict[str, tuple[Any, dict[str, float], dict[str, tuple[float, float]]]] = {
        "wells": (wells, {}, {"x": (-2, 2), "x'": (-2, 2)}),
        "gears": (gears, {"Omega": 0.7}, {"x": (-3, 3), "x'": (-2, 2)}),
    }
    rows: list[dict[str, Any]] = []
    figures: dict[str, Figure] = {}
    for name, (system, values, box) in cases.items():
        tell(name)
        begun = time.perf_counter()
        found = per.basins(system, values, box=box, plane=("x", "x'"), grid=(300, 300))
        seconds = time.perf_counter() - begun
        figures[name] = cast(Figure, found.plot().figure)
        rows += [
            {
                "name": name,
                "motion": motion.name,
                "share": motion.share,
                "integrity": found.integrity(k),
                "seconds": seconds,
            }
            for k, motion in enumerate(found.motions)
            if motion.starts
        ]
    numbers = {f"{row['name']}_s": row["seconds"] for row in rows}
    return Found(numbers=numbers, rows=rows, figures=figures)


def _context(kept: Kept) -> Mapping[str, Any]:
    table = [
        [row["name"], row["motion"], f"{100 * row['share']:.2f}", f"{row['integrity']:.3f}"]
        for row in kept.rows
    ]
    return {"table": table}


BASINS = Section(title="Basins", compute=basins, context=_context)
