"""Section of the report: whole branches, and what their folds are worth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import periodic as per
from periodic.methods.protocol import Method
from reports.pages.report import table
from reports.pages.section import Section, Tell
from reports.trade.direct import settings_for
from reports.trade.figures import branches
from reports.trade.measure import Measured, digits
from reports.trade.problems import Problem, disc, duffing
from reports.trade.whole import Swept, Traced, accuracies, balanced, dialled, folds_near, shot, swept
from reports.trade.words import advice, failures, power, seconds
from reports.view import RPM

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
    other: Method
    by: str
    remark: str
    within: tuple[float, float] | None = None
    loose: float = 1e-8

    def reference(self) -> tuple[list[float], float]:
        """Return the parameter at the folds, and the largest relative difference of the other method's."""
        problem = self.problem()
        if self.within:
            problem = replace(problem, bounds=self.within, start=self.within[1])
        scheme = per.Scheme(per.Family.RADAU, 7)
        traced = Traced(
            family="", setting="", settings=settings_for(self.tight, scheme), method=per.Collocation()
        )
        branch = traced.branch(problem)
        folds = [p.parameter for p in branch.labelled(per.Label.FOLD)]
        loose = settings_for(self.loose, per.Scheme(per.Family.RADAU, 6), newton=1e-8)
        again = folds_near(problem, branch, self.other, loose)
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
        remark=(
            "A sweep in time finds the jumps to about the distance of its speeds, the unstable sheet never."
        ),
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
        remark="`standard` is enough for all that is drawn or designed.",
    ),
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


def section(tell: Tell) -> Section:
    """Trace the disc and Duffing A."""
    return traced("Whole branches", STUDIES, tell)


def traced(title: str, studies: Sequence[Study], tell: Tell) -> Section:
    """Trace everything."""
    rows: list[Measured] = []
    numbers: dict[str, float] = {}
    for study in studies:
        found, known = measured(study, tell)
        rows += found
        numbers |= known
    figures = {f"branch-{s.key}": branches(of(s, rows)) for s in studies}
    return Section(
        title=title, text=told(studies, rows, numbers), numbers=numbers, rows=rows, figures=figures
    )


def of(study: Study, rows: Sequence[Measured]) -> list[Measured]:
    """Return the measurements of one branch."""
    begin = f"{study.key}: "
    return [replace(r, family=r.family.removeprefix(begin)) for r in rows if r.family.startswith(begin)]


def text(rows: Sequence[Measured], n: Mapping[str, float]) -> str:
    """Return the section in Markdown."""
    return told(STUDIES, rows, n)


def told(studies: Sequence[Study], rows: Sequence[Measured], n: Mapping[str, float]) -> str:
    """Return what was measured on some branches in Markdown."""
    lead = "The error is that of the folds, the time that of the whole branch with multipliers.\n\n"
    return lead + "".join(_told(study, of(study, rows), n) for study in studies)


def _told(study: Study, rows: Sequence[Measured], n: Mapping[str, float]) -> str:
    gap = n[f"{study.key}_agreement"]
    heads = ("method", "setting", "points", "time", "error of the folds")
    body = [
        (r.family, r.setting, str(r.size), seconds(r.seconds), power(r.error))
        for r in rows
        if r.error is not None
    ]
    return f"""\
### {study.title}

The reference is by collocation (Radau 7, {power(study.tight)}); {study.by} has the folds within {power(gap)}
of it ({digits(gap)} digits).

![Error of the folds over the time of the branch](branch-{study.key}.png)

{table(heads, body)}{failures(rows)}

**Advice.** {advice(rows)} {study.remark}

"""
