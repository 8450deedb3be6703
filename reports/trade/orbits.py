"""Sections on one orbit: the reference by two methods, everything measured against it, advice."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import periodic as per
from periodic.newton import Correction
from reports.pages.section import Section, Tell
from reports.trade import figures
from reports.trade.direct import Adaptive, Even, Harmonics, settings_for
from reports.trade.measure import Case, March, Measured, Reference, digits, measured_all, reference
from reports.trade.problems import Problem
from reports.trade.words import advice, failures, meshes, power, tiers

Solver = Callable[[Problem], Correction]

TIGHT = Adaptive(per.Collocation(), settings_for(1e-11, per.Scheme(per.Family.RADAU, 7))).solve
"""Collocation of the 13th order, anchored."""

SHOT = Adaptive(per.Shooting(tolerance=1e-12), settings_for(1e-6, per.Scheme(per.Family.RADAU, 6))).solve
"""Shooting with CVODES at its tightest; its mesh points are the integrator's own."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """One orbit with its two references and their names, what is measured, and the words around it."""

    key: str
    title: str
    problem: Callable[[], Problem]
    cases: Callable[[], Sequence[Case | March]]
    lead: str
    remark: str
    solvers: tuple[Solver, Solver] = (TIGHT, SHOT)
    by: tuple[str, str] = ("collocation (Radau 7, anchored, 1e-11)", "shooting (CVODES, 1e-12)")

    def reference(self) -> Reference:
        """Return the orbit that errors are measured from."""
        first, second = (solve(self.problem()) for solve in self.solvers)
        return reference(first, second)

    def section(self, tell: Tell) -> Section:
        """Measure everything."""
        tell("reference")
        known = self.reference()
        rows = measured_all(self.cases(), self.problem(), known, tell)
        numbers = {
            "agreement": known.agreement,
            "multiplier": known.multiplier,
            "multiplier_agreement": known.multiplier_agreement,
        }
        drawn = {
            f"orbit-{self.key}": figures.diagram(rows),
            f"meshes-{self.key}": figures.meshes(rows),
        }
        return Section(
            title=self.title, text=self.text(rows, numbers), numbers=numbers, rows=rows, figures=drawn
        )

    def text(self, rows: Sequence[Measured], n: Mapping[str, float]) -> str:
        """Return the section in Markdown."""
        return f"""\
{self.lead} The reference is by {self.by[0]}; at its mesh points {self.by[1]} differs by
{power(n["agreement"])} of the orbit's size ({digits(n["agreement"])} digits), and the largest multiplier,
{n["multiplier"]:.6f}, by {power(n["multiplier_agreement"])}. An error below the first of these
figures is one from collocation alone.

![Error of one orbit over processor time](orbit-{self.key}.png)

{tiers(rows)}

![Collocation by scheme and mesh: error over processor time](meshes-{self.key}.png)

{meshes(rows)}{failures(rows)}

**Advice.** {advice(rows)} {self.remark}
"""


BALANCED: tuple[Solver, Solver] = (Even(per.Scheme(per.Family.GAUSS, 6), 48).solve, Harmonics(16).solve)
