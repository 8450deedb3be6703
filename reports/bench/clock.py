"""Processor time, of this process and of those that it starts, and medians of it."""

from __future__ import annotations

import os
import statistics
from collections.abc import Callable

REPEATS = 5

ENOUGH = 10.0
"""s after which a benchmark is not repeated."""


def spent() -> float:
    """Return the processor time in s of this process and of its children that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def median(work: Callable[[], object], repeats: int = REPEATS) -> float:
    """Return the median processor time of some work in s."""
    times: list[float] = []
    while len(times) < repeats and sum(times) < ENOUGH:
        begun = spent()
        work()
        times.append(spent() - begun)
    return statistics.median(times)
