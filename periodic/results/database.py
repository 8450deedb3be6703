"""Databases of SQLite that anybody may have made, read within bounds."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

STRIDE = 1000
"""Instructions of SQLite between two looks at how many there were: fewer than a file has bytes, by far."""

LEAST_LENGTH = 10_000
"""Bytes of the longest text that a database of any size may hold, that of a command included."""


@contextmanager
def bounded(base: sqlite3.Connection, path: Path) -> Iterator[None]:
    """Read no more of a database than it has: its pages may lead round in circles, or to one another.

    Parameters
    ----------
    base : sqlite3.Connection
        The database.
    path : Path
        Its file.

    Yields
    ------
    None
        While that holds; what would go beyond raises sqlite3.Error.
    """
    size = path.stat().st_size
    left = iter(range(size // STRIDE + 100))
    base.set_progress_handler(lambda: next(left, None) is None, STRIDE)
    before = base.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, max(size, LEAST_LENGTH))
    try:
        yield
    finally:
        base.set_progress_handler(None, 0)
        base.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, before)
