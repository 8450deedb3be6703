"""Numbers and rows of tables of the report in words."""

from __future__ import annotations

import re
from collections.abc import Sequence

from reports.studies.extremes.survey import Case, Outcome, Row


def number(value: float) -> str:
    """Return a value as briefly as it can be said: 810, 1e6, 1e-9."""
    short = f"{value:.0e}" if f"{value:.5e}" == f"{value:.0e}".replace("e", ".00000e") else f"{value:.6g}"
    text = short if abs(value) >= 1e4 or 0 < abs(value) < 1e-3 else f"{value:.6g}"
    return re.sub(r"e([+-])0?(\d)", lambda m: f"e{'-' if m[1] == '-' else ''}{m[2]}", text)


def error(value: float | None) -> str:
    """Return an error by its first digit, as in 3e-9; rounding alone as such."""
    if value is None:
        return "-"
    return "< 1e-15" if value < 1e-15 else number(float(f"{value:.0e}"))


def cells(row: Row) -> tuple[str, ...]:
    """Return a row of the table of a study."""
    value = label(row)
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


def label(row: Row | Case) -> str:
    """Return what stands for a cell on the page."""
    return row.name or ", ".join(filter(None, [number(row.value), row.way]))


def domain(rows: Sequence[Row]) -> str:
    """Return, of each way, the widest run of neighbouring values whose branches went well."""
    ways = list(dict.fromkeys(r.way for r in rows))
    found = {way: _run([r for r in rows if r.way == way]) for way in ways}
    return "; ".join(f"{way}: {run}" if way else run for way, run in found.items())


def _run(rows: Sequence[Row]) -> str:
    best: list[Row] = []
    run: list[Row] = []
    for row in rows:
        run = [*run, row] if row.well else []
        best = max(best, run, key=len)
    values = [number(r.value) for r in best]
    return " to ".join(dict.fromkeys([*values[:1], *values[-1:]])) or "none"
