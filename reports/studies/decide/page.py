"""The report on decisions: modes, intervals of fits, designs."""

from __future__ import annotations

from pathlib import Path

from reports.studies.decide.coverage import COVERAGE
from reports.studies.decide.designs import SECTION as DESIGNS
from reports.studies.decide.freevibrations import ANCHORS, DISC
from reports.studies.pages.page import Page

REPORT = Page(
    name="decide",
    folder=Path(__file__).parent,
    sections={
        "anchors": ANCHORS,
        "disc": DISC,
        "designs": DESIGNS,
        **{each.key: each.section for each in COVERAGE},
    },
)
