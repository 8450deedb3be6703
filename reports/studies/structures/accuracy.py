"""Three methods on one beam: condensed collocation, harmonic balance, collocation of all states."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import symbolic as sym
from periodic import Collocation, HarmonicBalance, trace
from periodic.extend import Discretisation
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.structures.beams import cantilever, cubic

AT = (3.1, 4.5, 6.0)
"""Omega in rad/s."""

ELEMENTS = 2

METHODS: Mapping[str, tuple[Discretisation, bool]] = {
    "condensed": (Collocation(), True),
    "harmonic balance, condensed": (HarmonicBalance(), True),
    "harmonic balance, all states": (HarmonicBalance(), False),
    "collocation, all states": (Collocation(), False),
}


def swings(method: str) -> list[float]:
    """Return the tip's peak to peak at the frequencies on the upper sheet, at a tolerance of 1e-9."""
    discretisation, condense = METHODS[method]
    system: sym.CompiledSystem = cantilever(ELEMENTS, cubic, condense=condense)
    found = trace(system, "Omega", (3.0, AT[-1]), start=3.0, at=AT, method=discretisation, tol=1e-9)
    places = {point.parameter: point.peak_to_peak("tip") for point in found.labelled("UZ")}
    return [places[value] for value in AT]


def compute(tell: Tell) -> Found:
    """Return the peak to peak of the tip by each method."""
    rows: list[dict[str, Any]] = []
    for method in METHODS:
        tell(method)
        rows.append({"method": method, "swings": swings(method)})
    numbers = {f"condensed at {value:g}": swing for value, swing in zip(AT, rows[0]["swings"], strict=True)}
    return Found(numbers=numbers, rows=rows)


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the frequencies, and each method's largest relative difference from the first."""
    first = kept.rows[0]["swings"]
    apart = [
        max(abs(ours / other - 1) for ours, other in zip(row["swings"], first, strict=True))
        for row in kept.rows
    ]
    return {"at": AT, "freedoms": 2 * ELEMENTS, "apart": apart}


ACCURACY = Section(title="Three methods agree", compute=compute, context=context)
