"""What a notebook shows of a branch and of a point: a table of special points and a small picture."""

from __future__ import annotations

from itertools import groupby

import numpy as np

from periodic.bifurcations.label import Label
from periodic.display.htmltables import beside, paragraph, table, with_unit
from periodic.display.sketch import Line, Mark, sketch
from periodic.results.point import Point
from periodic.results.record import Record

OUTPUTS = 3
"""Largest number of outputs in the table."""

MOST_POINTS = 25
"""Largest number of special points in it."""


def branch_html(record: Record, stable_between: np.ndarray, said: tuple[str, ...]) -> str:
    """Return a branch as HTML; `said` are lines about it.

    Parameters
    ----------
    record : Record
        The branch.
    stable_between : ndarray of bool, shape (points - 1,)
        Whether it is stable between neighbouring points.
    said : tuple of str
        Lines below.

    Returns
    -------
    str
        A table of the special points and a picture of the first output.
    """
    special = [p for p in record.points if p.label not in (Label.NONE, Label.PEAK)]
    rows = [_row(record, point) for point in special[:MOST_POINTS]]
    more = [f"and {len(special) - MOST_POINTS} special points more"] if len(special) > MOST_POINTS else []
    notes = "".join(map(paragraph, (*more, *said)))
    return beside(table(_headings(record), rows), _picture(record, stable_between)) + notes


def _headings(record: Record) -> list[str]:
    still, layout = any(p.equilibrium for p in record.points), record.layout
    units = {q.name: q.unit for q in layout.parameters}
    outputs = [with_unit(q.name + ("" if still else " p-p"), q.unit) for q in layout.outputs[:OUTPUTS]]
    largest = "Re lambda max (1/s)" if still else "|mu| max"
    return ["", with_unit(record.parameter, units[record.parameter]), *outputs, largest, "stable"]


def _row(record: Record, point: Point) -> list[str]:
    sizes = [f"{_size(point, q.name):.6g}" for q in record.layout.outputs[:OUTPUTS]]
    largest = point.multipliers.real if point.equilibrium else np.abs(point.multipliers)
    label = point.event or point.label.value
    stable = "yes" if point.stable else "no"
    return [label, f"{point.parameter:.9g}", *sizes, f"{largest.max(initial=0.0):.5f}", stable]


def _size(point: Point, output: str) -> float:
    return point.maximum[output] if point.equilibrium else point.peak_to_peak(output)


def _picture(record: Record, stable_between: np.ndarray) -> str:
    first, points = record.layout.outputs[0], record.points
    x = np.array([p.parameter for p in points])
    y = np.array([_size(p, first.name) for p in points])
    lines, end = [], 0
    for stable, group in groupby(stable_between):
        begin, end = end, end + len([*group])
        lines.append(Line(x[begin : end + 1], y[begin : end + 1], dashed=not stable))
    marks = [
        Mark(x[k], y[k], p.event or p.label.value)
        for k, p in enumerate(points)
        if p.label not in (Label.NONE, Label.PEAK, Label.END)
    ]
    headings = _headings(record)
    return sketch(lines or [Line(x, y)], marks, headings[1], headings[2])
