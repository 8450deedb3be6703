"""Section of the report: a chain of fifty oscillators."""

from __future__ import annotations

from reports.trade import cases
from reports.trade.measure import Case, March
from reports.trade.names import GAUSS_5, RADAU_5, Mesh
from reports.trade.orbits import BALANCED, Study
from reports.trade.problems import CHAIN, chain

COUNT = 50


def measured() -> list[Case | March]:
    """Return what can be paid for with 100 states."""
    return [
        *cases.marches(30, steps=(12, 25, 50), tolerances=(1e-4, 1e-6, 1e-8, 1e-10)),
        *cases.shots((1e-6, 1e-8, 1e-10)),
        *cases.harmonics((1, 3, 5, 7, 9, 12)),
        *cases.dial(),
        *cases.even(ntst=(6, 12, 24)),
        *cases.chosen(Mesh.ADAPTIVE, (RADAU_5, GAUSS_5), (1e-3, 1e-5, 1e-7)),
    ]


STUDY = Study(
    key="chain",
    title="A chain of 50 oscillators at Ω = 1.1",
    problem=lambda: chain(COUNT),
    cases=measured,
    lead=(
        f"Fifty equal masses m = {CHAIN['m']:g} kg in a row, each on a damper c = {CHAIN['c']:g} N s/m, a "
        f"spring k = {CHAIN['k']:g} N/m and a cubic spring k3 = {CHAIN['k3']:g} N/m³ to ground, "
        f"neighbours joined by springs of {CHAIN['link']:g} N/m, the first driven by {CHAIN['F']:g} cos Ωt "
        "N: 100 states."
    ),
    remark=(
        "With many states the linear algebra costs, which falls on the direct methods and not on the "
        "integrations; but those give neither multipliers nor unstable motions. Few intervals of high order "
        "are better than many of low order."
    ),
    solvers=BALANCED,
    by=("collocation (Gauss 6, 48 intervals)", "harmonic balance (16 harmonics)"),
)
section = STUDY.section
