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
        "Harmonics fall off slowly now; they are for screening. High order on an even mesh still does "
        "well, for the peak is narrow but smooth; error control says how well. Explicit steps blow up here."
    ),
)
section = STUDY.section
