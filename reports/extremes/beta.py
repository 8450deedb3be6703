"""Section of the report: film exponent, 1 to 60."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="beta",
    title="Film exponent β",
    quantity="β",
    unit="",
    cases=lambda: [case(b, {"beta": b}) for b in (1.0, 2.0, 5.0, 10.0, 22.23, 40.0, 60.0)],
    lead="""\
The film's resistance to being thinned, W = Q (h/h0)^-β: 1 is nearly a bath of oil, 60 a hard stop.""",
    quick=(5.0,),
)
section = STUDY.section
