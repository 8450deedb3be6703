"""Section of the report: speed of the disc, 1 to 20 000 rev/min."""

from __future__ import annotations

from reports.extremes.disc import speeds
from reports.extremes.study import Study

RANGES = (
    (0.98, 1.0),
    (2.9, 3.0),
    (9.0, 10.0),
    (25.0, 30.0),
    (60.0, 100.0),
    (100.0, 500.0),
    (500.0, 2000.0),
    (2000.0, 6000.0),
    (6000.0, 20000.0),
)
"""rev/min; short ones where natural vibrations fit many times into a period of the excitation."""

STUDY = Study(
    key="speed",
    title="Speed",
    quantity="upper end of the speeds",
    unit="rev/min",
    cases=lambda: [speeds((low, high)) for low, high in RANGES],
    lead="""\
The scene as it is, each range traced from its upper end. At 1 rev/min the contact's free vibration fits
281 times into a period of the excitation. A change of the speed by 1/281 turns its multipliers once round
the circle, which steps have to follow: ranges are short there.""",
    quick=(2000.0,),
)
section = STUDY.section
