"""Section of the report: preload of the disc, 1 N to 1e6 N."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="preload",
    title="Preload",
    quantity="preload",
    unit="N",
    cases=lambda: [case(q, {"preload": q}) for q in (1.0, 10.0, 100.0, 810.0, 1e4, 1e5, 1e6)],
    lead="""\
The discs under 1 N are pressed together by 0.11 µm, a twelfth of the corrugation's amplitude: they fly off
each wave. Under 1 MN the deflection is a thousand times that amplitude and the motion is linear.""",
    quick=(810.0,),
)
section = STUDY.section
