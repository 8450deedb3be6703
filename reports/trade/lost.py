"""Section of the report: the disc at 260 rev/min, where contact is lost in every cycle."""

from reports.trade import cases
from reports.trade.orbits import Study
from reports.trade.problems import disc

STUDY = Study(
    key="lost",
    title="The disc at 260 rev/min: contact lost",
    problem=lambda: disc(260.0),
    cases=lambda: cases.everything(blocks=20),
    lead="The discs fly apart in every cycle; where they do the load falls by many powers of ten.",
    remark=(
        "Only a mesh tied to the loss of contact keeps its order; even meshes and series lose theirs at the "
        "kink and stay fit for screening. CVODES is the check that needs no mesh."
    ),
)
section = STUDY.section
