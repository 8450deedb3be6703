"""The report on work and precision: its sections, and the quickest way to each tier in front of them."""

from __future__ import annotations

from reports.pages.report import Report, Said, table
from reports.trade.measure import Measured
from reports.trade.words import TIERS, cheapest, power, seconds

ORBITS = ("smooth", "grazing", "lost", "duffing", "chain")


def summary(said: Said) -> str:
    """Return a table of the quickest method for each tier and orbit."""
    heads = ("", *(f"{tier}, error {power(error)}" for tier, error in TIERS.items()))
    rows = []
    for name in ORBITS:
        if name in said:
            measured = [Measured(**row) for row in said[name]["rows"]]
            found = [cheapest(measured, error) for error in TIERS.values()]
            cells = ["-" if r is None else f"{r.family} ({r.setting}), {seconds(r.seconds)}" for r in found]
            rows.append((said[name]["title"], *cells))
    return table(heads, rows) if rows else ""


SECTIONS = (*ORBITS, "branches", "chainbranch", "dial", "parts", "aims")

REPORT = Report(name="trade", sections=SECTIONS, summary=summary)
