"""The file of a map: a NetCDF file, and beside it, until all cells are computed, a journal of its chunks.

The journal is an SQLite database with a row for each chunk and a first one that says of which map. Whoever
computes a map holds its write lock from beginning to end.
"""

from __future__ import annotations

import json
import sqlite3
import warnings
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.maps.cell import Cell, Outcome
from periodic.maps.dataset import RECORDED
from periodic.results.brancharrays import DAMAGE
from periodic.results.database import bounded
from periodic.results.described import differences
from periodic.results.files import digest, replacing
from periodic.results.guarded import content
from periodic.results.hdf import opened
from periodic.results.journal import MAGIC, JournalError, locked
from periodic.results.netcdf import LARGEST, packed, sound

if TYPE_CHECKING:
    import xarray as xr

FORMAT = "orbitrace map 1"
"""What a file of a map says it is."""

OWN = ("format", "made", "complete")
"""Attributes of the file that the result has not."""

TABLE = """CREATE TABLE IF NOT EXISTS chunks
    (number INTEGER PRIMARY KEY, content TEXT NOT NULL, digest TEXT NOT NULL)"""

RARELY = 20.0
"""Least time between two writes, over the time that a write takes."""

LEAST_SECONDS = 10.0
"""Least time between two writes (s)."""


class MapFileError(ValueError):
    """A store that is no file of this map, or that another map is writing to; the message says which."""


class Store:
    """The open store of a map, used as a context manager.

    Parameters
    ----------
    path : Path
        The file.
    made : dict
        What the map is made of, as plain data.
    resume : bool
        Whether to go on with what is there of the same map, instead of beginning anew.

    Raises
    ------
    MapFileError
        For what is there and is not of this map, a place where no file can be, and a store in use.
    """

    def __init__(self, path: Path, made: dict[str, Any], resume: bool) -> None:
        self.path, self._made = path, made
        self._journal = path.with_name(f"{path.name}.journal")
        self._pending: list[str] = []
        self._warned, self._written, self._cost = False, perf_counter(), 0.0
        self.found: dict[Cell, Outcome] = {}
        self.finished: xr.Dataset | None = None
        self._base = self._opened()
        try:
            self._begun(resume)
        except BaseException:
            self._base.close()
            if self._journal.stat().st_size == 0:
                self._journal.unlink()
            raise

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(sqlite3.Error):  # a full disk was reported when it was written to
            self._base.close()

    def _opened(self) -> sqlite3.Connection:
        """Connect to the journal with the write lock."""
        for path in (self.path, self._journal):
            if path.exists() and not path.is_file():
                raise MapFileError(f"store is {str(self.path)!r}, which is no ordinary file; choose another")
        try:
            with self._journal.open("a+b") as file:  # SQLite does not say why a file cannot be made
                file.seek(0)
                if file.read(len(MAGIC)) not in (b"", MAGIC):
                    raise MapFileError(_foreign(self._journal))
            return locked(self._journal)
        except JournalError:
            raise MapFileError(f"store is {str(self.path)!r}; another map is writing to it") from None
        except OSError as error:
            why = error.strerror or str(error)
            raise MapFileError(f"store is {str(self.path)!r}, which cannot be written ({why})") from error

    def _begun(self, resume: bool) -> None:
        """Take what is there, or make room."""
        there = loaded(self.path) if self.path.exists() else None
        if resume and there is not None:
            self._check(_said(there, self.path))
            if there.attrs.get("complete"):
                self.finished = there.drop_attrs(deep=False).assign_attrs(
                    {key: value for key, value in there.attrs.items() if key not in OWN}
                )
                self._journal.unlink(missing_ok=True)
                return
        rows = list(self._rows()) if resume else []
        if rows:
            self._check(rows[0])
            self.found = self._outcomes(rows[1:])
        else:
            self._emptied()

    def _check(self, before: Any) -> None:
        """Refuse a map that is made of something else."""
        if not isinstance(before, dict):
            raise MapFileError(_foreign(self.path))
        if found := differences(before, self._made):
            raise MapFileError(
                f"store is {str(self.path)!r}, which holds a map made with {'; and with '.join(found)}; "
                f"choose another, or resume=False to replace it"
            )

    def _outcomes(self, rows: list[Any]) -> dict[Cell, Outcome]:
        """What became of the cells of some rows. Raises MapFileError where they say something else."""
        try:
            outcomes = [Outcome.of(plain) for row in rows for plain in row]
            asked = tuple(f"{name} " for name in self._made["numbers"])
            for name in (name for outcome in outcomes for name in outcome.numbers):
                if not f"{name} ".startswith(asked):
                    raise ValueError(f"{name} is no number of the map")
            return {outcome.cell: outcome for outcome in outcomes if not outcome.lost}
        except DAMAGE as error:
            raise MapFileError(_foreign(self._journal)) from error

    def _rows(self) -> Iterator[Any]:
        """The rows up to the first that is not whole."""
        with suppress(sqlite3.DatabaseError, *DAMAGE), bounded(self._base, self._journal):
            rows = self._base.execute("SELECT number, content, digest FROM chunks ORDER BY number")
            for count, (number, content, seal) in enumerate(rows):
                if number != count or not isinstance(content, str) or seal != digest(content.encode()):
                    return
                yield json.loads(content)

    def _emptied(self) -> None:
        try:
            self._base.execute("DROP TABLE IF EXISTS chunks")
        except (sqlite3.DatabaseError, UnicodeError) as error:
            if not isinstance(error, sqlite3.OperationalError):  # damaged, not a disk that is full
                self._base.close()
                self._journal.unlink()
                self._base = locked(self._journal)
        self._add(self._made)

    def add(self, outcomes: Iterable[Outcome]) -> None:
        """Keep the outcomes of a chunk; where that fails they are kept with those of the next one.

        Parameters
        ----------
        outcomes : iterable of Outcome
            What became of its cells.

        Warns
        -----
        UserWarning
            Once, where the file cannot be written to.
        """
        self._add([outcome.plain() for outcome in outcomes])

    def _add(self, content: Any) -> None:
        self._pending.append(json.dumps(content))
        try:
            self._base.execute(TABLE)
            (count,) = self._base.execute("SELECT COUNT(*) FROM chunks").fetchone()
            rows = [(count + k, text, digest(text.encode())) for k, text in enumerate(self._pending)]
            self._base.executemany("INSERT INTO chunks VALUES (?, ?, ?)", rows)
            self._base.execute("COMMIT")
            self._base.execute("BEGIN IMMEDIATE")
            self._pending.clear()
        except (sqlite3.Error, UnicodeError) as error:
            with suppress(sqlite3.Error, UnicodeError):
                self._base.rollback()
                self._base.execute("BEGIN IMMEDIATE")
            self._warn(error)

    def due(self) -> bool:
        """Whether it is time to write what there is so far."""
        return perf_counter() - self._written > max(LEAST_SECONDS, RARELY * self._cost)

    def write(self, data: xr.Dataset, complete: bool) -> None:
        """Write the NetCDF file, in one move; when it is complete the journal goes.

        Parameters
        ----------
        data : Dataset
            What there is of the map.
        complete : bool
            Whether all its cells are computed.

        Warns
        -----
        UserWarning
            Where it cannot be written.
        """
        begun = perf_counter()
        attributes = {"format": FORMAT, "made": json.dumps(self._made), "complete": int(complete)}
        content = packed(data.assign_attrs(attributes))
        try:
            with replacing(self.path) as part:
                part.write_bytes(content)
            if complete:
                self._journal.unlink(missing_ok=True)
        except OSError as error:
            self._warn(error)
        self._written, self._cost = perf_counter(), perf_counter() - begun

    def _warn(self, error: Exception) -> None:
        why = getattr(error, "strerror", None) or str(error)
        if not self._warned:
            self._warned = True
            warnings.warn(
                f"store {str(self.path)!r} cannot be written to ({why}); the map goes on and is "
                f"returned whole, and what is missing is written when that is possible",
                stacklevel=2,
            )


def loaded(path: Path) -> xr.Dataset:
    """Return the map that a file holds. Raises MapFileError for any other file."""
    try:
        held = content(path, LARGEST)
        if sound(held):
            with np.errstate(all="ignore"), opened(held) as data:
                if data.attrs.get("format") == FORMAT and _told(data.load()):
                    return data
    except (OSError, *DAMAGE) as error:
        raise MapFileError(_foreign(path)) from error
    raise MapFileError(_foreign(path))


def _told(data: xr.Dataset) -> bool:
    """Whether a map says what became of its cells, in lines that a terminal shows and does not obey."""
    columns = list(data.variables.values())
    said = [
        text for attrs in (data.attrs, *(c.attrs for c in columns)) for pair in attrs.items() for text in pair
    ]
    held = [text for column in columns if column.dtype.kind in "OU" for text in column.values.ravel()]
    texts = (*data.variables, *data.dims, *said, *held)
    return set(RECORDED) <= set(data) and all(text.isprintable() for text in texts if isinstance(text, str))


def _said(there: xr.Dataset, path: Path) -> Any:
    """What the map of a file is made of. Raises MapFileError where it does not say."""
    try:
        return json.loads(there.attrs["made"])
    except DAMAGE as error:
        raise MapFileError(_foreign(path)) from error


def _foreign(path: Path) -> str:
    return f"store has {str(path)!r}, which is another file or damaged; it is not written over"
