"""A branch in words and numbers: the JSON object, the CSV text and the table of special points."""

from __future__ import annotations

import csv
import io
import json
import math
from importlib.metadata import version
from platform import python_version
from typing import TYPE_CHECKING, Any

from periodic.bifurcations.label import Label
from periodic.results.peaks import PEAK_OF
from periodic.results.textcell import text_cell
from symbolic.scenes.schema import Scene

from ..settings import parameters
from ..view import LABEL, Cell, Column, View, view_of

if TYPE_CHECKING:
    from periodic import Branch, Point

SWINGS = ("_pp_um", "_pp", "_max")
"""How the names of columns of outputs end."""


def json_text(name: str, scene: Scene, branch: Branch) -> str:
    """Return the JSON object of a branch: `summary` written out, numbers that are not finite as null."""
    return json.dumps(_finite(summary(name, scene, branch)), indent=2, allow_nan=False) + "\n"


def summary(name: str, scene: Scene, branch: Branch) -> dict[str, Any]:
    """Return what a branch says in short; `points` is their number.

    Of special points, beside what the table tells, `parameter` and `NAME_pp` of every output are in the units
    of the equations: SI, or none.
    """
    view = view_of(scene)
    return {
        "scene": name,
        "parameters": parameters(scene),
        "special_points": [_told(view, point) for point in branch.special_points],
        "peaks": {name: [_told(view, point) for point in found] for name, found in branch.peaks.items()},
        "points": len(branch),
        "newton_iterations": branch.newton_iterations,
        "elapsed_s": branch.elapsed,
        "stop": branch.stop.reason.value,
        "stop_detail": branch.stop.detail,
        "remarks": list(branch.remarks),
        "versions": {**branch.versions, "casadi": version("casadi"), "python": python_version()},
    }


def _told(view: View, point: Point) -> dict[str, Any]:
    record: dict[str, Any] = {column.name: column.value(point) for column in view.tabulated}
    record["multipliers"] = [[float(m.real), float(m.imag)] for m in point.multipliers]
    record["parameter"] = point.parameter
    return record | {f"{output}_pp": point.peak_to_peak(output) for output in point.maximum}


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def csv_text(scene: Scene, branch: Branch) -> str:
    """Return all points of a branch, one a line, as CSV; texts begin no formula of a spreadsheet."""
    columns = view_of(scene).columns
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([text_cell(column.name) for column in columns])
    writer.writerows([[_csv_cell(column.value(point)) for column in columns] for point in branch])
    return text.getvalue()


def _csv_cell(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, bool):
        return str(cell).lower()
    return f"{cell:.14g}" if isinstance(cell, float) else text_cell(cell)


def special_table(scene: Scene, branch: Branch) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of special points and peaks for people, without what the scene does not have.

    Peaks are those of the outputs that the table has.
    """
    told = {column.name.removesuffix(suffix) for column in view_of(scene).tabulated for suffix in SWINGS}
    others = {point for name, found in branch.peaks.items() for point in found if _of(name) not in told}
    points = [point for point in branch.points if point.label and point not in others]
    columns = [c for c in view_of(scene).tabulated if any(c.value(point) is not None for point in points)]
    return [c.heading for c in columns], [[_read(c, point) for c in columns] for point in points]


def _of(peak: str) -> str:
    """The output that a peak is of."""
    return peak.removeprefix(PEAK_OF)


def _read(column: Column, point: Point) -> str:
    if column is LABEL and point.label is Label.PEAK:
        return f"{point.label.value} {_of(point.event)}"
    cell = column.value(point)
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return f"{cell:.8g}" if isinstance(cell, float) else str(cell or "")
