"""The page on the paper: its sections, and the table of all rows in front of them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from reports.studies.pages.content import Kept
from reports.studies.pages.page import Page
from reports.studies.paper import damping, filmlaws, frequency, method, regions, supports, timedomain, unseen
from reports.studies.paper.rows import Row, rows


def first_table(kept: Mapping[str, Kept]) -> dict[str, list[Row]]:
    """Return all rows of the first table in the order of their keys, P1, P2, and so on."""
    found = [row for name, section in kept.items() for row in rows(name, section.numbers)]
    return {"rows": sorted(found, key=lambda row: int(row.key[1:]))}


SECTIONS = {
    "method": method.SECTION,
    "timedomain": timedomain.SECTION,
    "damping": damping.SECTION,
    "frequency": frequency.SECTION,
    "supports": supports.SECTION,
    "filmlaws": filmlaws.SECTION,
    "unseen": unseen.SECTION,
    "regions": regions.SECTION,
}

REPORT = Page(name="paper", folder=Path(__file__).parent, sections=SECTIONS, context=first_table)
