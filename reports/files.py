"""Writing results: every file is complete or not there, and a directory is tried before the work starts."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from reports.errors import InputError
from reports.interrupts import unheard

INCOMPLETE = "incomplete"
"""Where a result goes that was cut short, beside an earlier one."""


def writable(folder: Path) -> Path:
    """Make a directory if need be and return it. Raises InputError if no file can be made in it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except (OSError, ValueError) as error:
        raise unwritable(folder, error) from error


def unwritable(folder: Path, error: OSError | ValueError) -> InputError:
    """Return the error of a directory that does not take files."""
    reason = getattr(error, "strerror", None) or str(error)
    return InputError("--out", f'is "{folder}" ({reason})', "it must be a directory that can be written to")


def write(folder: Path, writers: Mapping[str, Callable[[Path], object]]) -> list[Path]:
    """Write files by name, none of them by halves, and return them; no Ctrl-C is heard meanwhile.

    Raises InputError if one cannot be written.
    """
    with unheard():
        try:
            for name, writer in writers.items():
                with replacing(folder / name) as part:
                    writer(part)
        except OSError as error:
            raise unwritable(folder, error) from error
    return [folder / name for name in writers]


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a place to write to that becomes `path` in one move when the block ends without an error."""
    part = path.with_name(f".{os.getpid()}-{path.name}")
    try:
        yield part
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
