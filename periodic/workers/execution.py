"""Chunks go out to workers and outcomes come back, whatever dies on the way."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Future
from dataclasses import dataclass
from queue import SimpleQueue
from typing import Any, Generic, TypeVar

from periodic.workers.executors import Workers, died

Cell = TypeVar("Cell")
Outcome = TypeVar("Outcome")

Chunk = tuple[Cell, ...]

DIED = "the process that computed it died"
"""The reason of a cell that nothing has come back from."""


class ExecutorGoneError(RuntimeError):
    """The executor takes no more work; the message says why."""


@dataclass
class Execution(Generic[Cell, Outcome]):
    """Chunks of cells that are computed by workers, as many at a time as they take.

    work: what a chunk is submitted as, a function and its arguments, that returns the outcomes of its cells.
    lost: the outcome of a cell that has none.

    A chunk whose worker died is computed again cell by cell: the cell at which a worker dies again is lost.
    Processes of our own all die together: there each chunk under way is first computed again by itself.
    """

    workers: Workers
    work: Callable[[Chunk[Cell]], tuple[Any, ...]]
    lost: Callable[[Cell], Outcome]

    def outcomes(self, chunks: Sequence[Chunk[Cell]]) -> Iterator[list[Outcome]]:
        """Yield what becomes of each chunk, in the order in which they are done.

        Raises ExecutorGoneError where the executor takes no more work, and whatever else the work raises.
        """
        waiting = deque(chunks)
        while waiting:
            suspects: list[Chunk[Cell]] = []
            for chunk, found in self._together(waiting):
                if found is None:
                    suspects.append(chunk)
                else:
                    yield found
            self._cleared(suspects)
            for chunk in suspects:
                yield from self._alone(chunk)

    def _together(self, waiting: deque[Chunk[Cell]]) -> Iterator[tuple[Chunk[Cell], list[Outcome] | None]]:
        """Yield chunks with what became of them, None where a worker died; then no more are begun."""
        under_way: dict[Future[Any], Chunk[Cell]] = {}
        done: SimpleQueue[Future[Any]] = SimpleQueue()
        broken = False
        try:
            while under_way or (waiting and not broken):
                while waiting and not broken and len(under_way) < self.workers.ahead:
                    future = self._submitted(waiting[0])
                    under_way[future] = waiting.popleft()
                    future.add_done_callback(done.put)
                future = done.get()
                found = self._result(future)
                broken = broken or found is None
                yield under_way.pop(future), found
        except ExecutorGoneError:
            yield from ((chunk, future.result()) for future, chunk in under_way.items() if _whole(future))
            raise

    def _alone(self, chunk: Chunk[Cell]) -> Iterator[list[Outcome]]:
        """Yield the outcomes of a chunk whose worker may have died of it, submitted by itself."""
        found = self._result(self._submitted(chunk))
        if found is not None:
            yield found
            return
        self._cleared([chunk])
        if len(chunk) == 1:
            yield [self.lost(chunk[0])]
        else:
            for cell in chunk:
                yield from self._alone((cell,))

    def _cleared(self, suspects: Sequence[Chunk[Cell]]) -> None:
        """Let new processes take the place of our own, all of which die with one."""
        if suspects and self.workers.own:
            self.workers.close()

    def _submitted(self, chunk: Chunk[Cell]) -> Future[Any]:
        """The future of a chunk; where the executor is broken already, one that says so."""
        try:
            return self.workers.submit(*self.work(chunk))
        except BrokenExecutor as error:
            failed: Future[Any] = Future()
            failed.set_exception(error)
            return failed
        except Exception as error:
            raise ExecutorGoneError(_said(error)) from error

    def _result(self, future: Future[Any]) -> list[Outcome] | None:
        """What a future holds, None where its worker died."""
        try:
            outcomes: list[Outcome] = future.result()
            return outcomes
        except CancelledError as error:
            raise ExecutorGoneError("it called off work that it had accepted") from error
        except Exception as error:
            if isinstance(error, BrokenExecutor) and not self.workers.own:
                raise ExecutorGoneError(_said(error)) from error
            if not died(error):
                raise
            return None


def _whole(future: Future[Any]) -> bool:
    """Whether a future holds a result."""
    return future.done() and not future.cancelled() and future.exception() is None


def _said(error: BaseException) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"[:200]
