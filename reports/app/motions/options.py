"""Options of searches, which `motions` and `atlas` have in common; nothing large is imported here."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from ..options import pairs

Box = Annotated[
    list[str] | None,
    typer.Option(
        "--box", metavar="STATE=LOW:HIGH", help="Where motions start, SI. [default: wide about rest]"
    ),
]
Periods = Annotated[
    int, typer.Option("--periods", metavar="N", help="Periods after which motions come back, at the most.")
]
Starts = Annotated[int, typer.Option("--starts", metavar="N", help="Motions that start at random.")]
Jobs = Annotated[
    int, typer.Option("--jobs", metavar="N", help="Processes; 1 is this one, on all cores where compiled.")
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with the search in DIR; all else as it was.")]

STORE = "search.db"
"""File of what a search has done, in its directory."""

Ranges = dict[str, tuple[float, float]]


def ranges(given: Sequence[str] | None) -> Ranges:
    """Return the ranges of --box. Raises InputError."""
    return {name: _range(name, text) for name, text in pairs(given, "--box", "STATE=LOW:HIGH, as in x=-1:1")}


def _range(name: str, text: str) -> tuple[float, float]:
    from symbolic.scenes.errors import refused

    ends = text.split(":")
    try:
        low, high = map(float, ends)
    except ValueError:
        raise refused("--box", f"{name}={text}", "STATE=LOW:HIGH, as in x=-1:1") from None
    return low, high
