"""What a terminal shows of any work: what is being done on standard error, tables on standard output.

Piped, nothing moves and tables are plain text.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from periodic.checks import plain

if TYPE_CHECKING:
    from rich.text import Text

WIDE = 1000
"""Columns of a table that is not on a terminal: no line of it is broken."""


@contextmanager
def status(text: str) -> Iterator[Callable[[str], None] | None]:
    """Give what changes the text shown, or None where standard error is no terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console

    with Console(stderr=True).status(_text(text)) as shown:
        yield lambda new: shown.update(_text(new))


@contextmanager
def counting(what: str, total: int) -> Iterator[Callable[[object], None] | None]:
    """Give the callback that counts what is done, or None where standard error is no terminal."""
    with status(what) as update:
        done = 0

        def count(_: object) -> None:
            nonlocal done
            done += 1
            assert update is not None
            update(f"{what}: {done} of {total}")

        yield count if update else None


@contextmanager
def telling(what: str) -> Iterator[Callable[[str], None]]:
    """Give the callback that says on standard error what is being worked on; piped, one line for each."""
    with status(what) as update:
        say = update or (lambda text: print(plain(text), file=sys.stderr, flush=True))
        yield lambda step: say(f"{what} {step}")


def table(headings: Sequence[str], rows: Sequence[Sequence[str]], left: str) -> None:
    """Print a table, the column of the heading `left` flush left; piped as plain text of full width."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    terminal = sys.stdout.isatty()
    shown = Table(box=box.SIMPLE_HEAD if terminal else None, pad_edge=terminal)
    for heading in headings:
        shown.add_column(_text(heading), justify="left" if heading == left else "right", no_wrap=not terminal)
    for row in rows:
        shown.add_row(*map(_cell, row))
    Console(highlight=False, width=None if terminal else WIDE).print(shown)


def _text(text: str) -> Text:
    """A text as it is, in which neither the terminal nor Rich finds commands."""
    from rich.text import Text

    return Text(plain(text))


def _cell(text: str) -> Text:
    """A text of several lines as it is, where names have none of their own."""
    from rich.text import Text

    return Text("\n").join(map(_text, text.split("\n")))
