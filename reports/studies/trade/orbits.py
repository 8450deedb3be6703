"""Sections on one orbit: the reference by two methods, everything measured against it, advice."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import periodic as per
from periodic.correction.newton import Correction
from reports.benchmarks.work import CHAIN
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.trade import figures
from reports.studies.trade.methods import cases
from reports.studies.trade.methods.direct import Adaptive, Even, Harmonics, tolerance
from reports.studies.trade.methods.measure import (
    Case,
    March,
    Measured,
    Reference,
    digits,
    measured_all,
    reference,
)
from reports.studies.trade.methods.names import power
from reports.studies.trade.methods.problems import Problem, chain, disc, duffing
from reports.studies.trade.words import advice, failures, meshes, seconds, tiers

Solver = Callable[[Problem], Correction]

TIGHT = Adaptive(per.Collocation(scheme=per.Scheme(per.Family.RADAU, 7)), tolerance(1e-11, most=30)).solve
"""Collocation of the 13th order, anchored; on fine meshes beside a kink Newton takes up to 22 iterations."""

SHOT = Adaptive(per.Shooting(tolerance=1e-12, scheme=per.Scheme(per.Family.RADAU, 6)), tolerance(1e-6)).solve
"""Shooting with CVODES at its tightest; its mesh points are the integrator's own."""

BALANCED: tuple[Solver, Solver] = (Even(per.Scheme(per.Family.GAUSS, 6), 48).solve, Harmonics(16).solve)


@dataclass(frozen=True, kw_only=True)
class Study:
    """One orbit with its two references and their names, and what is measured."""

    key: str
    title: str
    problem: Callable[[], Problem]
    cases: Callable[[], Sequence[Case | March]]
    solvers: tuple[Solver, Solver] = (TIGHT, SHOT)
    by: tuple[str, str] = ("collocation (Radau 7, anchored, 1e-11)", "shooting (CVODES, 1e-12)")

    @property
    def section(self) -> Section:
        """The section of the page."""
        return Section(title=self.title, compute=self.compute, context=self.context, template="orbit.md.j2")

    def reference(self) -> Reference:
        """Return the orbit that errors are measured from."""
        first, second = (solve(self.problem()) for solve in self.solvers)
        return reference(first, second)

    def compute(self, tell: Tell) -> Found:
        """Measure everything."""
        tell("reference")
        known = self.reference()
        rows = measured_all(self.cases(), self.problem(), known, tell)
        numbers = {
            "agreement": known.agreement,
            "multiplier": known.multiplier,
            "multiplier_agreement": known.multiplier_agreement,
        }
        drawn = {f"orbit-{self.key}": figures.diagram(rows), f"meshes-{self.key}": figures.meshes(rows)}
        return Found(numbers=numbers, rows=[row.kept() for row in rows], figures=drawn)

    def context(self, kept: Kept) -> Mapping[str, Any]:
        """Return what the template is given."""
        rows = [Measured(**row) for row in kept.rows]
        return {
            "key": self.key,
            "by": self.by,
            "constants": CHAIN,
            "tiers": tiers(rows),
            "meshes": meshes(rows),
            "failures": failures(rows),
            "advice": advice(rows),
            "power": power,
            "seconds": seconds,
            "digits": digits,
        }


STUDIES = {
    study.key: study
    for study in (
        Study(
            key="smooth",
            title="The disc at 360 rev/min: smooth",
            problem=lambda: disc(360.0),
            cases=lambda: cases.everything(blocks=70),
        ),
        Study(
            key="grazing",
            title="The disc at 287 rev/min: grazing",
            problem=lambda: disc(287.0),
            cases=lambda: cases.everything(blocks=30),
        ),
        Study(
            key="lost",
            title="The disc at 260 rev/min: contact lost",
            problem=lambda: disc(260.0),
            cases=lambda: cases.everything(blocks=20),
        ),
        Study(
            key="duffing",
            title="Duffing A at Ω = 1.8",
            problem=duffing,
            cases=lambda: cases.everything(blocks=60),
        ),
        Study(
            key="chain",
            title="A chain of 50 oscillators at Ω = 1.1",
            problem=chain,
            cases=cases.affordable,
            solvers=BALANCED,
            by=("collocation (Gauss 6, 48 intervals)", "harmonic balance (16 harmonics)"),
        ),
    )
}
