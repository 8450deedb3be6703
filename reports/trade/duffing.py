"""Section of the report: Duffing A on its upper sheet."""

from reports.trade import cases
from reports.trade.orbits import Study
from reports.trade.problems import duffing

STUDY = Study(
    key="duffing",
    title="Duffing A at Ω = 1.8",
    problem=duffing,
    cases=lambda: cases.everything(blocks=60),
    lead="x'' + 0.1 x' + x + x³ = 0.5 cos Ωt on the upper of two stable sheets.",
    remark=(
        "A polynomial force and an analytic orbit: every direct method converges fast, and they differ by "
        "small factors; time integration only confirms."
    ),
)
section = STUDY.section
