"""The report on the paper: its sections, and the table of all rows in front of them."""

from __future__ import annotations

import re
from typing import Any

from reports.pages.report import Report, Said, table

COLUMNS = ("", "quantity", "paper", "ours", "difference", "verdict", "how ours was checked")


def summary(said: Said) -> str:
    """Return the table of all rows, in the order of their keys."""
    rows = [row for section in said.values() for row in section["rows"]]
    return table(COLUMNS, [_cells(row) for row in sorted(rows, key=_order)])


def _order(row: dict[str, Any]) -> list[int | str]:
    return [int(t) if t.isdigit() else t for t in re.split(r"(\d+)", row["key"])]


def _cells(row: dict[str, Any]) -> tuple[str, ...]:
    difference = "" if row["difference"] is None else f"{100 * row['difference']:+.1f} %"
    return row["key"], row["what"], row["paper"], row["ours"], difference, row["verdict"], row["check"]


REPORT = Report(
    name="paper",
    sections=("method", "timedomain", "damping", "frequency", "supports", "filmlaws", "unseen", "regions"),
    summary=summary,
)
