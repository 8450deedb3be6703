"""Section of the report: the disc at 287 rev/min, where contact is about to be lost."""

from reports.trade import cases
from reports.trade.orbits import Study
from reports.trade.problems import disc

STUDY = Study(
    key="grazing",
    title="The disc at 287 rev/min: grazing",
    problem=lambda: disc(287.0),
    cases=lambda: cases.everything(blocks=30),
    lead="The load nearly vanishes once in a cycle and the film's stiffness peaks for a moment.",
    remark=(
        "Harmonics fall off slowly now and a mesh that adapts is worth more than a higher order on an even "
        "one. Explicit steps fail from here down to the lower fold."
    ),
)
section = STUDY.section
