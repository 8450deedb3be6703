"""Sections on whole branches, and what their folds are worth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import periodic as per
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.trade.figures import branches
from reports.studies.trade.methods.direct import tolerance
from reports.studies.trade.methods.measure import Measured, digits
from reports.studies.trade.methods.names import power
from reports.studies.trade.methods.problems import Problem, chain, disc, duffing
from reports.studies.trade.methods.whole import (
    Swept,
    Traced,
    accuracies,
    balanced,
    dialled,
    folds_near,
    shot,
    swept,
)
from reports.studies.trade.words import advice, failures, seconds
from symbolic.scenes.axes import RPM

TOLERANCES = tuple(10.0**-k for k in range(2, 10))


@dataclass(frozen=True, kw_only=True)
class Study:
    """One branch: what is measured on it, and by which other method its folds are confirmed.

    tight: tolerance of the reference, traced between `within`; loose: that of the other method's mesh.
    """

    key: str
    title: str
    problem: Callable[[], Problem]
    cases: Callable[[], Sequence[Traced | Swept]]
    tight: float
    other: per.extend.Discretisation
    by: str
    within: tuple[float, float] | None = None
    loose: float = 1e-8

    def reference(self) -> tuple[list[float], float]:
        """Return the parameter at the folds, and the largest relative difference of the other method's."""
        problem = self.problem()
        if self.within:
            problem = replace(problem, bounds=self.within, start=self.within[1])
        method = per.Collocation(scheme=per.Scheme(per.Family.RADAU, 7))
        traced = Traced(family="", setting="", tol=tolerance(self.tight), method=method)
        branch = traced.branch(problem)
        folds = [p.parameter for p in branch.labelled(per.Label.FOLD)]
        again = folds_near(problem, branch, self.other, tolerance(self.loose, newton=1e-8))
        return folds, max(abs(b / a - 1) for a, b in zip(folds, again, strict=True))


STUDIES = (
    Study(
        key="disc",
        title="The disc from 500 to 100 rev/min",
        problem=lambda: disc(360.0),
        cases=lambda: [
            *accuracies(),
            *dialled(TOLERANCES),
            *balanced((1e-2,), most=20),
            *swept((17, 33)),
        ],
        tight=1e-9,
        loose=1e-6,
        other=per.Shooting(tolerance=1e-12),
        by="shooting (CVODES, 1e-12)",
        within=(235 * RPM, 255 * RPM),
    ),
    Study(
        key="duffing",
        title="Duffing A from Ω = 0.3 to 3",
        problem=duffing,
        cases=lambda: [
            *accuracies(),
            *dialled(TOLERANCES),
            *balanced(TOLERANCES[::2]),
            *shot((1e-6, 1e-8, 1e-10)),
            *swept((17, 33)),
        ],
        tight=1e-11,
        other=per.HarmonicBalance(harmonics=24, most=40),
        by="harmonic balance",
    ),
)

CHAIN = Study(
    key="chain",
    title="The chain of 50 from Ω = 1.6 down and up again, through both folds",
    problem=chain,
    cases=lambda: [*accuracies(), *dialled((1e-3, 1e-5))],
    tight=1e-7,
    other=per.HarmonicBalance(harmonics=12, most=12),
    by="harmonic balance (12 harmonics)",
    loose=1e-5,
)


def measured(study: Study, tell: Tell) -> tuple[list[Measured], dict[str, float]]:
    """Return the measurements of one branch and its reference."""
    tell(f"{study.key}, reference")
    folds, agreement = study.reference()
    rows = []
    for case in study.cases():
        found = case.measured(study.problem(), folds)
        tell(f"{study.key}, {found.family}, {found.setting}")
        rows.append(replace(found, family=f"{study.key}: {found.family}"))
    numbers = {f"{study.key}_fold_{i + 1}": fold for i, fold in enumerate(folds)}
    return rows, numbers | {f"{study.key}_agreement": agreement}


def compute(studies: Sequence[Study], tell: Tell) -> Found:
    """Trace everything."""
    rows: list[Measured] = []
    numbers: dict[str, float] = {}
    for study in studies:
        found, known = measured(study, tell)
        rows += found
        numbers |= known
    figures = {f"branch-{s.key}": branches(of(s, rows)) for s in studies}
    return Found(numbers=numbers, rows=[row.kept() for row in rows], figures=figures)


def of(study: Study, rows: Sequence[Measured]) -> list[Measured]:
    """Return the measurements of one branch."""
    begin = f"{study.key}: "
    return [replace(r, family=r.family.removeprefix(begin)) for r in rows if r.family.startswith(begin)]


def context(studies: Sequence[Study], kept: Kept) -> Mapping[str, Any]:
    """Return what the template is given."""
    rows = [Measured(**row) for row in kept.rows]
    own = [of(study, rows) for study in studies]
    told = [{"rows": found, "failures": failures(found), "advice": advice(found)} for found in own]
    return {
        "studies": list(zip(studies, told, strict=True)),
        "power": power,
        "seconds": seconds,
        "digits": digits,
    }


def section(title: str, studies: Sequence[Study]) -> Section:
    """Return a section on some branches."""
    return Section(
        title=title,
        compute=partial(compute, studies),
        context=partial(context, studies),
        template="branches.md.j2",
    )


SECTIONS = {
    "branches": section("Whole branches", STUDIES),
    "chainbranch": section("The branch of the chain", (CHAIN,)),
}
