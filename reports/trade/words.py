"""Words and tables that follow from what was measured."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from reports.pages.report import table
from reports.trade.measure import Measured

TIERS = {"screening": 1e-2, "design": 1e-5, "publication": 1e-8}
"""Errors that are enough for each."""


def cheapest(rows: Sequence[Measured], error: float) -> Measured | None:
    """Return the quickest of those measured that reaches an error."""
    enough = [r for r in rows if r.error is not None and r.error <= error and r.seconds is not None]
    return min(enough, key=lambda r: r.seconds or 0.0, default=None)


def tiers(rows: Sequence[Measured]) -> str:
    """Return the table of what each family needs for each tier, and how far it gets."""
    heads = ("method", *(f"{name}, {power(error)}" for name, error in TIERS.items()), "best error", "at")
    body = []
    for family in dict.fromkeys(r.family for r in rows):
        own = [r for r in rows if r.family == family]
        best = min((r for r in own if r.error is not None), key=lambda r: r.error or 0.0, default=None)
        cells = [_cost(cheapest(own, error)) for error in TIERS.values()]
        last = ("-", own[-1].failure) if best is None else (power(best.error or 0.0), _cost(best))
        body.append((family, *cells, *last))
    return table(heads, body)


def _cost(row: Measured | None) -> str:
    return "-" if row is None else f"{seconds(row.seconds)} ({row.setting})"


def seconds(value: float | None) -> str:
    """Return a time in words."""
    if value is None:
        return "-"
    return f"{value:.3g} s" if value >= 1 else f"{1e3 * value:.3g} ms"


def power(value: float) -> str:
    """Return a small number by its first digit, as in 3e-9."""
    return re.sub(r"e-0", "e-", f"{value:.0e}")


def decade(rows: Sequence[Measured], family: str) -> float:
    """Return by what factor the time of a family grows for each decade of error, by least squares."""
    points = [(r.error, r.seconds) for r in rows if r.family == family and r.error and r.seconds]
    if len(points) < 2:
        return float("nan")
    error, time = np.log10(np.array(points)).T
    return float(10 ** -np.polyfit(error, time, 1)[0])


def advice(rows: Sequence[Measured]) -> str:
    """Return the quickest ways to each tier, with and without error control, and what a decade costs."""
    own = [r for r in rows if r.setting.startswith("tol ") or r.family == "--accuracy"]
    told = [
        f"{decade(rows, family):.2g} with {family}"
        for family in dict.fromkeys(r.family for r in rows)
        if not family.endswith("even") and np.isfinite(decade(rows, family))
    ]
    return (
        f"Who knows the right setting beforehand takes {_quickest(rows)}; who gives a tolerance and lets "
        f"the method meet it, {_quickest(own)}. A decade of accuracy multiplies the time by "
        f"{', '.join(told)}."
    )


def _quickest(rows: Sequence[Measured]) -> str:
    parts = []
    for name, error in TIERS.items():
        row = cheapest(rows, error)
        way = "nothing measured" if row is None else f"{row.family}, {row.setting} ({seconds(row.seconds)})"
        parts.append(f"for {name} {way}")
    return "; ".join(parts)


def failures(rows: Sequence[Measured]) -> str:
    """Return what failed, family by family; nothing where all went well."""
    lines = []
    for family in dict.fromkeys(r.family for r in rows):
        failed = [r for r in rows if r.family == family and r.failure]
        if failed:
            reasons = "; ".join(dict.fromkeys(r.failure for r in failed))
            lines.append(f"{family} at {', '.join(r.setting for r in failed)} ({reasons})")
    return f"\n\nNot found: {'. '.join(lines)}." if lines else ""
