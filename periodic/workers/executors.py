"""Where chunks are computed: here, in processes of our own, or wherever a given executor computes."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from typing import Any, Protocol

from periodic.checks import whole
from periodic.workers.cores import cores

CHUNKS_AHEAD = 10_000
"""Chunks given to a user's executor before the first is done: more than it has workers."""

THREADS = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)
"""What processes of our own have in their environment."""


PAUSE = 1.0
"""Seconds between two looks at whether the parent of a process is there."""


class Workers(Protocol):
    """What computes chunks."""

    @property
    def ahead(self) -> int:
        """Number of chunks that are submitted before the first is done."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Give it work."""

    @property
    def own(self) -> bool:
        """Whether they are our own processes: after one has died `close` lets new ones start."""

    def close(self) -> None:
        """Release its own resources; work under way is given up."""


class Here:
    """This process, one chunk after the other."""

    ahead, own = 1, False

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Compute, and return the finished future."""
        done: Future[Any] = Future()
        try:
            done.set_result(function(*arguments))
        except Exception as error:
            done.set_exception(error)
        return done

    def close(self) -> None:
        """There is nothing to release."""


class Processes:
    """Processes of our own by loky, with one thread each, started when there is work."""

    own = True

    def __init__(self, count: int) -> None:
        self.count = count
        self._pool: Executor | None = None

    @property
    def ahead(self) -> int:
        """Two for each process: the next chunk is there when one is done."""
        return 2 * self.count

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Give them work."""
        if self._pool is None:
            from loky import ProcessPoolExecutor

            _tracked()
            self._pool = ProcessPoolExecutor(
                self.count, env=THREADS, initializer=_dependent, initargs=(os.getpid(),)
            )
        return self._pool.submit(function, *arguments)

    def close(self) -> None:
        """End the processes."""
        if self._pool is not None:
            self._pool.shutdown(wait=True, kill_workers=True)  # type: ignore[call-arg]
            self._pool = None


class Given:
    """A user's executor, as of dask.distributed or mpi4py.futures; it is not shut down."""

    ahead, own = CHUNKS_AHEAD, False

    def __init__(self, executor: Executor) -> None:
        self._executor = executor
        self._under_way: set[Future[Any]] = set()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Give it work."""
        future = self._executor.submit(function, *arguments)
        self._under_way.add(future)
        future.add_done_callback(self._under_way.discard)
        return future

    def close(self) -> None:
        """Cancel what it has not begun."""
        for future in list(self._under_way):
            future.cancel()


def _tracked() -> None:
    """Start loky's resource tracker with SIGHUP blocked, so that a closed terminal does not end it.

    The tracker inherits the mask; in this process a signal that came meanwhile is delivered afterwards.
    """
    from loky.backend import resource_tracker

    if not hasattr(signal, "pthread_sigmask"):
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGHUP})
    try:
        resource_tracker.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _dependent(parent: int) -> None:
    """Leave Ctrl-C and a closed terminal to the process that has the map, and end when that has ended.

    parent: its process id, given by itself, as it may have ended before this process can ask for it.
    """
    for name in ("SIGINT", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    """End this process once its parent has: loky's would wait for work for ever."""
    while os.getppid() == parent:
        time.sleep(PAUSE)
    os._exit(1)


def workers(executor: Executor | int | None) -> Workers:
    """Return what computes chunks: a process for each core by default, 1 for this process.

    Raises ValueError for what is neither a number of processes nor an executor.
    """
    if isinstance(executor, Executor):
        return Given(executor)
    if executor is not None and (isinstance(executor, bool) or not isinstance(executor, int)):
        raise ValueError(
            f"executor is {executor!r}; it must be a number of processes or a concurrent.futures.Executor, "
            f"as Client.get_executor() of dask.distributed and MPIPoolExecutor() of mpi4py.futures are"
        )
    count = cores() if executor is None else whole("executor", executor)
    return Here() if count == 1 else Processes(count)


def died(error: BaseException) -> bool:
    """Whether an exception tells that a worker died, and not that its work failed."""
    return isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker"
