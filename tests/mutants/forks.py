"""Runs of pytest in forks of one process that has imported the libraries; the packages are imported anew."""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from types import FrameType

import pytest

LIBRARIES = (
    "casadi",
    "numpy.testing",
    "scipy.integrate",
    "scipy.interpolate",
    "scipy.io",
    "scipy.linalg",
    "scipy.optimize",
    "scipy.signal",
    "scipy.sparse.linalg",
    "scipy.special",
    "xarray",
)

OPTIONS = ("-q", "-n0", "--no-header", "--tb=no", "-p", "no:cacheprovider")


class Stopped(pytest.fail.Exception):
    """A test has used up its CPU time."""


@contextmanager
def stopped_after(seconds: float) -> Iterator[None]:
    """Fail what uses more CPU time than that."""

    def stop(_signal: int, frame: FrameType | None) -> None:
        if frame is not None and "/coverage/" in frame.f_code.co_filename:  # which may hold a lock
            signal.setitimer(signal.ITIMER_PROF, 0.01)
            return
        raise Stopped(f"uses more than {seconds:.1f} s of the processor", pytrace=False)

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def load() -> None:
    """Import what every run needs, once."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name in LIBRARIES:
            import_module(name)


def run(clone: Path, arguments: Sequence[str], plugin: object, limit: float, said: Path, cache: Path) -> int:
    """Run pytest in a fork and return its exit code, or the negative signal that ended it.

    It has so many seconds of CPU time, and the fivefold by the clock. What it says goes to a file; what it
    compiles into a folder.
    """
    return _forked(lambda: _pytest(clone, [*OPTIONS, *arguments], plugin, limit, said, cache), 5 * limit + 60)


def _pytest(clone: Path, arguments: list[str], plugin: object, limit: float, said: Path, cache: Path) -> int:
    out = os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(out, 1)
    os.dup2(out, 2)
    os.chdir(clone)
    os.environ |= {"PYTHONPATH": str(clone), "PYTHONDONTWRITEBYTECODE": "1", "XDG_CACHE_HOME": str(cache)}
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(clone))
    spent = time.process_time()
    resource.setrlimit(resource.RLIMIT_CPU, (int(spent + limit) + 1, int(spent + limit) + 6))
    return int(pytest.main(arguments, plugins=[plugin]))


def _forked(work: Callable[[], int], seconds: float) -> int:
    """Do the work in a fork, which ends by then with all that it has started."""
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        code = 70
        try:
            os.setsid()
            code = work()
        finally:
            sys.stdout.flush()
            os._exit(code)
    ends = time.monotonic() + seconds
    while True:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            break
        if time.monotonic() > ends:
            os.killpg(child, signal.SIGKILL)
        time.sleep(0.01)
    with suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(status)
