"""The command `orbitrace motions`. What is imported here is small, so that --help is quick."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..options import (
    DONE,
    INTERRUPTED,
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
from .options import STORE, Box, Jobs, Periods, Resume, Starts, ranges

if TYPE_CHECKING:
    from ..motions.run import Asked
    from ..request import Task

At = Annotated[
    str, typer.Option("--at", metavar="VALUE", help="Where motions are looked for, in the unit of the axis.")
]


def motions(
    scene: Source,
    at: At,
    box: Box = None,
    periods: Periods = 6,
    starts: Starts = 256,
    axis: Axis = None,
    changes: Changes = None,
    parts: Own = None,
    jobs: Jobs = 1,
    out: Out = None,
    resume: Resume = False,
) -> int:
    """Look for every motion of a scene at one value: orbits, stable or not, tori, chaos; how likely each is.

    Writes motions.csv. Exit code 0: done; 2: bad input; 3: it is not known where some starts lead. Ctrl-C
    keeps what is there.
    """
    from symbolic.scenes.errors import refused
    from symbolic.scenes.names import short_name

    from ..motions.run import Asked
    from ..request import Request, validated
    from ..settings import folder_for, settings

    take_parts(parts)
    task = validated(Request(source=scene, at=at, overrides=pairs(changes), axis=axis))
    if len(task.at) != 1:
        raise refused("--at", at, "one value")
    how: dict[str, Any] = {"box": ranges(box), "periods": periods, "starts": starts}
    asked = Asked(at=task.at[0], jobs=jobs, resume=resume, **how)
    with folder_for(
        out, settings(short_name(scene), task.scene, "motions", at=asked.at, **how), resume
    ) as folder:
        return _run(task, asked, folder)


def _run(task: Task, asked: Asked, folder: Path) -> int:
    """Look for motions, save and tell; return the exit code."""
    from periodic.phasespace import Motions

    from ..interrupts import interrupting_once
    from ..motions import run

    found: object = None
    with interrupting_once():
        try:
            found, interrupted = run.found(task, asked, folder / STORE), False
        except KeyboardInterrupt as stopped:
            found, interrupted = getattr(stopped, "found", None), True
    if not isinstance(found, Motions):
        say("interrupted; --resume goes on")
        return INTERRUPTED
    files = run.save(folder, found)
    tell(task.scene.title, *str(found).splitlines())
    tell_written(files)
    if interrupted:
        say("interrupted; --resume goes on")
        return INTERRUPTED
    (folder / STORE).unlink(missing_ok=True)
    return STOPPED_EARLY if found.undecided else DONE
