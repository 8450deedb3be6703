"""The report on proofs: scenes, free oscillations, stretches of branches, and what it costs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.studies.pages.page import Page, Sections
from reports.studies.proof.cost import COSTS
from reports.studies.proof.cycles import CYCLES
from reports.studies.proof.scenes import SCENES
from reports.studies.proof.stretches import STRETCHES
from reports.studies.proof.words import Words

WORDS = Words(key="lorenz-words", cycle=CYCLES[-1], longest=7)


def _summary(kept: Sections) -> Mapping[str, Any]:
    """Count what is proven, and compare estimates with it."""
    rows = [row for each in kept.values() for row in each.rows if "high" not in row and "word" not in row]
    ranges = [row for each in kept.values() for row in each.rows if "high" in row]
    proven = [row for row in rows if row["proven"]]
    return {
        "asked": len(rows),
        "proven": len(proven),
        "folds": sum(row["label"] in ("LP", "PD") for row in proven),
        "accepted": sum(row["accepted"] for row in proven),
        "widest": max((row["radius"] for row in proven), default=0.0),
        "slowest": max((row["seconds"] for row in proven), default=0.0),
        "stretches": len(ranges),
        "whole": sum(row["proven"] for row in ranges),
        "ranges_accepted": sum(row["accepted"] for row in ranges),
        "worst": max((row["distance"] / row["estimate"] for row in proven), default=0.0),
    }


REPORT = Page(
    name="proof",
    folder=Path(__file__).parent,
    sections={each.key: each.section for each in (*SCENES, *CYCLES, *STRETCHES, *COSTS, WORDS)},
    context=_summary,
)
