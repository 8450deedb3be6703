"""The report on proofs: one section for each scene, and one for each free oscillation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.studies.pages.page import Page, Sections
from reports.studies.proof.cycles import CYCLES
from reports.studies.proof.scenes import SCENES


def _summary(kept: Sections) -> Mapping[str, Any]:
    """Count what is proven, and compare estimates with it."""
    rows = [row for each in kept.values() for row in each.rows]
    proven = [row for row in rows if row["proven"]]
    return {
        "asked": len(rows),
        "proven": len(proven),
        "folds": sum(row["label"] in ("LP", "PD") for row in proven),
        "accepted": sum(row["accepted"] for row in proven),
        "widest": max((row["radius"] for row in proven), default=0.0),
        "slowest": max((row["seconds"] for row in proven), default=0.0),
        "worst": max((row["distance"] / row["estimate"] for row in proven), default=0.0),
    }


REPORT = Page(
    name="proof",
    folder=Path(__file__).parent,
    sections={each.key: each.section for each in (*SCENES, *CYCLES)},
    context=_summary,
)
