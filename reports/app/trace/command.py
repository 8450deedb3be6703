"""The command `orbitrace trace`: options, sentences and exit codes around a trace.

What is imported here is small, so that --help is quick.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from enum import Enum
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
    count,
    pairs,
    say,
    take_parts,
)

if TYPE_CHECKING:
    from periodic import Branch

    from ..request import Task
    from ..trace.picture import Settlements
    from ..trace.run import Effort, Result


class Accuracy(Enum):
    """The names of `periodic.Accuracy`, which takes longer to import."""

    DRAFT = "draft"
    STANDARD = "standard"
    FINE = "fine"


class Method(Enum):
    """Discretisations by the names that they have here."""

    COLLOCATION = "collocation"
    SHOOTING = "shooting"
    HARMONIC_BALANCE = "harmonic-balance"


From = Annotated[
    str | None, typer.Option("--from", metavar="VALUE", help="Where to start, in the unit of the axis.")
]
To = Annotated[str | None, typer.Option("--to", metavar="VALUE", help="Where to end.")]
At = Annotated[
    str | None,
    typer.Option("--at", metavar="VALUE,VALUE,...", help="Values that get a point on every sheet."),
]
Dial = Annotated[Accuracy, typer.Option("--accuracy", help="How accurate every orbit is.")]
How = Annotated[Method, typer.Option("--method", help="How orbits are represented and solved for.")]
Resume = Annotated[
    bool, typer.Option("--resume", help="Go on from an interrupted trace in DIR; all else as it was.")
]
MaxPoints = Annotated[str | None, typer.Option("--max-points", metavar="N", help="Stop after N steps.")]
MaxNewton = Annotated[
    str | None,
    typer.Option("--max-newton", metavar="N", help="Stop after N Newton iterations, failed ones included."),
]
Sweep = Annotated[
    bool,
    typer.Option(
        "--sweep", help="Also integrate in time, up and down; the picture shows where that settles."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print what branch.json holds, and nothing else.")]


def trace(
    scene: Source,
    begin: From = None,
    end: To = None,
    at: At = None,
    axis: Axis = None,
    changes: Changes = None,
    parts: Own = None,
    accuracy: Dial = Accuracy.STANDARD,
    method: How = Method.COLLOCATION,
    out: Out = None,
    resume: Resume = False,
    max_points: MaxPoints = None,
    max_newton: MaxNewton = None,
    sweep: Sweep = False,
    html: Html = False,
    as_json: Json = False,
) -> int:
    """Trace the branch of periodic orbits of a scene and find its folds.

    Writes branch.nc, branch.csv, branch.json, branch.png, and settings.json: what they are made with. Exit
    code 0: done; 2: bad input; 3: stopped early for a numerical reason, with what was traced saved. Ctrl-C
    saves what is there.
    """
    from symbolic.scenes.names import short_name

    from ..request import Request, validated
    from ..settings import folder_for, settings
    from ..trace.html import check_html

    take_parts(parts)
    wanted = Request(source=scene, begin=begin, end=end, at=at, overrides=pairs(changes), axis=axis)
    task = validated(wanted)
    if html:
        check_html()
    points, newton = count("--max-points", max_points), count("--max-newton", max_newton)
    name, at_ = short_name(scene), list(task.at)
    asked = {"at": at_, "axis": axis, "accuracy": accuracy.value, "method": method.value}

    from ..trace.run import Effort

    effort = Effort(accuracy=accuracy.name, method=method.value, max_points=points, max_newton=newton)
    wishes = Wishes(resume=resume, sweep=sweep, html=html, as_json=as_json)
    with folder_for(out, settings(name, task.scene, "trace", **asked), resume) as folder:
        return _run(name, task, effort, folder, wishes)


@dataclass(frozen=True, kw_only=True)
class Wishes:
    """What goes with a trace: taking one up, integrating in time, a page, JSON on standard output."""

    resume: bool
    sweep: bool
    html: bool
    as_json: bool


def _run(name: str, task: Task, effort: Effort, folder: Path, wishes: Wishes) -> int:
    """Trace, integrate in time, save and tell; return the exit code."""
    from ..interrupts import interrupting_once
    from ..trace import run, shown, summary

    before, journal = run.interrupted(task, folder) if wishes.resume else None, folder / run.JOURNAL
    with interrupting_once():
        try:
            branch = _traced(name, task, effort, folder, before)
            integrated = _swept(name, task) if wishes.sweep and not _interrupted(branch) else None
        except KeyboardInterrupt:
            journal.unlink(missing_ok=True)
            say("interrupted before the first point; nothing was saved")
            return INTERRUPTED
        folder = run.place(branch, folder)
        result = run.Result(name=name, scene=task.scene, branch=branch, integrated=integrated)
        files = _saved(result, folder, journal, html=wishes.html)
        journal.unlink(missing_ok=True)
        if wishes.as_json:
            typer.echo(summary.json_text(name, task.scene, branch), nl=False)
        else:
            shown.show(task.scene, branch, files)
    return _verdict(branch, folder)


def _traced(name: str, task: Task, effort: Effort, folder: Path, before: Branch | None) -> Branch:
    """Trace; raise KeyboardInterrupt where that is interrupted before the first point.

    Raises InputError where there is no point because the scene does not rest anywhere.
    """
    from ..rest import check_rest
    from ..trace import run, shown

    with shown.progress(name, task.scene) as progress, warnings.catch_warnings():
        warnings.showwarning = lambda message, *_, **__: say(str(message))
        branch = run.trace(task, effort, folder, before, progress)
    if _interrupted(branch) and not len(branch):
        raise KeyboardInterrupt
    if not len(branch):
        (folder / run.JOURNAL).unlink(missing_ok=True)
        check_rest(task)
    return branch


def _interrupted(branch: Branch) -> bool:
    from periodic import Reason

    return branch.stop.reason is Reason.INTERRUPTED


def _swept(name: str, task: Task) -> Settlements | None:
    """Integrate in time; None where that is interrupted, so that the branch is still saved."""
    from .. import console
    from ..trace import run

    wanted = 2 * run.SPEEDS
    with console.counting(f"integrating {name} in time", wanted) as counted:
        try:
            found = run.swept(task, counted)
        except KeyboardInterrupt:
            say("the integration in time was interrupted; the picture goes without it")
            return None
    if left_out := wanted - sum(map(len, found)):
        say(f"the motion did not settle in time at {left_out} of {wanted} values; they are not drawn")
    return found


def _saved(result: Result, folder: Path, journal: Path, *, html: bool) -> list[Path]:
    """Write the files. Raises InputError that tells what is left of results that could not be written."""
    from symbolic.scenes.errors import InputError

    from ..trace import run

    try:
        return run.save(folder, result, html=html)
    except InputError as error:
        if not (journal.is_file() and journal.stat().st_size):
            raise
        left = f"{error.allowed}; --resume goes on from {journal.name} there"
        raise InputError(error.field, error.what, left) from error


def _verdict(branch: Branch, folder: Path) -> int:
    """Return the exit code of a branch and say on standard error why it is not done."""
    kept = f"the {len(branch)} points so far are in {folder}" if len(branch) else "no point was found"
    if _interrupted(branch):
        say(f"interrupted; {kept}")
        return INTERRUPTED
    if branch.shortfall:
        say(f"tolerance missed at {branch.shortfall}")
    if any(stop.reason.numerical for stop in branch.stops):
        say(f"stopped early ({branch.ending}); {kept}")
        return STOPPED_EARLY
    return DONE
