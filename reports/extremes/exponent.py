"""Section of the report: exponent of the contact, 1 to 3."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="exponent",
    title="Hertz exponent",
    quantity="n",
    unit="",
    cases=lambda: [
        case(n, {"exponent": n, "contact.stiffness": 810 / (810 / 28e9) ** (n / 1.5)})
        for n in (1.0, 1.25, 1.5, 2.0, 2.5, 3.0)
    ],
    lead="""\
The stiffness goes with it so that the static deflection stays 9.4 µm.""",
    quick=(1.0,),
)
section = STUDY.section
