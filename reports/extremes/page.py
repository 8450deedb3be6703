"""The report on extremes: its sections, and the stated domain in front of them."""

from __future__ import annotations

from reports.extremes.survey import Outcome, Row
from reports.extremes.words import domain, error
from reports.pages.report import Report, Said, table

AXES = (
    "preload",
    "viscosity",
    "speed",
    "waviness",
    "beta",
    "squeeze",
    "exponent",
    "damping",
    "massratio",
    "stiffness",
    "vanderpol",
    "duffing",
    "multipliers",
    "grazing",
    "nearresonance",
)


def summary(said: Said) -> str:
    """Return the stated domain: where every branch went through, or was still going well when cut."""
    heads = ("", "all traced or going on, and confirmed", *(o.value for o in Outcome), "largest true error")
    body = []
    for section in said.values():
        rows = [Row(**row) for row in section["rows"]]
        n = section["numbers"]
        counts = (str(int(n[o.value]) or "") for o in Outcome)
        body.append((section["title"], domain(rows), *counts, error(n.get("error"))))
    return f"**The stated domain**\n\n{table(heads, body)}" if body else ""


REPORT = Report(name="extremes", sections=AXES, summary=summary)
