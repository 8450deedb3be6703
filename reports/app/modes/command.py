"""The command `orbitrace modes`. What is imported here is small, so that --help is quick."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..options import (
    DONE,
    INTERRUPTED,
    STOPPED_EARLY,
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
    from ..modes.run import Asked
    from ..request import Task

Over = Annotated[str, typer.Option("--over", metavar="WHAT", help="What the mode is traced over: amplitude.")]
Of = Annotated[
    str | None,
    typer.Option("--of", metavar="OUTPUT", help="Output whose first harmonic it is. [default: the first]"),
]
Which = Annotated[
    int, typer.Option("--which", metavar="N", help="The linear mode it begins at, 0 the lowest.")
]
From = Annotated[
    float | None,
    typer.Option(
        "--from",
        metavar="VALUE",
        help="First amplitude, SI or, of discs, um. [default: a hundredth of the last]",
    ),
]
To = Annotated[
    float | None,
    typer.Option(
        "--to", metavar="VALUE", help="Last amplitude. [default: the largest of the scene's response]"
    ),
]


def modes(
    scene: Source,
    over: Over = "amplitude",
    of: Of = None,
    which: Which = 0,
    begin: From = None,
    end: To = None,
    changes: Changes = None,
    parts: Own = None,
    out: Out = None,
) -> int:
    """Trace a nonlinear mode of a scene: frequency and damping of its free vibrations over the amplitude.

    Writes modes.nc, modes.csv and modes.png. Exit code 0: done; 2: bad input; 3: it stopped early.
    """
    from symbolic.scenes.errors import refused
    from symbolic.scenes.names import short_name

    from ..modes.run import Asked
    from ..request import Request, validated
    from ..settings import folder_for, settings

    take_parts(parts)
    if over != "amplitude":
        raise refused(
            "--over", over, "amplitude; over a parameter, linear modes are those of orbitrace linear"
        )
    task = validated(Request(source=scene, overrides=pairs(changes)))
    asked = Asked(output=of, which=which, begin=begin, end=end)
    name = short_name(scene)
    said = settings(name, task.scene, "modes", of=of, which=which, begin=begin, end=end)
    with folder_for(out, said) as folder:
        return _run(task, asked, folder)


def _run(task: Task, asked: Asked, folder: Path) -> int:
    """Trace, save and tell; return the exit code."""
    from .. import console
    from ..interrupts import interrupting_once
    from ..modes import run

    with interrupting_once():
        try:
            found = run.traced(task, asked)
        except KeyboardInterrupt:
            say("interrupted; nothing was saved")
            return INTERRUPTED
    if not len(found.branch):
        say(f"{found.branch.ending}; nothing was saved")
        return STOPPED_EARLY
    files = run.save(folder, found)
    tell(found.title)
    console.table(found.headings, found.rows(), left=found.headings[0])
    tell(*found.branch.remarks)
    tell_written(files)
    early = any(stop.reason.numerical for stop in found.branch.stops)
    if early:
        say(f"stopped early ({found.branch.ending})")
    return STOPPED_EARLY if early else DONE
