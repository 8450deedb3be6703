"""Section of the report: the branch of the chain of fifty oscillators."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import periodic as per
from reports.pages.section import Section, Tell
from reports.trade.branches import Study, told, traced
from reports.trade.measure import Measured
from reports.trade.problems import chain
from reports.trade.whole import Swept, Traced, accuracies, dialled


def chain_cases() -> list[Traced | Swept]:
    """Return what can be paid for on the chain."""
    return [*accuracies(), *dialled((1e-3, 1e-5))]


STUDY = Study(
    key="chain",
    title="The chain of 50 from Ω = 1.6 down and up again, through both folds",
    problem=chain,
    cases=chain_cases,
    tight=1e-7,
    other=per.HarmonicBalance(harmonics=12, most=12),
    by="harmonic balance (12 harmonics)",
    loose=1e-5,
    remark=(
        "Harmonic balance, whose multipliers are dear with so many states, is left to confirm the folds; "
        "screen with `draft`."
    ),
)


def section(tell: Tell) -> Section:
    """Trace the chain."""
    return traced("The branch of the chain", [STUDY], tell)


def text(rows: Sequence[Measured], n: Mapping[str, float]) -> str:
    """Return the section in Markdown."""
    return told([STUDY], rows, n)
