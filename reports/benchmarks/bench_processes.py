"""Fresh processes: the import, the help, a first trace from the command line to its files; memory."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from time import perf_counter

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from reports.benchmarks.others import ONE_THREAD

MAIN = "import sys; from reports.app.cli import main; sys.exit(main())"
STARTS = {
    "import": ("import periodic, symbolic",),
    "help": (MAIN, "--help"),
    "first trace": (MAIN, "trace", "vitrea79-810N"),
}


@pytest.mark.benchmark(group="start", timer=perf_counter)
@pytest.mark.parametrize("what", STARTS)
def test_start(benchmark: BenchmarkFixture, what: str, tmp_path: Path) -> None:
    """Time on the wall."""
    benchmark.pedantic(run, ("-c", *STARTS[what]), {"folder": tmp_path}, rounds=5)


@pytest.mark.benchmark(group="memory", timer=perf_counter)
def test_memory(benchmark: BenchmarkFixture, tmp_path: Path) -> None:
    """What Newton on a chain of 50 oscillators, 100 states, needs at ntst 400: the peak in MB."""
    printed = benchmark.pedantic(run, ("-m", "reports.benchmarks.memory"), {"folder": tmp_path})
    before, peak = json.loads(printed)
    benchmark.extra_info |= {"peak MB": peak, "of which Newton MB": peak - before}


def run(*arguments: str, folder: Path) -> str:
    """Return what a Python process in a folder prints."""
    command, environment = [sys.executable, *arguments], os.environ | ONE_THREAD
    return subprocess.run(
        command, check=True, capture_output=True, text=True, env=environment, cwd=folder
    ).stdout
