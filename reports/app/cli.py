"""The command line: `orbitrace trace SCENE` and the other commands, each in a folder of its own.

What is imported here is small; each command imports what it needs, so that --help is quick.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from io import TextIOWrapper
from typing import Annotated

import typer
from typer._click.exceptions import ClickException

from .atlas.command import atlas
from .doctor.command import doctor
from .export.command import export
from .linear.command import linear
from .map.command import map_
from .modes.command import modes
from .motions.command import motions
from .options import BAD_INPUT, DONE, say
from .parts.command import new, parts
from .prove.command import prove
from .scenes import scenes
from .trace.command import trace

app = typer.Typer(
    help="Traces the periodic orbits of nonlinear vibrating systems through resonance.",
    epilog="To begin with: orbitrace trace vitrea79-810N",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
for command in (scenes, trace, linear, modes, motions, atlas, prove, export, parts, new, doctor):
    app.command()(command)
app.command("map")(map_)


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
    except OSError as error:
        # What writes files says so in an InputError of its own; an error that names a file is a defect.
        if error.filename is not None:
            raise
        sentence = f"standard output cannot be written to ({error.strerror})"
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - Python flushes it once more at its end
    except ClickException as error:
        sentence = " ".join(error.format_message().replace("Value error, ", "").split())
    except _bad_input() as error:
        sentence = str(error)
    say(sentence)
    return BAD_INPUT


def _bad_input() -> type[Exception]:
    # Its package imports CasADi: looked up only once something was raised.
    from symbolic.scenes.errors import InputError

    return InputError


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"orbitrace {version('orbitrace')}")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
]


@app.callback()
def _common(version: Version = False) -> None:
    pass
