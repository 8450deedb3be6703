"""Searches that are kept, killed, interrupted and done elsewhere: the same bits, nothing lost."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.phasespace.search.settle import Settling
from periodic.phasespace.search.stages import Stages
from periodic.phasespace.search.unstable import Unstable
from periodic.results.kept import Kept
from symbolic.kernels import native

pytestmark = pytest.mark.usefixtures("users_kernels")

BOX = {"x": (-3, 3), "x'": (-2, 2)}

SCRIPT = """
import hashlib, sys
import periodic as per, symbolic as sym
box = {"x": (-3, 3), "x'": (-2, 2)}
with per.working(store=sys.argv[1]):
    found = per.motions(sym.scene("gear-pair"), {"Omega": 0.7}, box=box, starts=96, periods=2, places=16)
for motion in found:
    print(motion.name, motion.starts, hashlib.sha256(motion.sections.tobytes()).hexdigest())
"""

needs_compiler = pytest.mark.skipif(native.compiler() is None, reason="one by one it takes long")


def gears(starts: int = 96) -> per.phasespace.Motions:
    """Motions of the gear pair between its folds."""
    given: dict[str, Any] = {"starts": starts, "periods": 2, "places": 16}
    return per.motions(sym.scene("gear-pair"), {"Omega": 0.7}, box=BOX, **given)


def bits(found: per.phasespace.Motions) -> list[Any]:
    """All that is known of motions, to the last bit."""
    return [
        (m.name, m.starts, m.found, m.sections.tobytes(), m.point and m.point.multipliers.tobytes())
        for m in found
    ]


@needs_compiler
def test_kept_motions_are_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the bits of a search that is kept, and of one that follows and traces nothing any more."""
    here = gears()
    with per.working(store=tmp_path / "search.db"):
        assert bits(gears()) == bits(here)
    size = (tmp_path / "search.db").stat().st_size
    monkeypatch.setattr("periodic.phasespace.following.parts.Part.followed", None)
    with per.working(store=tmp_path / "search.db"):
        assert bits(gears()) == bits(here)
    assert (tmp_path / "search.db").stat().st_size == size
    with per.working(store=tmp_path / "search.db", resume=False), pytest.raises(TypeError):
        gears()


@needs_compiler
def test_atlas_and_basins_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the same words of an atlas, and the same labels of starts, without following anything again."""
    gear, given = sym.scene("gear-pair"), {"count": 3, "diagram": 3, "starts": 16, "places": 4, "periods": 1}

    def both() -> tuple[str, list[int]]:
        atlas = per.atlas(gear, "Omega", (0.6, 0.8), box=BOX, **given)
        basins = per.basins(gear, {"Omega": 0.7}, box=BOX, starts=100, periods=2)
        return str(atlas), basins.labels.tolist()

    with per.working(store=tmp_path / "a.db"):
        first = both()
    monkeypatch.setattr("periodic.phasespace.following.parts.Part.followed", None)
    monkeypatch.setattr("periodic.phasespace.following.traced.trace", None)
    with per.working(store=tmp_path / "a.db"):
        assert both() == first


@needs_compiler
def test_killed_searches_go_on(tmp_path: Path) -> None:
    """Assert the numbers of one run after kills, each as soon as something more was kept."""
    store, command = tmp_path / "search.db", [sys.executable, "-c", SCRIPT, str(tmp_path / "search.db")]
    size = 0
    for _ in range(3):
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            while process.poll() is None and not (store.exists() and store.stat().st_size > size):
                time.sleep(0.005)
            process.send_signal(signal.SIGKILL)
        size = store.stat().st_size if store.exists() else 0
    last = subprocess.run(command, capture_output=True, text=True, check=True)
    store.unlink()
    once = subprocess.run(command, capture_output=True, text=True, check=True)
    assert last.stdout == once.stdout and once.stdout.count("stable, periodic") == 2


@needs_compiler
def test_processes_give_the_same(tmp_path: Path) -> None:
    """Assert the bits from two processes, and from a user's executor."""
    here = gears(160)
    with per.working(2):
        assert bits(gears(160)) == bits(here)
    with ThreadPoolExecutor(2) as pool, per.working(pool, store=tmp_path / "a.db"):
        assert bits(gears(160)) == bits(here)


class Failing(Executor):
    """Does the first pieces of work, and fails in a way of its own then."""

    def __init__(self, error: BaseException, after: int = 0) -> None:
        self.error, self.after = error, after

    def submit(self, function: Any, /, *arguments: Any, **_: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.after -= 1
        if self.after >= 0:
            future.set_result(function(*arguments))
        else:
            future.set_exception(self.error)
        return future


class KilledWorker(Exception):  # noqa: N818
    """As dask.distributed says that several workers have died of one piece of work."""


@needs_compiler
def test_executor_that_goes_away(tmp_path: Path) -> None:
    """Assert a sentence, and that what was done is not done again."""
    broken = Failing(BrokenExecutor("it is gone"), after=1)
    with (
        per.working(broken, store=tmp_path / "a.db"),
        pytest.raises(per.phasespace.WorkStoppedError, match="the executor went away .*gone.* not lost"),
    ):
        gears()
    with sqlite3.connect(tmp_path / "a.db") as base:
        (kept,) = base.execute("SELECT COUNT(*) FROM kept").fetchone()
    assert kept >= 1
    with (
        per.working(Failing(KilledWorker("4 workers died"))),
        pytest.raises(per.phasespace.WorkStoppedError, match="the process that computed it died, twice"),
    ):
        gears()


def test_interrupted_search_gives_what_it_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the stable motions, and what was not tried, where Ctrl-C comes before the unstable ones."""

    def stop(self: Any) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(Unstable, "run", stop)
    with pytest.raises(per.phasespace.SearchInterrupted, match="^interrupted; the 2 motions so far are"):
        try:
            gears(24)
        except per.phasespace.SearchInterrupted as interrupted:
            found = interrupted.found
            raise
    assert [motion.stable for motion in found] == [True, True] and found.undecided == 0
    assert found.tried[-1] == (
        "interrupted; not tried, or not to the end: unstable orbits, motions from beside them, "
        "images under symmetries"
    )


@needs_compiler
def test_interrupted_atlas_gives_the_values_that_were_done(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert two of three values, whose branches are not traced yet; before the first there is none."""
    given: dict[str, Any] = {"count": 3, "diagram": 2, "starts": 8, "places": 0, "periods": 1}
    run, left = Stages.run, [2]

    def stop(self: Stages, say: Any) -> Any:
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        return run(self, say)

    monkeypatch.setattr(Stages, "run", stop)
    with pytest.raises(per.phasespace.SearchInterrupted, match="the atlas of 2 values so far is") as caught:
        per.atlas(sym.scene("gear-pair"), "Omega", (0.6, 0.8), box=BOX, **given)
    assert caught.value.found.values == pytest.approx([0.6, 0.7])
    assert len(caught.value.found.motions) == 2 and "0 branches" in str(caught.value.found)
    with pytest.raises(KeyboardInterrupt):
        per.atlas(sym.scene("gear-pair"), "Omega", (0.6, 0.8), box=BOX, **given)


def test_what_is_kept(tmp_path: Path) -> None:
    """Assert arrays bit for bit, none for a key that is not there or a row that is damaged."""
    path, arrays = tmp_path / "kept.db", {"a": np.arange(3.0), "b": np.zeros((2, 0), dtype=np.intc)}
    with Kept(path, True) as kept:
        kept.add("one", arrays)
        kept.add("two", {"a": np.ones(4)})
    with Kept(path, True) as kept:
        found = kept.get("one")
        assert found is not None and kept.get("three") is None
        assert {n: (v.dtype, v.shape, v.tobytes()) for n, v in found.items()} == {
            n: (v.dtype, v.shape, v.tobytes()) for n, v in arrays.items()
        }
    with sqlite3.connect(path) as base:
        base.execute("UPDATE kept SET content = X'00' WHERE key = 'two'")
    with Kept(path, True) as kept:
        assert kept.get("two") is None and kept.get("one") is not None
        kept.add("two", {"a": np.ones(4)})
        assert kept.get("two") is not None


def test_full_disk_is_said_once(tmp_path: Path) -> None:
    """Assert one warning, and that the work goes on."""
    with Kept(tmp_path / "kept.db", True) as kept:
        kept.add("small", {"a": np.ones(4)})
        kept._base.execute("PRAGMA max_page_count = 30")
        with pytest.warns(UserWarning, match="cannot be written to .*full.*; the work goes on") as said:
            kept.add("large", {"a": np.ones(100_000)})
            kept.add("large", {"a": np.ones(100_000)})
        assert len(said) == 1 and kept.get("large") is None and kept.get("small") is not None


def test_stores_that_are_refused(tmp_path: Path) -> None:
    """Assert the sentences for other files, places without files, stores in use, and no names."""
    text, table = tmp_path / "notes.txt", tmp_path / "table.db"
    text.write_text("not a database")
    with sqlite3.connect(table) as base:
        base.execute("CREATE TABLE other (a)")
    os.mkfifo(tmp_path / "pipe")

    def refused(match: str, **given: Any) -> None:
        with pytest.raises(ValueError, match=match), per.working(**given):
            pass

    for path in (text, table):
        refused("which is another file or damaged; it is not written over", store=path)
        assert path.stat().st_size > 0
    refused("which cannot be written", store=tmp_path / "pipe")
    refused("which cannot be written", store=tmp_path / "no" / "folder.db")
    refused("which cannot be written", store=tmp_path)
    refused("store is 3; it must be the name of a file, or None", store=3)
    refused("resume is 1; it must be True or False", resume=1)
    refused("executor is None; it must be", executor=None)
    refused("executor is 'many'", executor="many")
    with per.working(store=tmp_path / "a.db"):
        refused("something else is writing to it", store=tmp_path / "a.db")


@needs_compiler
def test_interrupted_basins_are_those_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert labels of starts that had arrived before Ctrl-C, and that the others are open."""
    monkeypatch.setattr("periodic.phasespace.basins.AT_ONCE", 100)
    given: dict[str, Any] = {"box": BOX, "starts": 250, "periods": 2}
    whole = per.basins(sym.scene("gear-pair"), {"Omega": 0.7}, **given)
    run, left = Settling.run, [1]

    def stop(self: Settling) -> None:
        left[0] -= 1
        run(self)
        if left[0] < 0:
            raise KeyboardInterrupt

    monkeypatch.setattr(Settling, "run", stop)
    with pytest.raises(
        per.phasespace.SearchInterrupted, match="the 250 starts, those not followed"
    ) as caught:
        per.basins(sym.scene("gear-pair"), {"Omega": 0.7}, **given)
    found = caught.value.found
    assert found.labels[:200].tolist() == whole.labels[:200].tolist()
    assert (found.labels[200:] == per.phasespace.Elsewhere.OPEN).all()
