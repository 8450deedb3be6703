"""Section of the report: speed of the disc, 1 to 20 000 rev/min."""

from __future__ import annotations

from reports.extremes.disc import speeds
from reports.extremes.study import Study

STUDY = Study(
    key="speed",
    title="Speed",
    quantity="upper end of the speeds",
    unit="rev/min",
    cases=lambda: [
        speeds(v, r)
        for v, r in (
            (10.0, (1.0, 10.0)),
            (30.0, (10.0, 30.0)),
            (100.0, (30.0, 100.0)),
            (500.0, (100.0, 500.0)),
            (2000.0, (500.0, 2000.0)),
            (6000.0, (2000.0, 6000.0)),
            (20000.0, (6000.0, 20000.0)),
        )
    ],
    lead="""\
The scene as it is, each range traced from its upper end.""",
    quick=(2000.0,),
)
section = STUDY.section
