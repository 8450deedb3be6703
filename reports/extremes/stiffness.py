"""Section of the report: stiffness of the supports against the contact's, 1e-6 to 1e6."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="stiffness",
    title="Support stiffness",
    quantity="bearing / contact",
    unit="",
    cases=lambda: [
        case(r, {"support.stiffness": r * 129e6}, "supports-810N")
        for r in (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6)
    ],
    lead="""\
Each bearing against the contact at rest under 810 N, 129 MN/m. On stiff bearings disc and housing vibrate
against each other, lightly damped, hundreds of times in a period of the excitation. Steps have to follow
their multipliers round the circle, and past 1000 intervals what the mesh loses of them is told by the
error estimate.""",
    quick=(0.01,),
)
section = STUDY.section
