"""The command line: `orbitrace scenes`, `trace SCENE`, `linear SCENE` and `report NAME`.

What is imported here is small; each command imports what it needs, so that --help is quick.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from enum import Enum
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer._click.exceptions import ClickException

from reports.errors import InputError, refused

if TYPE_CHECKING:
    from periodic import Branch
    from reports import run

DONE, BAD_INPUT, STOPPED_EARLY, INTERRUPTED = 0, 2, 3, 130
"""Exit codes; the last is a shell's own for a program that Ctrl-C ended."""

app = typer.Typer(
    help="Traces the periodic orbits of nonlinear vibrating systems through resonance.",
    epilog="To begin with: orbitrace trace vitrea79-810N",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


class Effort(Enum):
    """The names of `periodic.Accuracy`, which takes longer to import."""

    DRAFT = "draft"
    STANDARD = "standard"
    FINE = "fine"


class Method(Enum):
    """Discretisations by the names that they have here."""

    COLLOCATION = "collocation"
    SHOOTING = "shooting"
    HARMONIC_BALANCE = "harmonic-balance"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; bad input ends in one sentence on standard error."""
    given = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    if isinstance(sys.stdout, TextIOWrapper):
        # A terminal that cannot show a letter is no reason to stop.
        sys.stdout.reconfigure(errors="replace")
    try:
        code = app(args=given, prog_name="orbitrace", standalone_mode=False) or DONE
        sys.stdout.flush()
        return code
    except InputError as error:
        sentence = str(error)
    except OSError as error:
        # What writes files says so in an InputError of its own; an error that names a file is a defect.
        if error.filename is not None:
            raise
        sentence = f"standard output cannot be written to ({error.strerror})"
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - Python flushes it once more at its end
    except ClickException as error:
        sentence = " ".join(error.format_message().replace("Value error, ", "").split())
    _say(sentence)
    return BAD_INPUT


def _say(sentence: str) -> None:
    typer.echo(f"orbitrace: {sentence}", err=True)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"orbitrace {version('orbitrace')}")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
]
Source = Annotated[str, typer.Argument(metavar="SCENE", help="A built-in scene or a TOML file.")]
From = Annotated[
    str | None, typer.Option("--from", metavar="RPM", help="Where to start (oscillator: rad/s).")
]
To = Annotated[str | None, typer.Option("--to", metavar="RPM", help="Where to end.")]
At = Annotated[
    str | None,
    typer.Option("--at", metavar="RPM,RPM,...", help="Values that get a point on every sheet."),
]
Changes = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change the scene, as in --set film.beta=20."),
]
Dial = Annotated[Effort, typer.Option("--accuracy", help="How accurate every orbit is.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Where files go. [default: orbitrace-out/SCENE]"),
]
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
Values = Annotated[
    str | None,
    typer.Option(
        "--at",
        metavar="RPM,RPM,...",
        help="Values to linearise at (oscillator: rad/s). [default: the resonance]",
    ),
]
Page = Annotated[str, typer.Argument(metavar="NAME", help="The report to compute: paper, trade or extremes.")]
Only = Annotated[
    str | None, typer.Option("--only", metavar="SECTION", help="Compute one section, keep the others.")
]
PageOut = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Where the page goes. [default: reports/NAME]")
]
LinearJson = Annotated[bool, typer.Option("--json", help="Print what linear.json holds, and nothing else.")]


@app.callback()
def _common(version: Version = False) -> None:
    pass


@app.command()
def scenes() -> None:
    """List the built-in scenes."""
    from reports.scene import load, scene_names

    names = scene_names()
    width = max(map(len, names))
    for name in names:
        typer.echo(f"{name:{width}}  {load(name).title}")


@app.command()
def trace(
    scene: Source,
    begin: From = None,
    end: To = None,
    at: At = None,
    changes: Changes = None,
    accuracy: Dial = Effort.STANDARD,
    method: How = Method.COLLOCATION,
    out: Out = None,
    resume: Resume = False,
    max_points: MaxPoints = None,
    max_newton: MaxNewton = None,
    sweep: Sweep = False,
    as_json: Json = False,
) -> int:
    """Trace the branch of periodic orbits of a scene and find its folds.

    Writes branch.nc, branch.csv, branch.json and branch.png. Exit code 0: done; 2: bad input; 3: stopped
    early for a numerical reason, with what was traced saved. Ctrl-C saves what is there.
    """
    from reports import run
    from reports.files import writable
    from reports.interrupts import heard_once
    from reports.scene import short_name

    overrides = tuple(_pair(change) for change in changes or ())
    task = run.validated(run.Request(source=scene, begin=begin, end=end, at=at, overrides=overrides))
    limits = {
        "max_points": _count("--max-points", max_points),
        "max_newton": _count("--max-newton", max_newton),
    }
    name = short_name(scene)
    folder = writable(out or Path("orbitrace-out", name))
    before = run.interrupted(task, folder) if resume else None
    with heard_once():
        try:
            branch = _traced(name, task, accuracy, method, before, folder, limits)
            integrated = _swept(name, task) if sweep and not _interrupted(branch) else None
        except KeyboardInterrupt:
            (folder / run.JOURNAL).unlink(missing_ok=True)
            _say("interrupted before the first point; nothing was saved")
            return INTERRUPTED
        journal, folder = folder / run.JOURNAL, _place(branch, folder)
        try:
            files = run.save(folder, name, task.scene, branch, integrated)
        except InputError as error:
            raise _kept(error, journal) from error
        journal.unlink(missing_ok=True)
        _report(name, task, branch, files, as_json)
    return _verdict(branch, folder)


@app.command()
def linear(
    scene: Source, at: Values = None, changes: Changes = None, out: Out = None, as_json: LinearJson = False
) -> int:
    """Show the linear system about the rest of a scene: natural frequencies, damping, frequency response.

    Writes linear.csv (the response over the scene's range), linear.json and linear.png. Exit code 0: done;
    2: bad input; 3: no equilibrium was found.
    """
    from reports import linear as study
    from reports.files import writable
    from reports.linear_text import json_text
    from reports.run import Request, validated
    from reports.scene import short_name
    from symbolic.linear import NoRestError

    overrides = tuple(_pair(change) for change in changes or ())
    task = validated(Request(source=scene, at=at, overrides=overrides))
    name = short_name(scene)
    folder = writable(out or Path("orbitrace-out", name))
    try:
        found = study.study(task)
    except NoRestError as error:
        _say(f"{error}; nothing was saved")
        return STOPPED_EARLY
    files = study.save(folder, name, found)
    if as_json:
        typer.echo(json_text(name, found), nl=False)
    else:
        study.show(found, files)
    return DONE


@app.command()
def report(name: Page, only: Only = None, out: PageOut = None) -> int:
    """Compute a report: its page, figures and numbers.

    Takes minutes; each section is written as soon as it is done, and Ctrl-C keeps those. Exit code 0: done;
    2: bad input; 130: interrupted.
    """
    from reports import console
    from reports.errors import listed
    from reports.interrupts import Ended, heard_at_once
    from reports.pages import NAMES, report_of

    if name not in NAMES:
        raise refused("NAME", name, listed([f'"{known}"' for known in NAMES]))
    page = report_of(name)
    if only is not None and only not in page.sections:
        raise refused("--only", only, f"one of {', '.join(page.sections)}")
    folder = page.ready(out or Path("reports", name))
    with heard_at_once(), console.telling("computing") as tell:
        try:
            written = page.make(folder, (only,) if only else page.sections, tell)
        except (Ended, KeyboardInterrupt):
            _say(f"interrupted; the sections computed so far are in {folder}")
            return INTERRUPTED
    typer.echo(f"written: {written}")
    return DONE


def _pair(change: str) -> tuple[str, str]:
    key, equals, value = change.partition("=")
    if not (key and equals):
        raise refused("--set", change, "KEY=VALUE, as in film.beta=20")
    return key.strip(), value.strip()


def _count(option: str, text: str | None) -> int | None:
    try:
        count = None if text is None else int(text)
    except ValueError:
        count = 0
    if count is not None and count < 1:
        raise refused(option, text, "a whole number of at least 1")
    return count


def _traced(
    name: str,
    task: run.Task,
    accuracy: Effort,
    method: Method,
    before: Branch | None,
    folder: Path,
    limits: dict[str, int | None],
) -> Branch:
    from periodic import Accuracy, Collocation, HarmonicBalance, Reason, Shooting, StepSettings
    from reports import console, run

    methods = {
        Method.COLLOCATION: Collocation,
        Method.SHOOTING: Shooting,
        Method.HARMONIC_BALANCE: HarmonicBalance,
    }
    step = StepSettings(**{key: value for key, value in limits.items() if value is not None})
    dial = Accuracy[accuracy.name]
    with console.progress(name, task.scene) as progress, warnings.catch_warnings():
        warnings.showwarning = lambda message, *_, **__: _say(str(message))
        branch = run.trace(task, dial, progress, methods[method](), before, folder, step)
    if branch.stop.reason is Reason.INTERRUPTED and not len(branch):
        raise KeyboardInterrupt
    return branch


def _interrupted(branch: Branch) -> bool:
    from periodic import Reason

    return branch.stop.reason is Reason.INTERRUPTED


def _place(branch: Branch, folder: Path) -> Path:
    """Return where a branch goes: one that is cut short never in place of an earlier one."""
    from periodic import Reason

    cut = branch.stop.reason.numerical or branch.stop.reason is Reason.INTERRUPTED
    if not (cut and (folder / "branch.nc").exists()):
        return folder
    from reports.files import INCOMPLETE, writable

    return writable(folder / INCOMPLETE)


def _kept(error: InputError, journal: Path) -> InputError:
    """Return the error of results that could not be written, with what is left of them."""
    if not (journal.is_file() and journal.stat().st_size):
        return error
    return InputError(error.field, error.what, f"{error.allowed}; --resume goes on from {journal.name} there")


def _swept(name: str, task: run.Task) -> run.Settlements | None:
    """Integrate in time; None where that is interrupted, so that the branch is still saved."""
    from reports import console, run

    with console.counting(f"integrating {name} in time", 2 * run.SPEEDS) as counted:
        try:
            found = run.swept(task, counted)
        except KeyboardInterrupt:
            _say("the integration in time was interrupted; the picture goes without it")
            return None
    if left_out := 2 * run.SPEEDS - sum(map(len, found)):
        _say(
            f"the motion did not settle in time at {left_out} of {2 * run.SPEEDS} values; they are not drawn"
        )
    return found


def _report(
    name: str,
    task: run.Task,
    branch: Branch,
    files: list[Path],
    as_json: bool,
) -> None:
    from reports import console, summary

    if as_json:
        typer.echo(summary.json_text(name, task.scene, branch), nl=False)
    else:
        console.show(task.scene, branch, files)


def _verdict(branch: Branch, folder: Path) -> int:
    """Return the exit code of a branch and say on standard error why it is not done."""
    from periodic import Reason

    stop = branch.stop
    if stop.reason is Reason.INTERRUPTED:
        _say(f"interrupted; the {len(branch)} points so far are in {folder}")
        return INTERRUPTED
    if stop.reason.numerical:
        kept = f"the {len(branch)} points so far are in {folder}" if len(branch) else "no point was found"
        _say(f"stopped early ({stop}); {kept}")
        return STOPPED_EARLY
    return DONE
