"""Processor time, of this process and of those that it starts, wall time, and medians of either."""

from __future__ import annotations

import resource
import statistics
import time
from collections.abc import Callable

ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
"""Environment of the processes that are measured."""

REPEATS = 5

ENOUGH = 10.0
"""s after which a benchmark is not repeated."""


def spent() -> float:
    """Return the processor time in s of this process and of its children that have ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def median(work: Callable[[], object], repeats: int = REPEATS, clock: Callable[[], float] = spent) -> float:
    """Return the median time of some work in s: processor time, or another clock's."""
    times: list[float] = []
    while len(times) < repeats and sum(times) < ENOUGH:
        begun = clock()
        work()
        times.append(clock() - begun)
    return statistics.median(times)


def wall() -> float:
    """Return the time on the wall in s."""
    return time.perf_counter()
