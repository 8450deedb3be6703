"""The linear study of a scene: rest, Jacobian, frequencies, damping, and the response over its range."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from reports.build import build
from reports.files import write
from reports.run import Task
from reports.schema import Scene
from reports.view import View, view_of
from symbolic import CompiledSystem
from symbolic.linear import Modes, modes, resonance
from symbolic.response import FrequencyResponse, peak, response

Array = NDArray[np.float64]

EVEN = 401
"""Values at which the response is sampled evenly over the range."""

ABOUT = np.concatenate([-np.geomspace(60, 0.05, 60), [0.0], np.geomspace(0.05, 60, 60)])
"""Further values about the resonance, in half-widths of its peak."""

UNDAMPED = 1e-12
"""Damping ratio up to which the peak of the response has no height."""

WIDE = 1000
"""Columns of a table that is not on a terminal: no line of it is broken."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """What `orbitrace linear` finds; SI units. None where there is no resonance in the range.

    `modes` are those at the values `at`, `swings` the linear peak to peak of each output there. `peak` is
    where the response of x is largest near the resonance, and its peak to peak.
    """

    scene: Scene
    system: CompiledSystem
    at: tuple[float, ...]
    modes: tuple[Modes, ...]
    there: FrequencyResponse
    resonance: float | None
    peak: tuple[float, float] | None
    response: FrequencyResponse


def study(task: Task) -> Study:
    """Return the linear study of a scene, at the values asked for or else at the resonance.

    Where there is no resonance in the range either, at the range's first end. Raises
    `symbolic.linear.NoRestError`.
    """
    view, system = view_of(task.scene), build(task.scene)
    low, high = sorted(value * view.unit for value in task.scene.trace.ends)
    met = resonance(system, view.parameter, (low, high))
    default = task.scene.trace.ends[0] * view.unit if met is None else met
    at = tuple(value * view.unit for value in task.at) or (default,)
    ratio = modes(system, {view.parameter: met}).damping_ratios[0] if met is not None else math.nan
    return Study(
        scene=task.scene,
        system=system,
        at=at,
        modes=tuple(modes(system, {view.parameter: value}) for value in at),
        there=response(system, view.parameter, at),
        resonance=met,
        peak=_peak(system, view, met, ratio, (low, high)) if met is not None else None,
        response=response(system, view.parameter, _samples(low, high, met, ratio)),
    )


def _peak(
    system: CompiledSystem, view: View, met: float, ratio: float, bounds: tuple[float, float]
) -> tuple[float, float] | None:
    if not UNDAMPED < ratio < 1:
        return None
    width = min(3 * ratio, 0.9)
    about = max(bounds[0], met * (1 - width)), min(bounds[1], met * (1 + width))
    return peak(system, "x", view.parameter, about)


def _samples(low: float, high: float, met: float | None, ratio: float) -> Array:
    values = np.linspace(low, high, EVEN)
    if met is not None:
        values = np.concatenate([values, met * (1 + max(ratio, UNDAMPED) * ABOUT)])
    return np.unique(values[(values >= low) & (values <= high)])


def save(folder: Path, name: str, found: Study) -> list[Path]:
    """Write linear.csv, linear.json and linear.png and return them. Raises InputError if one cannot be."""
    from reports.linear_picture import draw
    from reports.linear_text import csv_text, json_text

    writers: dict[str, Callable[[Path], object]] = {
        "linear.csv": lambda path: path.write_text(csv_text(found), "utf-8"),
        "linear.json": lambda path: path.write_text(json_text(name, found), "utf-8"),
        "linear.png": lambda path: draw(path, found),
    }
    return write(folder, writers)


def show(found: Study, files: Sequence[Path]) -> None:
    """Print the table, the resonance and the files; piped, the table is plain text of full width."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    from reports.linear_text import table, verdict

    headings, rows = table(found)
    terminal = sys.stdout.isatty()
    shown = Table(box=box.SIMPLE_HEAD if terminal else None, pad_edge=terminal)
    for k, heading in enumerate(headings):
        shown.add_column(heading, justify="right" if k else "left", no_wrap=not terminal)
    for row in rows:
        shown.add_row(*row)
    print(found.scene.title)
    Console(highlight=False, markup=False, emoji=False, width=None if terminal else WIDE).print(shown)
    print("\n".join(verdict(found)))
    print("written: " + ", ".join(str(file) for file in files))
