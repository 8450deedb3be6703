"""Section of the report: the disc at 360 rev/min, where the motion is smooth."""

from reports.trade import cases
from reports.trade.orbits import Study
from reports.trade.problems import disc

STUDY = Study(
    key="smooth",
    title="The disc at 360 rev/min: smooth",
    problem=lambda: disc(360.0),
    cases=lambda: cases.everything(blocks=70),
    lead="The load swings, contact is kept and nothing is sharp.",
    remark=(
        "A lightly damped motion takes hundreds of periods to settle, so the integrations pay for the "
        "transient before any accuracy; to be sure of it they need more still. The series converges "
        "geometrically. Anchors have nothing to hold."
    ),
)
section = STUDY.section
