"""The same work by other tools, where they are installed: each in a process of its own.

They may be installed under another Python, whose path ORBITRACE_PEERS gives.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache, partial
from pathlib import Path

from reports.bench.clock import ONE_THREAD
from reports.bench.suite import Benchmark, Numbers, fold_error

PYTHON = "ORBITRACE_PEERS"
"""The environment variable."""

ROOT = Path(__file__).parents[2]
"""Where this project's packages are; they come last on the other Python's path."""

FEW = 60
"""Points that AUTO is traced through with Python called back, which is slow."""


class MissingError(Exception):
    """A peer is not installed or does not run; the message says why."""


def traced(module: str, package: str, *arguments: str) -> Numbers:
    """Return what a module of `reports.bench.peers` measures. Raises MissingError."""
    code = (
        f"import sys, runpy; sys.path.append({str(ROOT)!r}); sys.argv[1:] = {list(arguments)!r}; "
        f"runpy.run_module('reports.bench.peers.{module}', run_name='__main__')"
    )
    done = _run(code)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        if reason.startswith("ModuleNotFoundError"):
            raise MissingError(f"{package} is not installed (pip install 'orbitrace[peers]')")
        raise MissingError(f"{package} failed: {reason}")
    told = json.loads(done.stdout.strip().splitlines()[-1])
    numbers = {
        "s": told["s"],
        "points": float(told["points"]),
        "per point ms": 1e3 * told["s"] / told["points"],
    }
    return numbers | ({"fold error": fold_error(told["folds"])} if len(told["folds"]) == 2 else {})


@cache
def version(package: str) -> str:
    """Return the version of a package under the peers' Python."""
    try:
        done = _run(f"from importlib.metadata import version; print(version({package!r}))")
    except MissingError:
        return "not installed"
    return "not installed" if done.returncode else done.stdout.strip()


PATIENCE = 600
"""Seconds that another tool may take."""


def _run(code: str) -> subprocess.CompletedProcess[str]:
    python = os.environ.get(PYTHON) or sys.executable
    environment = os.environ | ONE_THREAD
    try:
        return subprocess.run(
            [python, "-c", code],
            capture_output=True,
            text=True,
            env=environment,
            check=False,
            timeout=PATIENCE,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise MissingError(f"{python} does not run it ({type(error).__name__})") from error


def _auto(ntst: int, most: int = 1000, how: str = "transpiled") -> partial[Numbers]:
    return partial(traced, "auto", "bifpy", str(ntst), str(most), how)


PACKAGES = ("bifpy", "pyHarm-os", "bice")

PEERS = (
    *(Benchmark(f"AUTO-07p by bifpy, ntst {ntst}", _auto(ntst)) for ntst in (20, 50, 100)),
    Benchmark(f"AUTO-07p by bifpy in Python, ntst 50, {FEW} points", _auto(50, FEW, "called")),
    Benchmark("pyHarm, H 7", partial(traced, "harm", "pyHarm-os", "7")),
    Benchmark("bice, 50 steps", partial(traced, "difference", "bice", "50")),
)
