"""Traces that are killed outright, two traces into one directory, a disk that fills up."""

from __future__ import annotations

import random
import signal
import sqlite3
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.commands import command, wait_for_points
from support.traces import DUFFING_A, duffing_system

import periodic as per
from reports.app.cli import main

pytestmark = pytest.mark.faults

ARGUMENTS = ("trace", "vitrea79-810N", "--to", "200", "--accuracy", "fine")


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> per.Branch:
    """The branch of a trace that nothing happens to."""
    folder = tmp_path_factory.mktemp("whole")
    assert main([*ARGUMENTS, "--out", str(folder)]) == 0
    return per.Branch.load(folder / "branch.nc")


def killed(folder: Path, points: int, *more: str) -> None:
    """Run a trace, or go on with one, and kill it a little after its journal has so many steps."""
    process = command(*ARGUMENTS, "--out", str(folder), *more)
    wait_for_points(process, folder, points)
    time.sleep(random.uniform(0, 0.05))
    process.send_signal(signal.SIGKILL)
    process.communicate()


def check(folder: Path, whole: per.Branch, kills: int) -> None:
    """Kill a trace some times at random, then let it end, and compare."""
    for kill in range(kills):
        killed(folder, 5 + 3 * kill, *(["--resume"] if kill else []))
        if (folder / "branch.journal").is_file():
            assert len(per.recovered(folder / "branch.journal")) > 0
    assert main([*ARGUMENTS, "--out", str(folder), "--resume"]) == 0
    found = per.Branch.load(folder / "branch.nc")
    assert [p.label for p in found] == [p.label for p in whole]
    # rounding may change a number of intervals; the orbits are to 1e-7
    assert found.values == pytest.approx(whole.values, rel=1e-7)
    assert not (folder / "branch.journal").exists()


def test_killed_trace_is_resumed(tmp_path: Path, whole: per.Branch) -> None:
    """Assert that a trace killed twice and resumed ends as one that was not."""
    check(tmp_path, whole, 2)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(20))
def test_killed_a_hundred_times(seed: int, tmp_path: Path, whole: per.Branch) -> None:
    """Assert the same of twenty traces killed five times each at random moments."""
    random.seed(seed)
    check(tmp_path, whole, 5)


def test_two_traces_into_one_directory(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that a second trace into a directory in use is refused, and the first one ends."""
    process = command(*ARGUMENTS, "--out", str(tmp_path))
    wait_for_points(process, tmp_path, 1)
    assert main([*ARGUMENTS, "--out", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert said == f'orbitrace: --out is "{tmp_path}"; it must be one that no other trace is writing to\n'
    process.communicate()
    assert process.returncode == 0


def test_journal_reads_no_more_than_whole_steps(tmp_path: Path) -> None:
    """Assert that a journal cut or changed anywhere gives the steps before, or says that it has none."""
    path = tmp_path / "journal"
    branch = per.trace(duffing_system(*DUFFING_A), "Omega", (0.3, 3.0), watch=per.Watch(journal=path))
    data = path.read_bytes()
    assert per.recovered(path).values == pytest.approx(branch.values)
    rng = np.random.default_rng(2)
    for _ in range(60):
        place, cut = rng.integers(len(data)), rng.integers(2)
        spoilt = data[:place] if cut else data[:place] + bytes([data[place] ^ 255]) + data[place + 1 :]
        path.write_bytes(spoilt)
        try:
            found = per.recovered(path)
        except per.BranchFileError:
            assert place < len(data) / 3
            continue
        assert found.values == pytest.approx(branch.values[: len(found)])


def test_full_disk_only_loses_the_journal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a journal that cannot be written to is told, and the trace goes on."""
    path, connect = tmp_path / "journal", sqlite3.connect

    def limited(*arguments: Any, **options: Any) -> sqlite3.Connection:
        base = connect(*arguments, **options)
        base.execute("PRAGMA max_page_count = 3")
        return base

    monkeypatch.setattr(sqlite3, "connect", limited)
    with pytest.warns(UserWarning, match="cannot be written to .No space left on device.; the trace goes on"):
        branch = per.trace(duffing_system(*DUFFING_A), "Omega", (0.3, 0.5), watch=per.Watch(journal=path))
    assert branch.stop.reason is per.Reason.BOUND
