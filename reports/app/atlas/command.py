"""The command `orbitrace atlas`. What is imported here is small, so that --help is quick."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..motions.options import STORE, Box, Jobs, Periods, Resume, Starts, ranges
from ..options import DONE, INTERRUPTED, Changes, Html, Out, Source, pairs, say, tell, tell_written
from ..trace.command import From, To

if TYPE_CHECKING:
    from ..atlas.run import Asked
    from ..request import Task

Count = Annotated[
    int, typer.Option("--count", metavar="N", help="Values at which all motions are looked for.")
]


def atlas(
    scene: Source,
    begin: From = None,
    end: To = None,
    count: Count = 21,
    box: Box = None,
    periods: Periods = 4,
    starts: Starts = 64,
    changes: Changes = None,
    html: Html = False,
    jobs: Jobs = 1,
    out: Out = None,
    resume: Resume = False,
) -> int:
    """Chart all that a scene can do over its range: branches, their shares, what is seen from many starts.

    Writes atlas.png and atlas.txt, with --html atlas.html. Exit code 0: done; 2: bad input. Ctrl-C keeps what
    is there.
    """
    from symbolic.scenes.names import short_name

    from ..atlas.run import Asked
    from ..request import Request, validated
    from ..settings import folder_for, settings
    from ..trace.html import check_html

    if html:
        check_html()
    task = validated(Request(source=scene, begin=begin, end=end, overrides=pairs(changes)))
    how: dict[str, Any] = {"count": count, "box": ranges(box), "periods": periods, "starts": starts}
    asked = Asked(jobs=jobs, resume=resume, **how)
    with folder_for(out, settings(short_name(scene), task.scene, "atlas", **how), resume) as folder:
        return _run(task, asked, folder, html=html)


def _run(task: Task, asked: Asked, folder: Path, *, html: bool) -> int:
    """Chart, save and tell; return the exit code."""
    from periodic.phasespace import Atlas

    from ..atlas import run
    from ..interrupts import interrupting_once

    found: object = None
    with interrupting_once():
        try:
            found, interrupted = run.charted(task, asked, folder / STORE), False
        except KeyboardInterrupt as stopped:
            found, interrupted = getattr(stopped, "found", None), True
    if interrupted:
        say("interrupted; --resume goes on")
    if not isinstance(found, Atlas):
        return INTERRUPTED
    files = run.save(task, folder, found, html=html)
    tell(task.scene.title, *str(found).splitlines())
    tell_written(files)
    if interrupted:
        return INTERRUPTED
    (folder / STORE).unlink(missing_ok=True)
    return DONE
