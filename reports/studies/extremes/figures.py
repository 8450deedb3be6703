"""The map of a study: outcome, accuracy and cost over the axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.studies.extremes.survey import Outcome, Row
from reports.studies.pages.figures import panels

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

BESIDE = 4.0
"""How much further than its largest value an axis goes, so that markers are whole."""

MARKERS = "os^D"
"""One for each way."""


def diagram(rows: Sequence[Row], axis: str) -> Figure:
    """Return the map, the true errors (and estimates) and the times over the axis, coloured by outcome."""
    ways = list(dict.fromkeys(r.way for r in rows))
    figure, axes = panels(3, 1, width=7.0, height=1.8, sharex=True)
    places, errors, times = axes
    for way, marker in zip(ways, MARKERS, strict=False):
        for row in (r for r in rows if r.way == way):
            look: dict[str, Any] = {"color": COLOURS[row.outcome], "marker": marker, "linestyle": "none"}
            places.plot(row.value, ways.index(way), **look | {"marker": "s", "markersize": 10})
            if row.error is not None and row.estimate is not None:
                errors.plot(row.value, max(row.error, FLOOR), **look)
                errors.plot(row.value, max(row.estimate, FLOOR), **look | {"marker": "_"})
            times.plot(row.value, max(row.seconds, 1e-3), **look)
    for outcome in (o for o in COLOURS if any(r.outcome == o for r in rows)):
        times.plot([], [], "s", color=COLOURS[outcome], label=outcome)
    for way, marker in zip(ways if len(ways) > 1 else (), MARKERS, strict=False):
        times.plot([], [], marker, color="black", label=way)
    places.set(yticks=range(len(ways)), yticklabels=ways, ylim=(len(ways) - 0.5, -0.5))
    errors.set(yscale="log", ylabel="true error (estimate: -)")
    times.set(yscale="log", ylabel="time (s)")
    times.set_xlabel(axis)
    _axis(times, [r.value for r in rows])
    figure.legend(*times.get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure


def _axis(axes: Axes, values: Sequence[float]) -> None:
    """Make the axis logarithmic, about 0 where values are not positive."""
    if min(values) > 0:
        axes.set_xscale("log")
        return
    least, low = min(abs(v) for v in values if v), min(values)
    axes.set_xscale("symlog", linthresh=least, linscale=0.5)
    axes.set_xlim(BESIDE * low if low < 0 else -least / 2, BESIDE * max(values))
    if low < 0:
        axes.set_xticks(values[:: max(1, len(values) // 8)])
