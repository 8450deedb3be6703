"""The report on extremes: its sections, and the stated domain in front of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from reports.studies.extremes import disc, duffing, grazing, multipliers, nearresonance, stop, vanderpol
from reports.studies.extremes.survey import Outcome, Row
from reports.studies.extremes.words import domain, error
from reports.studies.pages.page import Page, Sections

STUDIES = {
    study.key: study
    for study in (
        *disc.STUDIES,
        vanderpol.STUDY,
        duffing.STUDY,
        multipliers.STUDY,
        grazing.STUDY,
        stop.STUDY,
        nearresonance.STUDY,
    )
}


def domains(kept: Sections) -> dict[str, Any]:
    """Return the stated domain: where every branch went through, or was still going well when cut."""
    table = []
    for name, section in kept.items():
        counts = (str(int(section.numbers[o.value]) or "") for o in Outcome)
        run = domain([Row(**row) for row in section.rows])
        table.append((STUDIES[name].title, run, *counts, error(section.numbers.get("error"))))
    return {"outcomes": [o.value for o in Outcome], "domains": table}


REPORT = Page(
    name="extremes",
    folder=Path(__file__).parent,
    sections={key: study.section for key, study in STUDIES.items()},
    context=domains,
)
