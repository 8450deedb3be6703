"""Export as CSV: a table of points, and beside it one of their orbits."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from periodic.results.export.content import Content
from periodic.results.files import replacing
from periodic.results.textcell import text_cell


def write_csv(path: Path, content: Content) -> list[Path]:
    """Write FILE.csv, one row a point, and FILE-orbits.csv, one row a sample; units stand in the heads.

    Heads and labels are texts: none begins a formula of a spreadsheet (`text_cell`).
    """
    written = [_table(path, _points_head(content), _points(content))]
    if content.signals:
        orbits = path.with_name(f"{path.stem}-orbits{path.suffix}")
        written.append(_table(orbits, _orbits_head(content), _orbits(content)))
    return written


def _table(path: Path, head: list[str], rows: Iterable[Iterable[object]]) -> Path:
    with replacing(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)
    return path


def _named(name: str, unit: str) -> str:
    return text_cell(f"{name} [{unit}]" if unit else name)


def _points_head(content: Content) -> list[str]:
    numbers = [_named(name, unit) for name, (unit, _) in content.numbers.items()]
    pairs = [
        f"multiplier {k + 1} {part}" for k in range(content.multipliers.shape[1]) for part in ("re", "im")
    ]
    return ["point", "label", "stable", *numbers, *pairs]


def _points(content: Content) -> Iterable[list[object]]:
    columns = [values for _, values in content.numbers.values()]
    for k, label in enumerate(content.labels):
        pairs = content.multipliers[k].view(float)
        numbers = [repr(float(value)) for value in (*(c[k] for c in columns), *pairs)]
        yield [k, text_cell(label), str(bool(content.stable[k])).lower(), *numbers]


def _orbits_head(content: Content) -> list[str]:
    return ["point", "t [s]", *(_named(name, unit) for name, (unit, _) in content.signals.items())]


def _orbits(content: Content) -> Iterable[list[object]]:
    for k, times in enumerate(content.times):
        samples = np.column_stack([times, *(values[k] for _, values in content.signals.values())])
        for row in samples:
            yield [k, *(repr(float(value)) for value in row)]
