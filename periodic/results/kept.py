"""Arrays by key in a file: what long work has done so far, so that the same work goes on after a kill.

The file is an SQLite database with a row for each key: arrays (NumPy's npz, no objects) with their digest.
Whoever writes to it holds its lock from beginning to end.
"""

from __future__ import annotations

import io
import sqlite3
import warnings
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from periodic.results.database import bounded
from periodic.results.files import digest
from periodic.results.guarded import DamagedError, archive, regular
from periodic.results.journal import MAGIC, JournalError, locked

TABLE = "CREATE TABLE kept (key TEXT PRIMARY KEY, content BLOB NOT NULL, digest TEXT NOT NULL)"

Arrays = dict[str, np.ndarray[Any, Any]]


class StoreError(ValueError):
    """A store that is another file, damaged or in use; the message says which."""


class Kept:
    """The open file, used as a context manager.

    Parameters
    ----------
    path : Path
        The file.
    resume : bool
        Whether to use what it holds, instead of beginning anew.

    Raises
    ------
    StoreError
        For a file that is another one, a place where none can be, and a store in use.
    """

    def __init__(self, path: Path, resume: bool) -> None:
        self.path, self._warned = path, False
        self._base = _opened(path)
        try:
            self._begun(resume)
        except BaseException:
            self._base.close()
            raise

    def __enter__(self) -> Kept:
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(sqlite3.Error):  # a full disk was reported when it was written to
            self._base.close()

    def _begun(self, resume: bool) -> None:
        """Make the table where there is none. Raises StoreError for another database."""
        try:
            with bounded(self._base, self.path):
                there = self._base.execute("SELECT sql FROM sqlite_master").fetchall()
            if there not in ([], [(TABLE,)], [(TABLE,), (None,)]):
                raise StoreError(_foreign(self.path))
            if not there:
                self._base.execute(TABLE)
            elif not resume:
                self._base.execute("DELETE FROM kept")
        except (sqlite3.DatabaseError, UnicodeError) as error:
            raise StoreError(_foreign(self.path)) from error

    def get(self, key: str) -> Arrays | None:
        """Return what is kept under a key; None where there is nothing, or it is damaged."""
        with suppress(sqlite3.Error, UnicodeError, DamagedError), bounded(self._base, self.path):
            row = self._base.execute("SELECT content, digest FROM kept WHERE key = ?", (key,)).fetchone()
            if row and isinstance(row[0], bytes) and row[1] == digest(row[0]):
                return archive(row[0])
        return None

    def add(self, key: str, arrays: Mapping[str, np.ndarray[Any, Any]]) -> None:
        """Keep arrays under a key.

        Warns
        -----
        UserWarning
            Once, where the file cannot be written to: the work goes on.
        """
        memory = io.BytesIO()
        np.savez(memory, allow_pickle=False, **arrays)
        content = memory.getvalue()
        try:
            row = key, content, digest(content)
            self._base.execute("INSERT OR REPLACE INTO kept VALUES (?, ?, ?)", row)
            self._base.execute("COMMIT")
            self._base.execute("BEGIN IMMEDIATE")
        except sqlite3.Error as error:
            with suppress(sqlite3.Error):
                self._base.rollback()
                self._base.execute("BEGIN IMMEDIATE")
            self._warn(error)

    def _warn(self, error: Exception) -> None:
        if not self._warned:
            self._warned = True
            said = f"store {str(self.path)!r} cannot be written to ({error}); the work goes on without it"
            warnings.warn(said, stacklevel=2)


def _opened(path: Path) -> sqlite3.Connection:
    """The database with its write lock."""
    try:
        if path.exists():
            regular(path.stat())  # opening a pipe would wait for whoever writes to it
        with path.open("a+b") as file:  # SQLite does not say why a file cannot be made
            file.seek(0)
            if file.read(len(MAGIC)) not in (b"", MAGIC):
                raise StoreError(_foreign(path))
        return locked(path)
    except JournalError:
        raise StoreError(f"store is {str(path)!r}; something else is writing to it") from None
    except OSError as error:
        why = error.strerror or str(error)
        raise StoreError(f"store is {str(path)!r}, which cannot be written ({why})") from error


def _foreign(path: Path) -> str:
    return f"store is {str(path)!r}, which is another file or damaged; it is not written over"
