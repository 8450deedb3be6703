"""A nonlinear mode of a scene, from a validated task to files on disk."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import periodic as per
from periodic.decisions.modebranch import LOSS, RATIO
from periodic.results.textcell import text_cell
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError, refused

from ..files import write
from ..linear.text import units
from ..request import Task
from ..view import view_of
from .picture import draw

TOLD = 9
"""Points of the table that people read."""

SMALLEST = 0.01
"""Part of the last amplitude at which a mode begins by default."""


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What is asked for: output, linear mode, and the range of amplitudes in the unit that people read."""

    output: str | None
    which: int
    begin: float | None
    end: float | None


@dataclass(frozen=True, kw_only=True)
class Found:
    """A mode, and how it is read: `size` is the SI value of one unit of its amplitude."""

    title: str
    branch: per.Branch
    output: str
    unit: str
    size: float

    @property
    def headings(self) -> list[str]:
        """Of the columns."""
        unit = f" ({self.unit})" if self.unit else ""
        return [f"amplitude of {self.output}{unit}", "frequency (rad/s)", RATIO, f"{LOSS} (J)", "label"]

    def rows(self, most: int | None = TOLD) -> list[list[str]]:
        """Return the columns of all points, or of about so many and the labelled ones."""
        step = 1 if most is None else max(1, math.ceil(len(self.branch) / most))
        last = len(self.branch) - 1
        return [
            [
                f"{point.parameter / self.size:.10g}",
                f"{point.orbit.omega:.10g}",
                f"{point.columns[RATIO]:.8g}",
                f"{point.columns[LOSS]:.8g}",
                point.label.value,
            ]
            for k, point in enumerate(self.branch)
            if k % step == 0 or point.label or k == last
        ]


def traced(task: Task, asked: Asked) -> Found:
    """Trace the mode of a scene. Raises KeyboardInterrupt, InputError."""
    system, view = build(task.scene), view_of(task.scene)
    known = {name: (unit, size) for name, unit, size in units(system)}
    output = next(iter(known)) if asked.output is None else asked.output
    if output not in known:
        raise refused("--of", output, f"one of {', '.join(known)}")
    unit, size = known[output]
    last = _largest(task, system, output) if asked.end is None else asked.end * size
    first = SMALLEST * last if asked.begin is None else asked.begin * size
    if not (0 < first < math.inf and 0 < last < math.inf and first != last):
        given = f"{first / size:g} to {last / size:g}"
        raise InputError("--from, --to", f"are {given}", "they must be two different positive numbers")
    if asked.which < 0:
        raise refused("--which", str(asked.which), "a whole number of at least 0")
    try:
        branch = per.mode_branch(system, output, (first, last), which=asked.which, frequency=view.parameter)
    except per.Interrupted:
        raise KeyboardInterrupt from None
    except ValueError as error:
        raise InputError("modes", "cannot be traced", str(error)) from error
    return Found(title=task.scene.title, branch=branch, output=output, unit=unit, size=size)


def _largest(task: Task, system: per.extend.System, output: str) -> float:
    """The largest first harmonic of an output along the scene's response (SI)."""
    begin, end = task.scene.trace.bounds
    amplitude = {"amplitude": per.Amplitude(output)}
    try:
        branch = per.trace(
            system,
            view_of(task.scene).parameter,
            (min(begin, end), max(begin, end)),
            start=begin,
            watch=per.Watch(columns=amplitude, peaks={}),
        )
    except per.Interrupted:
        raise KeyboardInterrupt from None
    if any(stop.reason.numerical for stop in branch.stops):
        raise InputError("--to", "is not given", f"and the scene's response stopped early ({branch.ending})")
    return float(np.max(branch.column("amplitude")))


def save(folder: Path, found: Found) -> list[Path]:
    """Write modes.nc, modes.csv and modes.png and return them. Raises InputError if one cannot be."""
    return write(
        folder,
        {
            "modes.nc": found.branch.save,
            "modes.csv": lambda path: path.write_text(csv_text(found), "utf-8"),
            "modes.png": lambda path: draw(path, found),
        },
    )


def csv_text(found: Found) -> str:
    """Return all points as CSV. Headings begin no formula of a spreadsheet."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(text_cell, found.headings))
    writer.writerows(found.rows(None))
    return text.getvalue()
