"""Tables, choices and numbers in words that follow from what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reports.studies.trade.methods.measure import Measured
from reports.studies.trade.methods.names import DIAL, INTEGRATIONS, MESHES, SCHEMES, SHOWN, Mesh, named, power

TIERS = {"screening": 1e-2, "design": 1e-5, "publication": 1e-8}
"""Errors that are enough for each."""

Lines = list[Sequence[str]]
"""The lines of a table, its heads first."""


def cheapest(rows: Sequence[Measured], error: float) -> Measured | None:
    """Return the quickest of those measured that reaches an error."""
    enough = [r for r in rows if r.error is not None and r.error <= error and r.seconds is not None]
    return min(enough, key=lambda r: r.seconds or 0.0, default=None)


def families(rows: Sequence[Measured]) -> dict[str, list[Measured]]:
    """Return the measurements by family."""
    return {f: [r for r in rows if r.family == f] for f in dict.fromkeys(r.family for r in rows)}


def tiers(rows: Sequence[Measured]) -> Lines:
    """Return the table of what each family needs for each tier, and how far it gets."""
    heads = ("method", *(f"{name}, {power(error)}" for name, error in TIERS.items()), "best error", "at")
    lines: Lines = [heads]
    for family, own in families(shown(rows)).items():
        best = min((r for r in own if r.error is not None), key=lambda r: r.error or 0.0, default=None)
        cells = [_cost(cheapest(own, error)) for error in TIERS.values()]
        last = ("-", own[-1].failure) if best is None else (power(best.error or 0.0), _cost(best))
        lines.append((family, *cells, *last))
    return lines


def shown(rows: Sequence[Measured]) -> list[Measured]:
    """Return those drawn beside each other: of collocation one scheme."""
    return [r for r in rows if r.family in SHOWN or r.family not in MESHES.values()]


def meshes(rows: Sequence[Measured]) -> Lines:
    """Return the table of what collocation needs for design and publication, by scheme and mesh."""
    own = families(rows)
    kinds = [mesh for mesh in Mesh if any(named(scheme, mesh) in own for scheme in SCHEMES)]
    wanted = [(mesh, tier) for mesh in kinds for tier in ("design", "publication")]
    heads = ("collocation", *(f"{mesh.value}, {tier}" for mesh, tier in wanted))
    lines: Lines = [heads]
    for scheme in SCHEMES:
        found = [cheapest(own.get(named(scheme, mesh), []), TIERS[tier]) for mesh, tier in wanted]
        lines.append((named(scheme, Mesh.EVEN).partition(",")[0], *map(_cost, found)))
    return lines


def _cost(row: Measured | None) -> str:
    return "-" if row is None else f"{seconds(row.seconds)} ({row.setting})"


def seconds(value: float | None) -> str:
    """Return a time in words."""
    if value is None:
        return "-"
    return f"{value:.3g} s" if value >= 1 else f"{1e3 * value:.3g} ms"


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


def advice(rows: Sequence[Measured]) -> dict[str, Any]:
    """Return what to take for each tier: of the dial, of all direct methods, of each time integration.

    For the dial that is the first setting that is enough, for the others the quickest; None where there is
    none. And by what factor a decade multiplies the time of each family.
    """
    dial = [r for r in rows if r.family == DIAL]
    first = {
        tier: next((r for r in dial if r.error is not None and r.error <= error), None)
        for tier, error in TIERS.items()
    }
    decades = {family: decade(rows, family) for family in families(shown(rows)) if family != DIAL}
    return {
        "dial": first if dial else {},
        "quickest": by_tier([r for r in rows if r.family not in INTEGRATIONS]),
        "marched": {f: _reached(own) for f, own in families(rows).items() if f in INTEGRATIONS},
        "decades": {family: factor for family, factor in decades.items() if np.isfinite(factor)},
    }


def by_tier(rows: Sequence[Measured]) -> dict[str, Measured | None]:
    """Return the quickest for each tier."""
    return {tier: cheapest(rows, error) for tier, error in TIERS.items()}


def _reached(rows: Sequence[Measured]) -> dict[str, Measured | None]:
    """Return the quickest for each tier up to the first that is out of reach."""
    found = by_tier(rows)
    last = next((k for k, row in enumerate(found.values(), 1) if row is None), len(found))
    return dict(list(found.items())[:last])


def failures(rows: Sequence[Measured]) -> list[str]:
    """Return what failed, family by family, collocation by kind of mesh."""
    lines = [_failed(family, own) for family, own in families(shown(rows)).items()]
    for kind in ("Radau", "Gauss"):
        for mesh in Mesh:
            own = [r for r in rows if r.family.startswith(kind) and r.family.endswith(f", {mesh.value}")]
            lines.append(_counted(f"{kind} on {mesh.value} meshes", own))
    return [line for line in lines if line]


def _failed(family: str, rows: Sequence[Measured]) -> str:
    failed = [r for r in rows if r.failure]
    reasons = "; ".join(dict.fromkeys(r.failure for r in failed))
    return f"{family} at {', '.join(r.setting for r in failed)} ({reasons})" if failed else ""


def _counted(kind: str, rows: Sequence[Measured]) -> str:
    failed = [r for r in rows if r.failure]
    return f"{kind} in {len(failed)} of {len(rows)} cases" if failed else ""
