"""The same work by other tools, where they are installed: each in a process of its own.

They may be installed under another Python, whose path ORBITRACE_PEERS gives.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from reports.benchmarks.work import fold_error

ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
"""Environment of the processes that are measured."""

PACKAGES = {"auto": "bifpy", "harm": "pyHarm-os", "difference": "bice", "xpp": "xpplab"}
"""What the modules of `reports.benchmarks.peers` need; `executable` needs AUTO_DIR."""

PYTHON = "ORBITRACE_PEERS"
"""The environment variable."""

ROOT = Path(__file__).parents[2]
"""Where this project's packages are; they come last on the other Python's path."""


class MissingError(Exception):
    """A peer is not installed or does not run; the message says why."""


@dataclass(frozen=True)
class Case:
    """A module of `reports.benchmarks.peers` and its arguments, by a name."""

    name: str
    module: str
    arguments: tuple[str, ...]


@dataclass(frozen=True)
class Branch:
    """What a peer says of its branch: processor time in s, number of points, folds."""

    seconds: float
    points: int
    folds: tuple[float, ...]

    @property
    def numbers(self) -> dict[str, float]:
        """Number of points and, where it has two folds, their error as those of Duffing A."""
        error = {"fold error": fold_error(self.folds)} if len(self.folds) == 2 else {}
        return {"points": float(self.points)} | error


Measured = Callable[[Case], Branch]


def traced(case: Case) -> Branch:
    """Return what a peer measures. Raises MissingError."""
    code = (
        f"import sys, runpy; sys.path.append({str(ROOT)!r}); sys.argv[1:] = {list(case.arguments)!r}; "
        f"runpy.run_module('reports.benchmarks.peers.{case.module}', run_name='__main__')"
    )
    done = _run(code)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        package = PACKAGES.get(case.module, "AUTO-07p")
        if reason.startswith("ModuleNotFoundError"):
            raise MissingError(f"{package} is not installed (pip install 'orbitrace[peers]')")
        raise MissingError(f"{package} failed: {reason}")
    answer = json.loads(done.stdout.strip().splitlines()[-1])
    return Branch(answer["s"], answer["points"], tuple(answer["folds"]))


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
    except subprocess.TimeoutExpired as error:
        raise MissingError(f"not at its end in {PATIENCE} s") from error
    except OSError as error:
        raise MissingError(f"{python} does not run it ({type(error).__name__})") from error
