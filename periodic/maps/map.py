"""Numbers of many branches: the usual way in."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import closing, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from periodic.checks import whole
from periodic.display.meter import Advance, meter
from periodic.maps.adaptive import Adaptive
from periodic.maps.cell import Cell, Outcome
from periodic.maps.chunks import computed
from periodic.maps.dataset import check_numbers, dataset
from periodic.maps.grid import Grid, Plan
from periodic.maps.progress import Progress
from periodic.maps.store import Store
from periodic.maps.task import Task
from periodic.workers.execution import DIED, Execution, ExecutorGoneError
from periodic.workers.executors import Here, workers
from periodic.workers.parcel import packed

if TYPE_CHECKING:
    import xarray as xr

CHUNK = 8
"""Cells in a chunk: few are lost with it, but enough share its overhead and start from their neighbours."""


class MapStoppedError(RuntimeError):
    """A map whose executor went away; `found` is what there is of it."""

    def __init__(self, message: str, found: xr.Dataset) -> None:
        super().__init__(message)
        self.found = found


class MapInterrupted(KeyboardInterrupt):
    """Ctrl-C during a map; `found` is what there is of it."""

    def __init__(self, message: str, found: xr.Dataset) -> None:
        super().__init__(message)
        self.found = found


@dataclass
class Run:
    """A map under way: what is known of its cells, and where it is kept."""

    task: Task
    plan: Plan
    size: int
    store: Store | None
    progress: Callable[[Progress], None] | None
    found: dict[Cell, Outcome] = field(default_factory=dict)
    begun: float = field(default_factory=perf_counter)

    def through(self, execution: Execution[Cell, Outcome]) -> None:
        """Compute all cells that are not known yet."""
        known = len(self.found)
        with meter("mapping", "cells", self.plan.total) if self.progress is None else nullcontext() as show:
            self._through(execution, known, show or (lambda steps, said: None))

    def _through(self, execution: Execution[Cell, Outcome], known: int, show: Advance) -> None:
        show(known, "")
        for chunks in self.plan.rounds(self.found, self.size):
            missing = [tuple(cell for cell in chunk if cell not in self.found) for chunk in chunks]
            for outcomes in execution.outcomes([chunk for chunk in missing if chunk]):
                self._keep(outcomes)
                show(len(outcomes), "")
                if self.progress is not None:
                    self.progress(self._progress(known))

    def _keep(self, outcomes: Sequence[Outcome]) -> None:
        self.found |= {outcome.cell: outcome for outcome in outcomes}
        if self.store is not None:
            self.store.add(outcomes)
            if self.store.due():
                self.store.write(self.dataset(), complete=False)

    def dataset(self) -> xr.Dataset:
        """Return what is known."""
        return dataset(self.task, self.plan, self.found)

    def written(self) -> xr.Dataset:
        """Return what is known, after writing it."""
        data = self.dataset()
        if self.store is not None:
            computed = sum(not outcome.lost for outcome in self.found.values())
            self.store.write(data, complete=computed == self.plan.total)
        return data

    def _progress(self, known: int) -> Progress:
        elapsed, done = perf_counter() - self.begun, len(self.found)
        failed = sum(bool(outcome.reason) for outcome in self.found.values())
        rate = elapsed / (done - known) if done > known else float("inf")
        return Progress(done, self.plan.total, failed, elapsed, rate * max(self.plan.total - done, 0))

    def stopped(self, why: str) -> str:
        """Return a sentence about a map that is not complete."""
        kept = "" if self.store is None else f" and kept in {str(self.store.path)!r}; the same call goes on"
        return f"{why} after {len(self.found)} of {self.plan.total} cells, which are in its `found`{kept}"


def design_map(
    task: Task,
    grid: Mapping[str, Sequence[float]] | Grid | Adaptive,
    executor: Executor | int | None = None,
    store: str | Path | None = "map.nc",
    resume: bool = True,
    *,
    chunk: int = CHUNK,
    progress: Callable[[Progress], None] | None = None,
) -> xr.Dataset:
    """Return numbers of whole branches over a grid of parameters.

    Cells go in chunks of neighbours to processes, where each branch begins at the first orbit of the one
    before. Chunks do not depend on the executor, and so neither do the numbers.

    Parameters
    ----------
    task : Task
        What is traced in each cell, and what is read off it.
    grid : mapping of str to sequence of float, or Adaptive
        Values (SI) of each parameter that is varied: all combinations are computed. Or `Adaptive(...)`.
    executor : int or Executor, optional
        How many processes, by default one for each core; 1 computes in this process. Or any executor of
        `concurrent.futures`: `Client.get_executor()` of dask.distributed, `MPIPoolExecutor()` of
        mpi4py.futures.
    store : str or Path, optional
        The NetCDF file of the result; while cells are computed it is written now and then, and a journal
        beside it keeps each chunk as it is done. None for no file.
    resume : bool
        Whether to go on with what the store has of the same map, or to begin anew.
    chunk : int
        Cells in a chunk: what a killed run loses for each process.
    progress : callable, optional
        Called with a `Progress` after each chunk; `print` will do.

    Returns
    -------
    Dataset
        The numbers over the parameters, NaN where there is none; those of which a branch has several with a
        further dimension. status is done, failed or lost (its process died; it is tried again by the next
        call), reason says why; points, newton and seconds what it took.

    Raises
    ------
    ValueError
        In one sentence, for what is not allowed: unknown parameters, no values, a task that cannot travel.
    MapFileError
        For a store that is something else, holds another map, or is in use.
    MapStoppedError
        Where the executor goes away.
    MapInterrupted
        For Ctrl-C. Both have what there is so far as `found`; the same call goes on from the store.
    """
    if not isinstance(task, Task):
        raise ValueError(f"task is {task!r}; it must be a Task(system, parameter, bounds, numbers=...)")
    plan = grid if isinstance(grid, Grid | Adaptive) else Grid(grid)
    plan.check(task)
    check_numbers(task, plan.names)
    if not isinstance(resume, bool):
        raise ValueError(f"resume is {resume!r}; it must be True or False")
    if progress is not None and not callable(progress):
        raise ValueError(f"progress is {progress!r}; it must be a function of a Progress, as print is")
    size, where = whole("chunk", chunk), workers(executor)
    made = {**task.described(), "grid": plan.described()}
    keeping = nullcontext() if store is None else Store(_path(store), made, resume)
    parcel = task if isinstance(where, Here) else packed("task", task)
    with closing(where), keeping as kept:
        if kept is not None and kept.finished is not None:
            return kept.finished
        run = Run(task, plan, size, kept, progress, {} if kept is None else kept.found)
        return _through(run, Execution(where, lambda cells: (computed, parcel, plan.names, cells), _lost))


def _through(run: Run, execution: Execution[Cell, Outcome]) -> xr.Dataset:
    """Compute what is missing, and write and return all; also where that comes to an early end."""
    try:
        run.through(execution)
    except KeyboardInterrupt:
        data = run.written()
        raise MapInterrupted(run.stopped("interrupted"), data) from None
    except ExecutorGoneError as error:
        data = run.written()
        raise MapStoppedError(run.stopped(f"the executor went away ({error})"), data) from error
    return run.written()


def _lost(cell: Cell) -> Outcome:
    """What becomes of a cell that nothing has come back from."""
    return Outcome(cell, reason=DIED, lost=True)


def _path(store: object) -> Path:
    """The file of a store. Raises ValueError for what is no name."""
    if not (isinstance(store, str | os.PathLike) and Path(store).name and "\0" not in str(store)):
        raise ValueError(f"store is {store!r}; it must be the name of a file, or None")
    return Path(store)
