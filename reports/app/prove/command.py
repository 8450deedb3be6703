"""The command `orbitrace prove`. What is imported here is small, so that --help is quick."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..options import (
    DONE,
    INTERRUPTED,
    STOPPED_EARLY,
    Axis,
    Changes,
    Html,
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
    from ..prove.run import Proven
    from ..request import Task

At = Annotated[
    str | None,
    typer.Option(
        "--at",
        metavar="VALUE,VALUE,...",
        help="Where orbits are proven, on every sheet, in the unit of the axis.",
    ),
]
Folds = Annotated[
    bool, typer.Option("--folds", help="Prove the folds and period doublings of the branch as well.")
]
Between = Annotated[
    str | None,
    typer.Option(
        "--between",
        metavar="VALUE,VALUE",
        help="Prove that the branch has no fold between two values, on each sheet at their middle.",
    ),
]


def prove(
    scene: Source,
    at: At = None,
    folds: Folds = False,
    between: Between = None,
    html: Html = False,
    axis: Axis = None,
    changes: Changes = None,
    parts: Own = None,
    out: Out = None,
) -> int:
    """Prove that the periodic orbits of a scene exist, how near they are, and whether they are stable.

    Traces the branch, then writes a certificate for each orbit, proof-1.json and so on, and check.py, which
    checks them: python check.py proof-1.json. On the page of --html points that are proven have a tick. Exit
    code 0: all is proven; 2: bad input; 3: something is not decided, or the branch stopped early.
    """
    from symbolic.scenes.errors import refused
    from symbolic.scenes.names import short_name

    from ..request import Request, validated, values
    from ..settings import folder_for, settings
    from ..trace.html import check_html

    take_parts(parts)
    if html:
        check_html()
    task = validated(Request(source=scene, at=at, overrides=pairs(changes), axis=axis))
    ends = values(task.scene, between, "--between")
    if not task.at and not folds and not ends:
        raise refused("--at", at or "", "at least one value, or --folds or --between must be given")
    if ends and len(ends) != 2:
        raise refused("--between", between, "two values with a comma between them")
    name = short_name(scene)
    asked = settings(name, task.scene, "prove", at=list(task.at), axis=axis, folds=folds, between=list(ends))
    with folder_for(out, asked) as folder:
        return _run(task, folder, folds=folds, between=ends, html=html)


def _run(task: Task, folder: Path, *, folds: bool, between: tuple[float, ...], html: bool) -> int:
    """Trace, prove, save and tell; return the exit code."""
    from ..interrupts import interrupting_once
    from ..prove import run

    with interrupting_once():
        try:
            branch, found = run.proven(task, folder, folds=folds, between=between)
        except KeyboardInterrupt:
            say("interrupted; nothing was saved")
            return INTERRUPTED
    files = run.save(task, folder, branch, found, html=html)
    _show(task, found, files)
    early = any(stop.reason.numerical for stop in branch.stops)
    if early:
        say(f"stopped early ({branch.ending})")
    if not found:
        say("the branch has no such points")
    return DONE if found and not early and all(each.proof for each in found) else STOPPED_EARLY


def _show(task: Task, found: list[Proven], files: list[Path]) -> None:
    from .. import console
    from ..view import view_of

    view = view_of(task.scene)
    rows = [[each.label, each.place(view.shown), each.verdict, each.size] for each in found]
    tell(task.scene.title)
    console.table(["label", view.abscissa.heading, "verdict", "off by"], rows, left="verdict")
    tell(*(f"{each.label or 'orbit'} at {each.place(view.shown)}: {each.says}" for each in found))
    tell_written(files)
