"""A loop that no change to this project makes quicker: times over its time compare across machines."""

from __future__ import annotations

import numpy as np
from pytest_benchmark.fixture import BenchmarkFixture


def work() -> float:
    """Solve small systems one by one and a large one, as much Python as LAPACK."""
    small, large = np.eye(4) + 0.1, np.eye(300) + 0.1
    total = sum(float(np.linalg.solve(small, small[k % 4])[0]) for k in range(300))
    return total + float(np.linalg.solve(large, large).trace())


def test_calibration(benchmark: BenchmarkFixture) -> None:
    """Some milliseconds."""
    benchmark(work)
