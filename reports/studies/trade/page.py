"""The report on work and precision: its sections, and the quickest way to each tier in front of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from reports.studies.pages.page import Page, Sections
from reports.studies.trade import aims, branches, dial, orbits, parts
from reports.studies.trade.methods.measure import Measured
from reports.studies.trade.methods.names import power
from reports.studies.trade.words import TIERS, by_tier, seconds


def quickest(kept: Sections) -> dict[str, Any]:
    """Return the quickest method for each tier and orbit, and how numbers are said."""
    found = {
        orbits.STUDIES[name].title: by_tier([Measured(**row) for row in section.rows]).values()
        for name, section in kept.items()
        if name in orbits.STUDIES
    }
    return {"tiers": TIERS, "found": found, "seconds": seconds, "power": power}


REPORT = Page(
    name="trade",
    folder=Path(__file__).parent,
    sections={
        **{key: study.section for key, study in orbits.STUDIES.items()},
        **branches.SECTIONS,
        "dial": dial.SECTION,
        "parts": parts.SECTION,
        "aims": aims.SECTION,
    },
    context=quickest,
)
