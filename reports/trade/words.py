"""Words and tables that follow from what was measured."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from reports.pages.report import table
from reports.trade.measure import Measured
from reports.trade.names import DIAL, INTEGRATIONS, MESHES, SCHEMES, SHOWN, Mesh, named

TIERS = {"screening": 1e-2, "design": 1e-5, "publication": 1e-8}
"""Errors that are enough for each."""


def cheapest(rows: Sequence[Measured], error: float) -> Measured | None:
    """Return the quickest of those measured that reaches an error."""
    enough = [r for r in rows if r.error is not None and r.error <= error and r.seconds is not None]
    return min(enough, key=lambda r: r.seconds or 0.0, default=None)


def families(rows: Sequence[Measured]) -> dict[str, list[Measured]]:
    """Return the measurements by family."""
    return {f: [r for r in rows if r.family == f] for f in dict.fromkeys(r.family for r in rows)}


def direct(rows: Sequence[Measured]) -> list[Measured]:
    """Return those of methods that say themselves when they are done."""
    return [r for r in rows if r.family not in INTEGRATIONS]


def tiers(rows: Sequence[Measured]) -> str:
    """Return the table of what each family needs for each tier, and how far it gets."""
    heads = ("method", *(f"{name}, {power(error)}" for name, error in TIERS.items()), "best error", "at")
    body = []
    for family, own in families(shown(rows)).items():
        best = min((r for r in own if r.error is not None), key=lambda r: r.error or 0.0, default=None)
        cells = [_cost(cheapest(own, error)) for error in TIERS.values()]
        last = ("-", own[-1].failure) if best is None else (power(best.error or 0.0), _cost(best))
        body.append((family, *cells, *last))
    return table(heads, body)


def shown(rows: Sequence[Measured]) -> list[Measured]:
    """Return those drawn beside each other: of collocation one scheme."""
    return [r for r in rows if r.family in SHOWN or r.family not in MESHES.values()]


def meshes(rows: Sequence[Measured]) -> str:
    """Return the table of what collocation needs for design and publication, by scheme and mesh."""
    own = families(rows)
    kinds = [mesh for mesh in Mesh if any(named(scheme, mesh) in own for scheme in SCHEMES)]
    wanted = [(mesh, tier) for mesh in kinds for tier in ("design", "publication")]
    heads = ("collocation", *(f"{mesh.value}, {tier}" for mesh, tier in wanted))
    body = []
    for scheme in SCHEMES:
        found = [cheapest(own.get(named(scheme, mesh), []), TIERS[tier]) for mesh, tier in wanted]
        body.append((named(scheme, Mesh.EVEN).partition(",")[0], *map(_cost, found)))
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
    """Return by what factor the time of a family grows for each decade of error, by least squares.

    Settings that take longer than another and are no better do not count; less than a decade in all is
    not a number.
    """
    points: list[tuple[float, float]] = []
    for row in sorted((r for r in rows if r.family == family and r.seconds), key=lambda r: r.seconds or 0.0):
        if row.error and row.seconds and (not points or row.error < points[-1][0]):
            points.append((row.error, row.seconds))
    if not points or points[-1][0] > 0.1 * points[0][0]:
        return float("nan")
    error, time = np.log10(np.array(points)).T
    return float(10 ** -np.polyfit(error, time, 1)[0])


def advice(rows: Sequence[Measured]) -> str:
    """Return what to take for each tier: of the dial, of everything; what a decade costs."""
    told = {family: decade(rows, family) for family in families(shown(rows)) if family != DIAL}
    costs = [f"{factor:.2g} with {family}" for family, factor in told.items() if np.isfinite(factor)]
    tuned = [r for r in rows if r.family == DIAL]
    marched = [
        f"{family.partition(' ')[0]} takes {_costs(own)}"
        for family, own in families(rows).items()
        if family in INTEGRATIONS
    ]
    return " ".join(
        [
            *([_by_dial(tuned)] if tuned else []),
            f"The quickest at the setting that is right for it is {_quickest(direct(rows))}.",
            *([f"Run to steady state, {'; '.join(marched)}, if one knew when to stop."] if marched else []),
            f"A decade of accuracy multiplies the time by {', '.join(costs)}.",
        ]
    )


def _by_dial(rows: Sequence[Measured]) -> str:
    parts = []
    for name, error in TIERS.items():
        row = next((r for r in rows if r.error is not None and r.error <= error), None)
        if row is None:
            parts.append(f"for {name} no step of the dial")
        else:
            parts.append(
                f"for {name} `{row.setting}` ({seconds(row.seconds)}, error {power(row.error or 0.0)})"
            )
    return f"With `--accuracy`, take {'; '.join(parts)}."


def _costs(rows: Sequence[Measured]) -> str:
    parts: list[str] = []
    for name, error in TIERS.items():
        row = cheapest(rows, error)
        if row is None:
            return ", ".join([*parts, f"{name} out of reach"])
        parts.append(f"{seconds(row.seconds)} for {name}")
    return ", ".join(parts)


def _quickest(rows: Sequence[Measured]) -> str:
    parts = []
    for name, error in TIERS.items():
        row = cheapest(rows, error)
        way = "nothing measured" if row is None else f"{row.family}, {row.setting} ({seconds(row.seconds)})"
        parts.append(f"for {name} {way}")
    return "; ".join(parts)


def failures(rows: Sequence[Measured]) -> str:
    """Return what failed, family by family, collocation by kind of mesh; nothing where all went well."""
    lines = [_failed(family, own) for family, own in families(shown(rows)).items()]
    for kind in ("Radau", "Gauss"):
        for mesh in Mesh:
            own = [r for r in rows if r.family.startswith(kind) and r.family.endswith(f", {mesh.value}")]
            lines.append(_counted(f"{kind} on {mesh.value} meshes", own))
    told = ". ".join(filter(None, lines))
    return f"\n\nNot found: {told}." if told else ""


def _failed(family: str, rows: Sequence[Measured]) -> str:
    failed = [r for r in rows if r.failure]
    reasons = "; ".join(dict.fromkeys(r.failure for r in failed))
    return f"{family} at {', '.join(r.setting for r in failed)} ({reasons})" if failed else ""


def _counted(kind: str, rows: Sequence[Measured]) -> str:
    failed = [r for r in rows if r.failure]
    return f"{kind} in {len(failed)} of {len(rows)} cases" if failed else ""
