"""What a trace has done so far, step by step in a file: no more than a step is lost if its process is killed.

The file is a row of frames: length and SHA-256 of a text and arrays (NumPy's npz, no objects). A frame that
was not written to its end is not read. While a trace writes to it the file is locked.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import signal
import struct
import threading
import warnings
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any, BinaryIO, cast

import numpy as np

from periodic import storage
from periodic.branch import Branch, BranchFileError
from periodic.halves import Half, joined
from periodic.point import Point
from periodic.stop import Reason, Stop

try:
    import fcntl
except ImportError:  # where there are no such locks two traces into one journal are not told apart
    fcntl = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from periodic.continuation import Run

HEAD = struct.Struct("<Q32s")
"""Length and digest of a frame."""


ENDING = (signal.SIGINT, signal.SIGTERM)


class JournalError(BranchFileError):
    """A journal that another trace is writing to."""


class Journal:
    """An open journal, used as a context manager; what the file held before stays until the first step.

    `empty` is the branch that its points will belong to. Raises JournalError for a file in use, OSError for
    one that cannot be made.
    """

    def __init__(self, path: Path, empty: Branch) -> None:
        self._empty, self._path = empty, path
        self._part = path.with_name(f".{os.getpid()}-{path.name}")
        self._guard = _locked(path, "ab")
        try:
            self._file = _locked(self._part, "wb")
        except (OSError, JournalError):
            self._guard.close()
            raise
        self._broken = False

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for file in (self._file, self._guard):
            with suppress(OSError):  # what a full disk has not taken was told when it was written
                file.close()
        self._part.unlink(missing_ok=True)

    def add(self, run: Run, points: Sequence[Point]) -> None:
        """Add points that a run has completed, and where it stands; interrupts wait until it is done."""
        with _uninterrupted():
            self._add(run, points)

    def _add(self, run: Run, points: Sequence[Point]) -> None:
        stop = run.stop or Stop(Reason.INTERRUPTED, f"after {len(run.collected)} points")
        checkpoints = () if run.checkpoint is None else (run.checkpoint,)
        piece = replace(self._empty, points=tuple(points), stop=stop, checkpoints=checkpoints)
        payload = _packed(piece)
        if self._broken:
            return
        try:
            self._file.write(HEAD.pack(len(payload), hashlib.sha256(payload).digest()) + payload)
            self._file.flush()
            if self._part.exists():
                self._part.replace(self._path)
        except OSError as error:
            self._broken = True
            why = f"the journal {str(self._path)!r} cannot be written to ({error.strerror})"
            warnings.warn(f"{why}; the trace goes on without it", stacklevel=2)


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Inside the block signals that end a program wait; their handlers are called after it."""
    if threading.current_thread() is not threading.main_thread():  # only that one is interrupted
        yield
        return
    heard: list[tuple[int, FrameType | None]] = []
    before = {each: signal.signal(each, lambda *at: heard.append(at)) for each in ENDING}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler or signal.SIG_DFL)
    for number, frame in heard[:1]:
        handler = before[signal.Signals(number)]
        if callable(handler):
            handler(number, frame)
        elif handler == signal.SIG_DFL:
            signal.raise_signal(number)


def _locked(path: Path, mode: str) -> BinaryIO:
    """Open a file that no other trace has open."""
    file = cast(BinaryIO, path.open(mode))
    try:
        if fcntl is not None:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise JournalError(f"journal is {str(path)!r}; another trace is writing to it") from None
    return file


def recovered(path: str | Path) -> Branch:
    """Return the branch of a journal, as if it had been interrupted after its last complete step.

    Raises BranchFileError for a file that holds no step.
    """
    try:
        pieces = list(_pieces(Path(path).read_bytes()))
    except OSError as error:
        raise BranchFileError(f"journal is {str(path)!r}; it cannot be read ({error.strerror})") from error
    except (*storage.DAMAGE, zipfile.BadZipFile) as error:
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


def _packed(piece: Branch) -> bytes:
    memory, arrays = io.BytesIO(), storage.tables(piece)
    dimensions = {name: list(dims) for name, (dims, _) in arrays.items()}
    said = {"attributes": storage.attributes(piece), "dimensions": dimensions}
    text = np.frombuffer(json.dumps(said).encode(), dtype=np.uint8)
    np.savez(memory, allow_pickle=False, said=text, **{name: values for name, (_, values) in arrays.items()})
    return memory.getvalue()


def _pieces(data: bytes) -> Iterator[Branch]:
    place = 0
    while place + HEAD.size <= len(data):
        length, digest = HEAD.unpack_from(data, place)
        payload = data[place + HEAD.size : place + HEAD.size + length]
        if hashlib.sha256(payload).digest() != digest:
            return
        yield _unpacked(payload)
        place += HEAD.size + length


def _unpacked(payload: bytes) -> Branch:
    with np.load(io.BytesIO(payload), allow_pickle=False) as arrays:
        said: dict[str, Any] = json.loads(arrays["said"].tobytes())
        tables = {name: (tuple(dims), arrays[name]) for name, dims in said["dimensions"].items()}
    import xarray as xr  # takes longer to import than all else

    return storage.branch_of(xr.Dataset(tables, attrs=said["attributes"]))
