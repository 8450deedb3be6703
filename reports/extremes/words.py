"""Numbers and tables of the report in words."""

from __future__ import annotations

import re
from collections.abc import Sequence

from reports.extremes.survey import Outcome, Row
from reports.pages.report import table

HEADS = (
    "outcome", "why", "special points", "estimate", "true error", "of the multiplier", "multipliers",
    "confirmed by", "points", "Newton", "time (s)",
)  # fmt: skip


def number(value: float) -> str:
    """Return a value as briefly as it can be said: 810, 1e6, 1e-9."""
    return re.sub(r"e([+-])0?(\d)", lambda m: f"e{'-' if m[1] == '-' else ''}{m[2]}", f"{value:.6g}")


def error(value: float | None) -> str:
    """Return an error by its first digit, as in 3e-9; rounding alone as such."""
    if value is None:
        return "-"
    return "< 1e-15" if value < 1e-15 else number(float(f"{value:.0e}"))


def table_of(rows: Sequence[Row], head: str) -> str:
    """Return the table of a study."""
    return table((head, *HEADS), [_cells(row) for row in rows])


def _cells(row: Row) -> tuple[str, ...]:
    value = row.name or number(row.value)
    if row.largest is None or row.smallest is None:
        return value, row.outcome, row.detail, *["-"] * 6, str(row.points), str(row.iterations), _time(row)
    why = "" if row.outcome == Outcome.TRACED.value else row.detail
    return (
        value,
        row.outcome,
        why,
        row.specials,
        error(row.estimate),
        error(row.error),
        error(row.multiplier_error),
        f"{_small(row)} to {row.largest:.6g}",
        f"{row.check}, {row.checked} orbits",
        str(row.points),
        str(row.iterations),
        _time(row),
    )


def _small(row: Row) -> str:
    """The smallest multiplier, or that it lies below the noise floor."""
    assert row.smallest is not None and row.floor is not None
    return number(float(f"{row.smallest:.2g}")) if row.smallest > row.floor else f"below {error(row.floor)}"


def _time(row: Row) -> str:
    return f"{row.seconds:.1f}"


def domain(rows: Sequence[Row]) -> str:
    """Return the widest run of neighbouring values whose branches were traced, or healthy when cut."""
    good = [r.outcome in (Outcome.TRACED.value, Outcome.CUT.value) for r in rows]
    best: list[Row] = []
    run: list[Row] = []
    for row, fine in zip(rows, good, strict=True):
        run = [*run, row] if fine else []
        best = max(best, run, key=len)
    if not best:
        return "none"
    values = [number(v) for v in sorted({r.value for r in best})]
    return values[0] if len(values) == 1 else f"{values[0]} to {values[-1]}"
