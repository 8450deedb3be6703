"""A section of the report: one axis, its cells, what they come to, and what its template is told."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from reports.studies.extremes.figures import diagram
from reports.studies.extremes.survey import Case, Outcome, Row, survey
from reports.studies.extremes.words import cells, error, label
from reports.studies.pages.content import Found, Kept, Section, Tell


@dataclass(frozen=True, kw_only=True)
class Study:
    """An axis: its name on the page, quantity and unit, and the cells.

    quick: values of the cells that a test computes anew.
    """

    key: str
    title: str
    quantity: str
    unit: str = ""
    cases: Callable[[], Sequence[Case]]
    quick: tuple[float, ...]

    @property
    def section(self) -> Section:
        """The section of the page."""
        return Section(title=self.title, compute=self.compute, context=self.context, template="survey.md.j2")

    @property
    def axis(self) -> str:
        """The quantity with its unit."""
        return f"{self.quantity} ({self.unit})" if self.unit else self.quantity

    def compute(self, tell: Tell) -> Found:
        """Survey every cell."""
        rows = []
        for case in self.cases():
            tell(f"{self.quantity} {label(case)}")
            rows.append(survey(case))
        figures = {self.key: diagram(rows, self.axis)}
        return Found(numbers=key_numbers(rows), rows=[row.kept() for row in rows], figures=figures)

    def context(self, kept: Kept) -> Mapping[str, Any]:
        """Return what the template is given."""
        return {
            "key": self.key,
            "title": self.title,
            "axis": self.axis,
            "table": [cells(Row(**row)) for row in kept.rows],
            "counts": [f"{int(kept.numbers[o.value])} {o.value}" for o in Outcome if kept.numbers[o.value]],
            "worst": error(kept.numbers.get("error")),
        }


def key_numbers(rows: Sequence[Row]) -> dict[str, float]:
    """Return how many cells came out how, and the largest true error of those not wrong."""
    numbers = {o.value: float(sum(r.outcome == o.value for r in rows)) for o in Outcome}
    errors = [r.error for r in rows if r.error is not None and r.outcome != Outcome.WRONG.value]
    return numbers | ({"error": max(errors)} if errors else {})
