"""The commands `orbitrace parts` and `orbitrace new`. What is imported here is small: --help is quick."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..completion import part_names, starts
from ..options import DONE, Own, take_parts, tell

Name = Annotated[
    str | None,
    typer.Argument(
        metavar="[NAME]", help="A part; all of them where none is named.", autocompletion=part_names
    ),
]
Start = Annotated[
    str,
    typer.Argument(
        metavar="KIND",
        help='"model", or a word of the name of a built-in scene, as "gear".',
        autocompletion=starts,
    ),
]
File = Annotated[Path, typer.Argument(metavar="FILE", help="The TOML file to write; it must not exist yet.")]


def parts(name: Name = None, own: Own = None) -> int:
    """List the parts that a scene of the kind "model" can name, or show one: formula, keys, an example."""
    from ..parts.text import every, one

    take_parts(own)
    tell(*(every() if name is None else one(name)).splitlines())
    return DONE


def new(kind: Start, file: File) -> int:
    """Write the commented start of a scene of your own."""
    from ..parts.start import write_start

    tell(f"written: {write_start(kind, file)}; run it with: orbitrace trace {file}")
    return DONE
