"""Section of the report: squeeze coefficient, 0 to 100 times the paper's."""

from __future__ import annotations

from dataclasses import replace

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="squeeze",
    title="Squeeze coefficient γ",
    quantity="γu",
    unit="",
    cases=lambda: [
        replace(case(0.0, {}, "quasistatic-film-810N"), name="0 (quasistatic film)"),
        *(case(g, {"squeeze": g}) for g in (0.001, 27.343, 273.43, 2734.3, 27343.0, 273430.0)),
    ],
    lead="""\
From none (a law of its own, with a damping ratio of 0.007) and the smallest that a scene may have to 100
times 2734.3.""",
    quick=(27.343,),
)
section = STUDY.section
