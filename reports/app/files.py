"""Writing results: every file is complete or not there, and a directory is tried before the work starts."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

from periodic.results.files import replacing
from symbolic.scenes.errors import InputError

from .interrupts import ignoring_interrupts

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
    with ignoring_interrupts():
        try:
            for name, writer in writers.items():
                with replacing(folder / name) as part:
                    writer(part)
        except OSError as error:
            raise unwritable(folder, error) from error
    return [folder / name for name in writers]
