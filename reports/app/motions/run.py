"""Motions of a scene, from a validated task to files on disk."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path

import periodic as per
from periodic.results.textcell import text_cell
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError

from ..files import write
from ..request import Task
from ..view import view_of
from .options import Ranges

HEADINGS = ("number", "motion", "starts", "share", "largest multiplier", "tells", "found")
"""Columns of the file, before those of the states at tau = 0 (SI)."""


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What is asked for: a value in the unit of the axis, and how thoroughly."""

    at: float
    box: Ranges
    periods: int
    starts: int
    jobs: int
    resume: bool


def found(task: Task, asked: Asked, store: Path) -> per.phasespace.Motions:
    """Look for motions. Raises InputError, SearchInterrupted."""
    view, system = view_of(task.scene), build(task.scene)
    values = {view.parameter: asked.at * view.unit}
    try:
        with per.working(asked.jobs, store, asked.resume):
            return per.motions(system, values, box=asked.box, periods=asked.periods, starts=asked.starts)
    except ValueError as error:
        raise InputError("motions", "cannot be looked for", str(error)) from error


def save(folder: Path, motions: per.phasespace.Motions) -> list[Path]:
    """Write motions.csv and return it. Raises InputError if it cannot be."""
    return write(folder, {"motions.csv": lambda path: path.write_text(csv_text(motions), "utf-8")})


def csv_text(motions: per.phasespace.Motions) -> str:
    """Return all motions as CSV. Headings begin no formula of a spreadsheet."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*HEADINGS, *map(text_cell, motions.box)])
    for number, motion in enumerate(motions, start=1):
        point = motion.point
        largest = f"{abs(point.multipliers[0]):.9g}" if point is not None and len(point.multipliers) else ""
        row = [number, motion.name, motion.starts, f"{motion.share:.6g}", largest, motion.tells, motion.found]
        writer.writerow([*row, *(f"{value:.12g}" for value in motions.state_of(motion).values())])
    return text.getvalue()
