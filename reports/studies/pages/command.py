"""The command line of a study: `python -m reports.studies.NAME`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser
from collections.abc import Sequence
from pathlib import Path

from reports.app.console import telling
from reports.app.interrupts import Ended, interrupting_at_once
from reports.studies.pages.page import Page
from symbolic.scenes.errors import InputError

DONE, BAD_INPUT, INTERRUPTED = 0, 2, 130
"""Exit codes; the last is a shell's own for a program that Ctrl-C ended."""


def command(page: Page, arguments: Sequence[str] | None = None) -> int:
    """Compute a page, or some of its sections, and return the exit code.

    Each section is kept as soon as it is done, and Ctrl-C keeps those.
    """
    parser = ArgumentParser(prog=f"python -m reports.studies.{page.name}", description="Compute the page.")
    chosen = parser.add_mutually_exclusive_group()
    every = tuple(page.sections)
    chosen.add_argument("--only", choices=every, nargs="+", help="compute these sections, keep the others")
    chosen.add_argument("--stale", action="store_true", help="compute those whose engine has changed since")
    parser.add_argument("--out", type=Path, default=page.folder, metavar="DIR", help="where the page goes")
    given = parser.parse_args(arguments)
    try:
        names = page.stale(given.out) if given.stale else given.only or every
        folder = page.ready(given.out, names)
        with interrupting_at_once(), telling("computing") as tell:
            written = page.make(folder, names, tell)
    except InputError as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return BAD_INPUT
    except (Ended, KeyboardInterrupt):
        print(f"interrupted; the sections computed so far are in {given.out}", file=sys.stderr)
        return INTERRUPTED
    print(f"written: {written}")
    return DONE
