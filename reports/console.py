"""What a terminal shows: progress on standard error, the special points on standard output.

Piped, progress is silent and the table plain text.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from reports.schema import Scene
from reports.summary import special_table
from reports.view import Column, view_of

if TYPE_CHECKING:
    from periodic import Branch, Point


@contextmanager
def progress(name: str, scene: Scene) -> Iterator[Callable[[Point], None] | None]:
    """Give the callback that shows each new point, or None where standard error is no terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console

    view = view_of(scene)
    with Console(stderr=True, highlight=False, markup=False, emoji=False).status(f"tracing {name}") as status:
        count = 0

        def show(point: Point) -> None:
            nonlocal count
            count += 1
            values = ", ".join(_reading(column, point) for column in (view.abscissa, view.height))
            status.update(f"tracing {name}: {count} points, {values}")

        yield show


@contextmanager
def counting(what: str, total: int) -> Iterator[Callable[[object], None] | None]:
    """Give the callback that counts what is done, or None where standard error is no terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console

    with Console(stderr=True, highlight=False, markup=False, emoji=False).status(what) as status:
        done = 0

        def count(_: object) -> None:
            nonlocal done
            done += 1
            status.update(f"{what}: {done} of {total}")

        yield count


@contextmanager
def telling(what: str) -> Iterator[Callable[[str], None]]:
    """Give the callback that says on standard error what is being worked on; piped, one line for each."""
    if not sys.stderr.isatty():
        yield lambda step: print(f"{what} {step}", file=sys.stderr, flush=True)
        return
    from rich.console import Console

    with Console(stderr=True, highlight=False, markup=False, emoji=False).status(what) as status:
        yield lambda step: status.update(f"{what} {step}")


def _reading(column: Column, point: Point) -> str:
    value = column.value(point)
    return f"{column.heading} {value:.5g}" if isinstance(value, float) else ""


def show(scene: Scene, branch: Branch, files: Sequence[Path]) -> None:
    """Print the special points, the reason of the stop and the files."""
    headings, rows = special_table(scene, branch)
    print(scene.title)
    if rows:
        _rich(headings, rows) if sys.stdout.isatty() else _plain(headings, rows)
    count, steps = len(branch), branch.newton_iterations
    print(f"{count} points, {steps} Newton iterations, {branch.elapsed:.2f} s")
    print(f"stop: {branch.stop}")
    print("written: " + ", ".join(str(file) for file in files))


def _rich(headings: list[str], rows: list[list[str]]) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD)
    for heading in headings:
        table.add_column(heading, justify="left" if heading == "label" else "right")
    for row in rows:
        table.add_row(*row)
    Console(highlight=False).print(table)


def _plain(headings: list[str], rows: list[list[str]]) -> None:
    widths = [max(map(len, column)) for column in zip(headings, *rows, strict=True)]
    for row in (headings, *rows):
        print("  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)))
