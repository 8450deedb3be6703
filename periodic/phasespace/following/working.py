"""Where searches are done, and where what they have done is kept."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import closing, contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

from periodic.results.kept import Kept
from periodic.workers.executors import Here, Workers, workers


@dataclass(frozen=True, eq=False)
class Work:
    """Who follows motions besides this process, if anybody, and where they are kept, if anywhere."""

    workers: Workers | None = None
    kept: Kept | None = None


HERE = Work()

_WORK: ContextVar[Work] = ContextVar("work", default=HERE)


class WorkStoppedError(RuntimeError):
    """An executor that went away during a search; the message says what is left of it."""


def work() -> Work:
    """Return where searches are done now."""
    return _WORK.get()


@contextmanager
def working(
    executor: Executor | int = 1, store: str | Path | None = None, resume: bool = True
) -> Iterator[None]:
    """Let searches within it go on after a kill, and on other processes or machines.

    ``with per.working(store="search.db"): per.motions(...)``: whatever is followed and completed is kept as
    soon as it is done, so that the same calls, after a kill, go on from there; the numbers are those of one
    run, bit for bit. Any number of calls of `motions`, `basins`, `atlas` and `lyapunov` share a file.

    Parameters
    ----------
    executor : int or Executor
        How many processes follow motions; with 1 this process does, on all its cores where it is compiled.
        Or any executor of `concurrent.futures`: `Client.get_executor()` of dask.distributed,
        `MPIPoolExecutor()` of mpi4py.futures. Numbers do not depend on it.
    store : str or Path, optional
        The file; it stays, and can be deleted when it is not wanted any more.
    resume : bool
        Whether to use what the file has, or to begin anew.

    Yields
    ------
    None
        While it holds.

    Raises
    ------
    ValueError
        For what is not allowed.
    StoreError
        For a store that is another file, damaged or in use.
    """
    if executor is None:
        raise ValueError("executor is None; it must be a number of processes or an executor")
    if not isinstance(resume, bool):
        raise ValueError(f"resume is {resume!r}; it must be True or False")
    where = workers(executor)
    with closing(where), nullcontext() if store is None else Kept(_path(store), resume) as kept:
        before = _WORK.set(Work(None if isinstance(where, Here) else where, kept))
        try:
            yield
        finally:
            _WORK.reset(before)


def _path(store: object) -> Path:
    """The file of a store. Raises ValueError for what is no name."""
    if not (isinstance(store, str | os.PathLike) and Path(store).name and "\0" not in str(store)):
        raise ValueError(f"store is {store!r}; it must be the name of a file, or None")
    return Path(store)
