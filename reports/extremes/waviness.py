"""Section of the report: waviness of the disc, 1 nm to 100 µm."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="waviness",
    title="Waviness",
    quantity="amplitude",
    unit="m",
    cases=lambda: [case(a, {"amplitude": a}) for a in (1e-9, 1e-8, 1e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4)],
    lead="""\
The static deflection is 9.4 µm: from about 3 µm on the discs fly over several waves at a time.""",
    quick=(1e-8, 1e-7),
)
section = STUDY.section
