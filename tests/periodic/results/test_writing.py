"""Files that are replaced in one move, signals that wait, digests, and journals that two want to write to."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support.traces import DUFFING_A, duffing_system

import periodic as per
from periodic.results.files import digest, replacing
from periodic.results.journal import Journal
from periodic.results.signals import deferred


def test_a_file_is_replaced_when_the_new_one_is_complete(tmp_path: Path) -> None:
    """Assert that an error leaves what was there, and nothing beside it."""
    path = tmp_path / "file"
    path.write_text("old")
    with pytest.raises(RuntimeError), replacing(path) as part:
        part.write_text("half")
        raise RuntimeError
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]
    with replacing(path) as part:
        part.write_text("new")
    assert path.read_text() == "new" and list(tmp_path.iterdir()) == [path]


def test_digests_tell_parts_apart() -> None:
    """Assert that the same bytes cut otherwise have another digest."""
    assert digest(b"ab", b"c") == digest(b"ab", b"c") != digest(b"a", b"bc")


def test_signals_wait() -> None:
    """Assert that a signal is heard after the block, once, by the handler from before."""
    heard: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: heard.append(number))
    try:
        with deferred():
            for _ in range(3):
                os.kill(os.getpid(), signal.SIGINT)
            assert heard == []
        assert heard == [signal.SIGINT]
    finally:
        signal.signal(signal.SIGINT, before)


def test_blocks_outside_the_main_thread() -> None:
    """Assert that another thread, which no signal interrupts, just runs its block."""
    done = []

    def work() -> None:
        with deferred():
            done.append(True)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done == [True]


def traced(path: Path) -> per.Branch:
    """A short branch with a journal."""
    return per.trace(duffing_system(*DUFFING_A), "Omega", (0.3, 0.5), watch=per.Watch(journal=path))


def test_a_journal_has_one_writer_and_many_readers(tmp_path: Path) -> None:
    """Assert that a journal in use is refused to a second trace, and can be read."""
    path = tmp_path / "journal"
    branch = traced(path)
    with Journal(path, branch), pytest.raises(per.JournalError, match="another trace is writing to it$"):
        traced(path)
    with Journal(path, branch):
        assert per.recovered(path).values.tolist() == branch.values.tolist()


def text(path: Path) -> None:
    """A file of something else."""
    path.write_bytes(b"something else\n" * 99)


def other(path: Path) -> None:
    """A database of something else."""
    with sqlite3.connect(path) as base:
        base.execute("CREATE TABLE steps (weather TEXT)")
    base.close()


def damaged(path: Path) -> None:
    """A journal that was cut short."""
    traced(path)
    path.write_bytes(path.read_bytes()[:3000])


def test_another_file_is_not_written_over(tmp_path: Path) -> None:
    """Assert that a file that is no database is refused, and stays as it is."""
    text(tmp_path / "journal")
    before = (tmp_path / "journal").read_bytes()
    with pytest.raises(per.JournalError, match="^journal is '.*'; it is another file, which is not written"):
        traced(tmp_path / "journal")
    assert (tmp_path / "journal").read_bytes() == before


@pytest.mark.parametrize("make", [other, damaged])
def test_what_was_there_stays_until_the_first_step(make: Callable[[Path], None], tmp_path: Path) -> None:
    """Assert that a file that is no sound journal is kept by a trace without a step, then replaced."""
    path = tmp_path / "journal"
    make(path)
    before = path.read_bytes()
    with Journal(
        path,
        per.Branch(
            "Omega", traced(tmp_path / "layout").layout, (), per.Stop.after(per.Reason.INTERRUPTED, 0)
        ),
    ):
        pass
    assert path.read_bytes() == before
    branch = traced(path)
    assert per.recovered(path).values.tolist() == branch.values.tolist()


def test_a_journal_has_both_directions(tmp_path: Path) -> None:
    """Assert the branch in its order where it was traced to both sides of its beginning."""
    system, path = duffing_system(*DUFFING_A), tmp_path / "journal"
    branch = per.trace(system, "Omega", (0.3, 0.4), start=0.35, watch=per.Watch(journal=path))
    values = per.recovered(path).values
    assert values.tolist() == branch.values.tolist() and (np.diff(values) > 0).all()


def test_signal_without_a_handler_ends_the_program_after_the_block() -> None:
    """Assert that what a signal does by default is done, once the block is finished."""
    program = (
        "import os, signal\n"
        "from periodic.results.signals import deferred\n"
        "with deferred():\n"
        "    os.kill(os.getpid(), signal.SIGTERM)\n"
        "    print('finished', flush=True)\n"
        "print('goes on')\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (-signal.SIGTERM, "finished\n")
