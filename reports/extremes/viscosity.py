"""Section of the report: viscosity of the lubricant, 1e-4 to 1e2 Pa s."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="viscosity",
    title="Viscosity",
    quantity="viscosity",
    unit="Pa s",
    cases=lambda: [case(eta, {"viscosity": eta}) for eta in (1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0)],
    lead="""\
Viscosity sets the thickness of the film, from 0.013 to 73 µm at 360 rev/min. A thin one damps next to
nothing.""",
    quick=(10.0,),
)
section = STUDY.section
