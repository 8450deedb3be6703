"""What a peer prints of a branch: its processor time, and folds between its points."""

from __future__ import annotations

import json
import resource
import statistics
import time
from collections.abc import Callable, Sequence

import numpy as np

NEIGHBOURS = 3
"""Points on each side of a turn that a polynomial goes through."""

REPEATS = 5

TIMING_SECONDS = 10.0
"""s after which a branch is not traced again."""


def spent() -> float:
    """Return the processor time in s of this process and of its children that have ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def median(work: Callable[[], object], repeats: int = REPEATS) -> float:
    """Return the median processor time of some work in s."""
    times: list[float] = []
    while len(times) < repeats and sum(times) < TIMING_SECONDS:
        begun = spent()
        work()
        times.append(spent() - begun)
    return statistics.median(times)


def tell(seconds: float, points: int, folds: Sequence[float]) -> None:
    """Print a line of JSON, the last one on standard output."""
    print(json.dumps({"s": seconds, "points": points, "folds": list(folds)}))


def folds(points: Sequence[np.ndarray]) -> list[float]:
    """Return the last component where it turns, by a polynomial in arclength through the points around."""
    path = np.array(points, dtype=float)
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    way = np.sign(np.diff(path[:, -1]))
    return [_turn(arc, path[:, -1], int(k)) for k in np.flatnonzero(way[1:] != way[:-1]) + 1]


def _turn(arc: np.ndarray, value: np.ndarray, middle: int) -> float:
    near = slice(max(middle - NEIGHBOURS, 0), middle + NEIGHBOURS + 1)
    through = np.polynomial.Polynomial.fit(arc[near], value[near], len(arc[near]) - 1)
    roots = through.deriv().roots()
    real = roots[np.abs(roots.imag) < 1e-9].real
    return float(through(real[np.abs(real - arc[middle]).argmin()]))
