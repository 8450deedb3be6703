"""Section of the report: viscous damping of the contact, ratio 0 to 1."""

from __future__ import annotations

from reports.extremes.disc import case
from reports.extremes.study import Study

STUDY = Study(
    key="damping",
    title="Damping ratio",
    quantity="ratio",
    unit="",
    cases=lambda: [case(z, {"ratio": z}, "dry-810N") for z in (0.0, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0)],
    lead="""\
The disc without a film. Undamped, the branch has no peak: it goes on to ever larger motion.""",
    quick=(0.1, 1.0),
)
section = STUDY.section
