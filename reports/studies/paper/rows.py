"""The rows of the first table: what the paper says beside ours, and the verdict."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any

from reports.studies.pages.text import filled, holds

CLOSE, NEAR = 0.01, 0.05
"""Differences up to which a number counts as reproduced, and as reproduced within so many per cent."""


class Verdict(Enum):
    """What the comparison with the paper says."""

    REPRODUCED = "reproduced"
    WITHIN = "reproduced within"
    NOT_REPRODUCED = "not reproduced"
    NOT_COMPARABLE = "cannot be compared"


@dataclass(frozen=True, kw_only=True)
class Row:
    """One line of the first table: what the paper says, what we find, the verdict, how ours was checked.

    `difference` is relative, None where there is no number to compare; the verdict on a number follows
    from it unless one is given.
    """

    key: str
    what: str
    paper: str
    ours: str
    check: str
    difference: float | None = None
    given: Verdict | None = None

    @property
    def verdict(self) -> str:
        """The verdict in words."""
        if self.given is not None:
            return self.given.value
        if self.difference is None:
            return Verdict.NOT_COMPARABLE.value
        size = abs(self.difference)
        if size <= CLOSE:
            return Verdict.REPRODUCED.value
        if size <= NEAR:
            return f"{Verdict.WITHIN.value} {math.ceil(100 * size)} %"
        return Verdict.NOT_REPRODUCED.value


def compared(key: str, what: str, paper: float, ours: float, unit: str, check: str) -> Row:
    """Return the row of a number that the paper gives; values in the unit shown."""
    theirs, own = (f"{value} {unit}".strip() for value in (f"{paper:g}", f"{ours:.4g}"))
    return Row(key=key, what=what, paper=theirs, ours=own, check=check, difference=ours / paper - 1)


def rows(section: str, numbers: Mapping[str, float]) -> list[Row]:
    """Return the rows that are made of a section's numbers."""
    return [_row(row, numbers) for row in _table() if row["section"] == section]


@cache
def _table() -> list[dict[str, Any]]:
    table = Path(__file__).with_name("comparison.toml")
    found: list[dict[str, Any]] = tomllib.loads(table.read_text("utf-8"))["row"]
    return found


def _row(row: Mapping[str, Any], n: Mapping[str, float]) -> Row:
    key, what, paper = row["key"], row["what"], row["paper"]
    if not isinstance(paper, str):

        def away(value: float) -> str:
            return f"{value:.3g} ({100 * (value / paper - 1):+.1f} %)"

        check = filled(row["check"], {"n": n, "away": away})
        return compared(key, what, paper, n[row["ours"]], row.get("unit", ""), check)
    given = None
    if "reproduced" in row:
        given = Verdict.REPRODUCED if holds(row["reproduced"], {"n": n}) else Verdict.NOT_REPRODUCED
    ours, check = (filled(row[name], {"n": n}) for name in ("ours", "check"))
    return Row(key=key, what=what, paper=paper, ours=ours, check=check, given=given)
