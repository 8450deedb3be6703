"""Section of the report: mass of the disc against the housing's, 1e-6 to 1e6."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="massratio",
    title="Mass ratio",
    quantity="disc / housing",
    unit="",
    cases=lambda: [
        case(r, {"disc_share": r / (1 + r)}, "supports-810N")
        for r in (1e-6, 1e-4, 1e-3, 1e-2, 1.0, 1e2, 1e3, 1e4, 1e6)
    ],
    lead="""\
The disc in bearings of finite stiffness; the sum of both masses is kept.""",
    quick=(1e6,),
)
section = STUDY.section
