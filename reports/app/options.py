"""What commands have in common: options, exit codes, sentences on standard error.

Imported for --help: nothing large is imported here.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from .completion import axis_names, keys, scene_files

DONE, BAD_INPUT, STOPPED_EARLY, INTERRUPTED = 0, 2, 3, 130
"""Exit codes; the last is a shell's own for a program that Ctrl-C ended."""

Source = Annotated[
    str, typer.Argument(metavar="SCENE", help="A built-in scene or a TOML file.", autocompletion=scene_files)
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Change the scene, as in --set film.beta=20.", autocompletion=keys
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Where files go. [default: orbitrace-out/SCENE; SCENE-2, ... for other settings]",
    ),
]


Html = Annotated[
    bool, typer.Option("--html", help="Also write branch.html, a page that shows the orbit pointed at.")
]
Axis = Annotated[
    str | None,
    typer.Option(
        "--axis",
        metavar="UNIT",
        help="Read the frequency in rev/min, Hz or rad/s.",
        autocompletion=axis_names,
    ),
]
Own = Annotated[
    list[str] | None,
    typer.Option("--parts", metavar="MODULE", help="Import a module of your own with parts for scenes."),
]


def say(sentence: str) -> None:
    """Say something on standard error, in one line that a terminal shows and does not obey."""
    from periodic.checks import plain

    typer.echo(f"orbitrace: {plain(sentence)}", err=True)


def tell(*lines: str) -> None:
    """Print lines, which a terminal shows and does not obey whatever names and files have put into them."""
    from periodic.checks import plain

    typer.echo("\n".join(map(plain, lines)))


def tell_written(files: Sequence[Path]) -> None:
    """Print which files there are now."""
    tell("written: " + ", ".join(map(str, files)))


def pairs(
    given: Sequence[str] | None, option: str = "--set", form: str = "KEY=VALUE, as in film.beta=20"
) -> tuple[tuple[str, str], ...]:
    """Return the keys and values of an option of that form. Raises InputError."""
    return tuple(_pair(text, option, form) for text in given or ())


def _pair(text: str, option: str, form: str) -> tuple[str, str]:
    from symbolic.scenes.errors import refused

    key, equals, value = text.partition("=")
    if not (key and equals):
        raise refused(option, text, form)
    return key.strip(), value.strip()


def take_parts(modules: Sequence[str] | None) -> None:
    """Import modules with parts, those in the working directory too. Raises InputError."""
    if not modules:
        return
    from symbolic.scenes.model.catalogue import register_module

    sys.path.insert(0, os.getcwd())
    for name in modules:
        register_module(name)


def count(option: str, text: str | None) -> int | None:
    """Return the whole number of an option. Raises InputError."""
    from symbolic.scenes.errors import refused

    if text is None:
        return None
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise refused(option, text, "a whole number of at least 1")
    return number
