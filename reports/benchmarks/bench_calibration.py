"""A loop that no change to this project makes quicker: times over its time compare across machines."""

from __future__ import annotations

from pytest_benchmark.fixture import BenchmarkFixture

from reports.benchmarks.work import loop


def test_calibration(benchmark: BenchmarkFixture) -> None:
    """Some milliseconds."""
    benchmark(loop)
