"""A section of the report: one axis, its cells, their table and their map."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from reports.extremes.figures import diagram
from reports.extremes.survey import Case, Outcome, Row, survey
from reports.extremes.words import error, label, table_of
from reports.pages.section import Section, Tell


@dataclass(frozen=True, kw_only=True)
class Study:
    """An axis: its name on the page, quantity and unit, the cells, and the words around them.

    quick: values of the cells that a test computes anew.
    """

    key: str
    title: str
    quantity: str
    unit: str
    cases: Callable[[], Sequence[Case]]
    lead: str
    remark: str = ""
    quick: tuple[float, ...] = ()

    def section(self, tell: Tell) -> Section:
        """Survey every cell."""
        rows = []
        for case in self.cases():
            tell(f"{self.quantity} {label(case)}")
            rows.append(survey(case))
        numbers = key_numbers(rows)
        return Section(
            title=self.title,
            text=self.text(rows, numbers),
            numbers=numbers,
            rows=rows,
            figures={self.key: diagram(self, rows)},
        )

    def text(self, rows: Sequence[Row], n: Mapping[str, float]) -> str:
        """Return the section in Markdown."""
        counts = ", ".join(f"{int(n[o.value])} {o.value}" for o in Outcome if n[o.value])
        head = f"{self.quantity} ({self.unit})" if self.unit else self.quantity
        worst = error(n.get("error"))
        return f"""\
{self.lead}

![{self.title}: outcome, accuracy and cost]({self.key}.png)

{table_of(rows, head)}

Of {len(rows)} branches: {counts}. Largest true error of a confirmed orbit: {worst}. {self.remark}
"""


def key_numbers(rows: Sequence[Row]) -> dict[str, float]:
    """Return how many cells came out how, and the largest true error of those not wrong."""
    numbers = {o.value: float(sum(r.outcome == o.value for r in rows)) for o in Outcome}
    errors = [r.error for r in rows if r.error is not None and r.outcome != Outcome.WRONG.value]
    return numbers | ({"error": max(errors)} if errors else {})
