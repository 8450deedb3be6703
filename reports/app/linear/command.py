"""The command `orbitrace linear`. What is imported here is small, so that --help is quick."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..options import (
    DONE,
    STOPPED_EARLY,
    Axis,
    Changes,
    Out,
    Own,
    Source,
    pairs,
    say,
    take_parts,
    tell,
    tell_written,
)

if TYPE_CHECKING:
    from ..linear.study import Study
    from ..request import Task

Values = Annotated[
    str | None,
    typer.Option(
        "--at",
        metavar="VALUE,VALUE,...",
        help="Values to linearise at, in the unit of the axis. [default: the resonance]",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print what linear.json holds, and nothing else.")]


def linear(
    scene: Source,
    at: Values = None,
    axis: Axis = None,
    changes: Changes = None,
    parts: Own = None,
    out: Out = None,
    as_json: Json = False,
) -> int:
    """Show the linear system about the rest of a scene: natural frequencies, damping, frequency response.

    Writes linear.csv (the response over the scene's range), linear.json and linear.png. Exit code 0: done;
    2: bad input; 3: no equilibrium was found.
    """
    from symbolic.scenes.names import short_name

    from ..request import Request, validated
    from ..settings import folder_for, settings

    take_parts(parts)
    task = validated(Request(source=scene, at=at, overrides=pairs(changes), axis=axis))
    name = short_name(scene)
    with folder_for(out, settings(name, task.scene, "linear", at=list(task.at), axis=axis)) as folder:
        return _run(name, task, folder, as_json)


def _run(name: str, task: Task, folder: Path, as_json: bool) -> int:
    """Linearise, save and tell; return the exit code."""
    from symbolic.motion.linear import NoRestError

    from ..linear import study, text
    from ..rest import check_rest

    try:
        found = study.study(task)
    except NoRestError as error:
        check_rest(task)
        say(f"{error}; nothing was saved")
        return STOPPED_EARLY
    files = _saved(folder, name, found)
    if as_json:
        typer.echo(text.json_text(name, found), nl=False)
    else:
        _show(found, files)
    return DONE


def _saved(folder: Path, name: str, found: Study) -> list[Path]:
    """Write linear.csv, linear.json and linear.png and return them. Raises InputError if one cannot be."""
    from ..files import write
    from ..linear.picture import draw
    from ..linear.text import csv_text, json_text

    writers: dict[str, Callable[[Path], object]] = {
        "linear.csv": lambda path: path.write_text(csv_text(found), "utf-8"),
        "linear.json": lambda path: path.write_text(json_text(name, found), "utf-8"),
        "linear.png": lambda path: draw(path, found),
    }
    return write(folder, writers)


def _show(found: Study, files: list[Path]) -> None:
    from .. import console
    from ..linear.text import table, verdict

    headings, rows = table(found)
    tell(found.scene.title)
    console.table(headings, rows, left=headings[0])
    tell(*verdict(found))
    tell_written(files)
