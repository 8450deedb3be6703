"""What a trace has done so far, step by step in a file: no more than a step is lost if its process is killed.

The file is an SQLite database with a row for each step: its points, why they end and where the run stands, as
arrays (NumPy's npz, no objects), with their digest. A trace holds the write lock from its beginning to its
end; others read meanwhile the steps that are complete.
"""

from __future__ import annotations

import errno
import io
import json
import os
import sqlite3
import tempfile
import warnings
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from periodic.results.branch import Branch
from periodic.results.brancharrays import DAMAGE, attributes, record_of, tables
from periodic.results.checkpoint import Checkpoint
from periodic.results.database import bounded
from periodic.results.files import digest
from periodic.results.guarded import archive, regular
from periodic.results.halves import Half, joined
from periodic.results.netcdf import BranchFileError
from periodic.results.point import Point
from periodic.results.record import Record
from periodic.results.signals import deferred
from periodic.results.stop import Stop

TABLE = "CREATE TABLE steps (number INTEGER PRIMARY KEY, content BLOB NOT NULL, digest TEXT NOT NULL)"

PATIENCE = 5000
"""How long (ms) a step waits for somebody who reads the journal."""

PAGE = 512
"""Page size in bytes: small, so that a damaged file is readable up to the damage."""


MAGIC = b"SQLite format 3\0"
"""How the files begin that are databases."""


class JournalError(BranchFileError):
    """A journal that another trace is writing to."""


class Journal:
    """An open journal, used as a context manager; what the file held before stays until the first step.

    Parameters
    ----------
    path : Path
        The file.
    empty : Branch
        The branch that the points will belong to, still without any.

    Raises
    ------
    JournalError
        For a file that another trace is writing to.
    OSError
        For one that cannot be made.
    """

    def __init__(self, path: Path, empty: Branch) -> None:
        self._empty, self._path = empty, path
        self._steps, self._broken = 0, False
        if path.exists():
            regular(path.stat())  # opening a pipe would wait for whoever reads it
        with path.open("ab"):
            pass  # SQLite does not say why a file cannot be made
        with path.open("rb") as file:
            begin = file.read(len(MAGIC))
        if begin not in (b"", MAGIC):
            raise JournalError(f"journal is {str(path)!r}; it is another file, which is not written over")
        self._base = locked(path)

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with suppress(sqlite3.Error):  # a full disk was reported when it was written to
            self._base.close()

    def add(self, points: Sequence[Point], stop: Stop, checkpoint: Checkpoint | None) -> None:
        """Add points that a run has completed; interrupts wait until it is done.

        Parameters
        ----------
        points : sequence of Point
            Those that came after the last call, or with another run.
        stop : Stop
            Why the run ends, or would if it ended there.
        checkpoint : Checkpoint, optional
            Where it stands; without one the run has not begun.

        Warns
        -----
        UserWarning
            Once, where the file cannot be written to: the trace goes on without it.
        """
        with deferred():
            checkpoints = () if checkpoint is None else (checkpoint,)
            content = _bytes(replace(self._empty, points=tuple(points), stop=stop, checkpoints=checkpoints))
            if self._broken:
                return
            try:
                self._write(content)
            except (sqlite3.Error, OSError) as error:
                self._broken = True
                with suppress(sqlite3.Error):
                    self._base.rollback()
                why = f"the journal {str(self._path)!r} cannot be written to ({self._reason(error, content)})"
                warnings.warn(f"{why}; the trace goes on without it", stacklevel=2)

    def _write(self, content: bytes) -> None:
        if self._steps == 0:
            self._emptied()
        row = (self._steps, content, digest(content))
        self._base.execute("INSERT INTO steps VALUES (?, ?, ?)", row)
        self._base.execute("COMMIT")
        self._base.execute("BEGIN IMMEDIATE")
        self._steps += 1

    def _emptied(self) -> None:
        """Begin anew, in one transaction with the first step; a file that is no journal is replaced."""
        try:
            if _schema(self._base):
                self._base.execute("DROP TABLE steps")
        except (sqlite3.DatabaseError, BranchFileError, UnicodeError) as error:
            if isinstance(error, sqlite3.OperationalError):
                raise
            self._base.close()
            self._path.unlink()
            self._base = locked(self._path)
        self._base.execute(TABLE)

    def _reason(self, error: Exception, content: bytes) -> str:
        """Why the operating system refuses to write the file: SQLite says only that it failed."""
        if getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_FULL:
            return os.strerror(errno.ENOSPC)
        try:
            with tempfile.TemporaryFile(dir=self._path.parent) as probe:
                probe.write(bytes(self._path.stat().st_size + len(content)))
        except OSError as reason:
            return reason.strerror or str(reason)
        return str(error)


def locked(path: Path) -> sqlite3.Connection:
    """Return a connection with the write lock, or one without where the first step will replace the file.

    Parameters
    ----------
    path : Path
        The file of a journal.

    Returns
    -------
    sqlite3.Connection
        In a transaction.

    Raises
    ------
    JournalError
        Where somebody else has the lock.
    """
    base = sqlite3.connect(path, timeout=0.0, isolation_level=None)
    try:
        base.execute(f"PRAGMA page_size = {PAGE}")
        base.execute("PRAGMA synchronous = OFF")  # a process that is killed loses nothing that it has written
        base.execute("BEGIN IMMEDIATE")
        base.execute(f"PRAGMA busy_timeout = {PATIENCE}")
    except (sqlite3.DatabaseError, UnicodeError) as error:  # of damage SQLite speaks in its own bytes
        if getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_BUSY:
            base.close()
            raise JournalError(f"journal is {str(path)!r}; another trace is writing to it") from None
    return base


def _schema(base: sqlite3.Connection) -> bool:
    """Whether a database is a journal, not an empty file. Raises BranchFileError if it is something else."""
    found = base.execute("SELECT sql FROM sqlite_master").fetchall()
    if found not in ([], [(TABLE,)]):
        raise BranchFileError("it is damaged or not a journal")
    return bool(found)


def recovered(path: str | Path) -> Branch:
    """Return the branch of a journal, as if it had been interrupted after its last complete step.

    Parameters
    ----------
    path : str or Path
        The file, which may still be written to.

    Returns
    -------
    Branch
        For `trace` to take up.

    Raises
    ------
    BranchFileError
        In one sentence, for a file that is no journal or holds no step.
    """
    try:
        regular(Path(path).stat())
        with Path(path).open("rb"):
            pass
        with np.errstate(all="ignore"):
            pieces = list(_pieces(Path(path)))
    except OSError as error:
        raise BranchFileError(f"journal is {str(path)!r}; it cannot be read ({error.strerror})") from error
    except (sqlite3.Error, zipfile.BadZipFile, *DAMAGE) as error:
        raise BranchFileError(f"journal is {str(path)!r}; it is damaged or not a journal") from error
    if not pieces:
        raise BranchFileError(f"journal is {str(path)!r}; it holds no complete step")
    halves: list[Half] = []
    for piece in pieces:
        checkpoint = piece.checkpoints[0] if piece.checkpoints else None
        before = halves[-1] if halves else None
        if before is None or (before.checkpoint and checkpoint and before.checkpoint.sign != checkpoint.sign):
            halves.append(Half(piece.points, piece.stop, checkpoint))
        else:
            halves[-1] = Half([*before.points, *piece.points], piece.stop, checkpoint)
    return joined(pieces[0].parameter, pieces[0].layout, halves, pieces[0].made)


def _pieces(path: Path) -> Iterator[Record]:
    """The steps of a journal up to the first that is not whole."""
    with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=rw", uri=True)) as base:
        base.execute("PRAGMA trusted_schema = OFF")
        base.execute("PRAGMA writable_schema = ON")  # or a file that was cut short would not be read at all
        with bounded(base, path):
            yield from _steps(base)


def _steps(base: sqlite3.Connection) -> Iterator[Record]:
    if _schema(base):
        rows = base.execute("SELECT number, content, digest FROM steps ORDER BY number")
        with suppress(sqlite3.DatabaseError):
            for count, (number, content, seal) in enumerate(rows):
                if number != count or not isinstance(content, bytes) or seal != digest(content):
                    return
                yield unpacked(archive(content, len(content)))


def _bytes(piece: Record) -> bytes:
    memory = io.BytesIO()
    np.savez(memory, allow_pickle=False, **packed(piece))
    return memory.getvalue()


def packed(piece: Record) -> dict[str, np.ndarray[Any, Any]]:
    """Return a record as arrays by name, none of objects."""
    said = np.frombuffer(json.dumps(attributes(piece)).encode(), dtype=np.uint8)
    return {"said": said, **{name: array for name, (_, array) in tables(piece).items()}}


def unpacked(arrays: Mapping[str, np.ndarray[Any, Any]]) -> Record:
    """Return the record of such arrays, bit for bit."""
    return record_of(arrays, json.loads(arrays["said"].tobytes()))
