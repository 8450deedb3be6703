"""What a terminal shows of a trace: each new point, and at the end the special points."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from periodic import Branch, Point
from symbolic.scenes.schema import Scene

from ..console import status, table
from ..options import tell, tell_written
from ..trace.summary import special_table
from ..view import Column, view_of


@contextmanager
def progress(name: str, scene: Scene) -> Iterator[Callable[[Point], None] | None]:
    """Give the callback that shows each new point, or None where standard error is no terminal."""
    view = view_of(scene)
    with status(f"tracing {name}") as update:
        count = 0

        def show(point: Point) -> None:
            nonlocal count
            count += 1
            values = ", ".join(_reading(column, point) for column in (view.abscissa, view.height))
            assert update is not None
            update(f"tracing {name}: {count} points, {values}")

        yield show if update else None


def _reading(column: Column, point: Point) -> str:
    value = column.value(point)
    return f"{column.heading} {value:.5g}" if isinstance(value, float) else ""


def show(scene: Scene, branch: Branch, files: Sequence[Path]) -> None:
    """Print the special points, the reason of the stop and the files."""
    headings, rows = special_table(scene, branch)
    tell(scene.title)
    if rows:
        table(headings, rows, left="label") if sys.stdout.isatty() else _plain(headings, rows)
    count, steps = len(branch), branch.newton_iterations
    tell(f"{count} points, {steps} Newton iterations, {branch.elapsed:.2f} s")
    tell(*(f"note: {remark}" for remark in branch.remarks), f"stop: {branch.ending}")
    tell_written(files)


def _plain(headings: list[str], rows: list[list[str]]) -> None:
    widths = [max(map(len, column)) for column in zip(headings, *rows, strict=True)]
    for row in (headings, *rows):
        tell("  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)))
