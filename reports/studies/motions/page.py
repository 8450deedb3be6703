"""The report on motions: a judge's verdicts, known systems, the paper's disc, basins, tori."""

from __future__ import annotations

from pathlib import Path

from reports.studies.motions.basins import BASINS
from reports.studies.motions.disc import DISC
from reports.studies.motions.judged import JUDGED
from reports.studies.motions.known import KNOWN
from reports.studies.motions.rub import RUB
from reports.studies.motions.tori import TORI
from reports.studies.pages.page import Page

REPORT = Page(
    name="motions",
    folder=Path(__file__).parent,
    sections={"judged": JUDGED, "known": KNOWN, "disc": DISC, "basins": BASINS, "tori": TORI, "rub": RUB},
)
