"""The map of a study: outcome, accuracy and cost over the axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from reports.extremes.survey import Outcome, Row
from reports.pages.figures import panels

if TYPE_CHECKING:
    from reports.extremes.study import Study

COLOURS = {
    Outcome.TRACED.value: "tab:green",
    Outcome.CUT.value: "tab:blue",
    Outcome.STOPPED.value: "tab:orange",
    Outcome.REFUSED.value: "tab:gray",
    Outcome.UNCONFIRMED.value: "tab:purple",
    Outcome.WRONG.value: "tab:red",
}

FLOOR = 1e-16
"""Errors below it are drawn there."""


def diagram(study: Study, rows: Sequence[Row]) -> Figure:
    """Return true errors, estimates and times over the axis, coloured by outcome."""
    figure, (above, below) = panels(2, 1, width=7.0, height=2.2, sharex=True)
    for outcome, colour in COLOURS.items():
        own = [r for r in rows if r.outcome == outcome]
        if not own:
            continue
        values = np.array([r.value for r in own])
        true = [np.nan if r.error is None else max(r.error, FLOOR) for r in own]
        told = [np.nan if r.estimate is None else max(r.estimate, FLOOR) for r in own]
        above.plot(values, true, "o", color=colour)
        above.plot(values, told, "_", color=colour)
        below.plot(values, [max(r.seconds, 1e-3) for r in own], "o", color=colour, label=outcome)
        for row in own:
            below.axvspan(*_cell(rows, row), color=colour, alpha=0.12, lw=0)
    positive = all(r.value > 0 for r in rows)
    above.set(xscale="log" if positive else "symlog", yscale="log", ylabel="true error (o), estimate (-)")
    if not positive:
        above.set_xscale("symlog", linthresh=min(abs(r.value) for r in rows if r.value))
    below.set(yscale="log", ylabel="time (s)")
    below.set_xlabel(f"{study.quantity} ({study.unit})" if study.unit else study.quantity)
    below.legend(ncols=6)
    return figure


def _cell(rows: Sequence[Row], row: Row) -> tuple[float, float]:
    """The part of the axis that is nearest to a row's value."""
    values = sorted({r.value for r in rows})
    k = values.index(row.value)
    low = row.value if k == 0 else _between(values[k - 1], row.value)
    high = row.value if k == len(values) - 1 else _between(row.value, values[k + 1])
    return low, high


def _between(a: float, b: float) -> float:
    return float(np.sqrt(a * b)) if a * b > 0 else (a + b) / 2
