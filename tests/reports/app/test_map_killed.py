"""Maps that are killed, asked to end or whose clock jumps, and that go on: the same numbers bit for bit."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from itertools import chain, repeat
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from support.commands import Capture, command

from periodic.maps import map as maps
from periodic.maps import store as stores
from reports.app.cli import main

OVER = ("--over", "F=0.2:0.4:6", "--over", "c=0.1:0.3:4")
ARGUMENTS = ("map", "duffing", *OVER, "--from", "1.3", "--to", "1.9", "--accuracy", "draft")
ENDINGS = ("SIGKILL", "SIGTERM", "SIGHUP", "SIGINT")
LONGEST = 120.0
"""Seconds after which a map that neither ends nor goes on is called stuck."""


@pytest.fixture(scope="module")
def kernels() -> pytest.MonkeyPatch:
    """NumPy alone: with AUTO a run that begins anew calls C later than one that goes through."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", "numpy")
        yield patch


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory, kernels: pytest.MonkeyPatch) -> xr.Dataset:
    """The map that nothing happens to."""
    folder = tmp_path_factory.mktemp("whole")
    assert main([*ARGUMENTS, "--jobs", "1", "--out", str(folder)]) == 0
    return xr.load_dataset(folder / "map.nc")


def same(folder: Path, whole: xr.Dataset) -> None:
    """Assert that a directory holds that map, bit for bit but for the time it took, and no journal."""
    found = xr.load_dataset(folder / "map.nc")
    assert found.drop_vars("seconds").drop_attrs().equals(whole.drop_vars("seconds").drop_attrs())
    numbers = [name for name, data in whole.items() if data.dtype.kind == "f" and name != "seconds"]
    assert {"peak", "stable peak"} < set(numbers)
    for name in numbers:
        assert found[name].values.tobytes() == whole[name].values.tobytes(), name
    assert (found["status"] == "done").all() and sorted(p.name for p in folder.iterdir()) == [
        "map.nc",
        "map.png",
        "settings.json",
    ]


def ended(folder: Path, ending: signal.Signals, jobs: int, rng: random.Random, *more: str) -> int:
    """Run a map, or go on with one, end it at a random moment and return the exit code of its process."""
    process = command(*ARGUMENTS, "--jobs", str(jobs), "--out", str(folder), *more)
    journal = folder / "map.nc.journal"
    limit = time.monotonic() + LONGEST
    before = journal.stat().st_size if journal.is_file() else 0
    while process.poll() is None and time.monotonic() < limit:
        if journal.is_file() and journal.stat().st_size > before:
            break
        time.sleep(0.005)
    time.sleep(rng.uniform(0.0, 0.6))
    process.send_signal(ending)
    if ending == signal.SIGKILL:  # its processes hold the pipes for a while, and have nothing to say
        assert process.stderr is not None
        process.stderr.close()
        return int(process.wait(timeout=LONGEST))
    said = process.communicate(timeout=LONGEST)[1]
    assert "Traceback" not in said, said
    if process.returncode == 130:
        assert said.startswith("orbitrace: interrupted"), said
    else:
        assert process.returncode in (0, -ending), said
    return process.returncode


def check(folder: Path, whole: xr.Dataset, ending: str, seed: int) -> list[int]:
    """End a map twice at random moments, let it end by itself, compare; return the exit codes."""
    rng, number = random.Random(seed), getattr(signal, ending)
    jobs = 1 + seed % 2
    codes = [ended(folder, number, jobs, rng, *(["--resume"] if k else [])) for k in range(2)]
    assert main([*ARGUMENTS, "--jobs", "1", "--out", str(folder), "--resume"]) == 0
    same(folder, whole)
    return codes


@pytest.mark.parametrize(("ending", "seed"), [("SIGKILL", 1), ("SIGHUP", 2), ("SIGTERM", 4)])
def test_ended_map_goes_on(ending: str, seed: int, tmp_path: Path, whole: xr.Dataset) -> None:
    """Assert the numbers of a map ended twice, by a kill, a closed terminal, a request to end."""
    codes = check(tmp_path, whole, ending, seed)
    assert codes[0] == (-signal.SIGKILL if ending == "SIGKILL" else 130)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("ending", ENDINGS)
def test_ended_map_goes_on_at_twenty_moments(
    ending: str, seed: int, tmp_path: Path, whole: xr.Dataset
) -> None:
    """Assert the same of each of the four ends, at twenty random moments, in one process and in two."""
    check(tmp_path, whole, ending, seed)


def test_terminal_that_closes_on_all_processes(tmp_path: Path, whole: xr.Dataset) -> None:
    """Assert that SIGHUP to the whole group, as a terminal sends it, ends as Ctrl-C does."""
    process = command(*ARGUMENTS, "--jobs", "2", "--out", str(tmp_path), start_new_session=True)
    limit = time.monotonic() + LONGEST
    while process.poll() is None and time.monotonic() < limit:
        journal = tmp_path / "map.nc.journal"
        if journal.is_file() and journal.stat().st_size > 8192:
            break
        time.sleep(0.005)
    os.killpg(process.pid, signal.SIGHUP)
    said = process.communicate(timeout=LONGEST)[1]
    assert process.returncode == 130 and said.startswith("orbitrace: interrupted") and said.count("\n") == 1
    assert main([*ARGUMENTS, "--jobs", "1", "--out", str(tmp_path), "--resume"]) == 0
    same(tmp_path, whole)


def test_closed_terminal_that_is_ignored(tmp_path: Path, whole: xr.Dataset) -> None:
    """Assert that `nohup orbitrace map` runs on when the terminal closes."""
    program = "import sys; from reports.app.cli import main; sys.exit(main())"
    line = ["nohup", sys.executable, "-c", program, *ARGUMENTS, "--jobs", "1", "--out", str(tmp_path)]
    quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    process = subprocess.Popen(line, **quiet)
    while process.poll() is None and not (tmp_path / "map.nc.journal").is_file():
        time.sleep(0.005)
    process.send_signal(signal.SIGHUP)
    assert process.communicate(timeout=LONGEST)[1] == b"" and process.returncode == 0
    same(tmp_path, whole)


def test_clock_that_jumps(
    tmp_path: Path, whole: xr.Dataset, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    """Assert the same map where every clock goes back and forth by years, and files are of the future."""
    jumps = chain.from_iterable(repeat((1e9, -1e9, 0.0, 3e8, -5.0)))
    clock = time.perf_counter
    for module in (maps, stores):
        monkeypatch.setattr(module, "perf_counter", lambda: clock() + next(jumps))
    monkeypatch.setattr(time, "time", lambda: next(jumps))
    process = command(*ARGUMENTS, "--jobs", "1", "--out", str(tmp_path))
    limit = time.monotonic() + LONGEST
    while process.poll() is None and not (tmp_path / "map.nc.journal").is_file() and time.monotonic() < limit:
        time.sleep(0.005)
    process.kill()
    process.communicate()
    for path in tmp_path.iterdir():
        os.utime(path, (4e9, 4e9))
    assert main([*ARGUMENTS, "--jobs", "1", "--out", str(tmp_path), "--resume"]) == 0
    assert capsys.readouterr().err == ""
    same(tmp_path, whole)
    assert np.isfinite(whole["peak"]).all()
