"""What is kept of a map: killed, interrupted, shared, foreign, damaged and full stores."""

from __future__ import annotations

import builtins
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from support.maps import GRID, Counted, height, task
from support.numpy_systems import LinearOscillator

import periodic as per
from periodic.maps import store as stores
from periodic.maps.dataset import dataset
from periodic.results import netcdf
from periodic.results.files import digest

pytestmark = pytest.mark.faults

TESTS = Path(__file__).resolve().parents[2]
RUN = """
import sys
from pathlib import Path
import periodic as per
from support.maps import GRID, Counted, task
def main():
    number = Counted(Path(sys.argv[1]), wait=float(sys.argv[3]))
    per.design_map(task(f=number), GRID, int(sys.argv[4]), store=sys.argv[2], chunk=2)
if __name__ == "__main__":
    main()
"""
BEGIN = """
import os
import signal
import sqlite3
from periodic.workers.executors import Processes
def main():
    where = Processes(2)
    where.submit(abs, 1)
    print(*where._pool._processes, flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
if __name__ == "__main__":
    main()
"""


def started(folder: Path, store: Path, wait: float, executor: int = 1) -> subprocess.Popen[bytes]:
    """A map in a process of its own, once it has a few cells."""
    script = folder.parent / "run.py"
    script.write_text(RUN)
    environment = os.environ | {"PYTHONPATH": str(TESTS)}
    command = [sys.executable, str(script), str(folder), str(store), str(wait), str(executor)]
    running = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
    limit = time.monotonic() + 60
    while len(list(folder.iterdir())) < 5 and running.poll() is None and time.monotonic() < limit:
        time.sleep(0.01)
    return running


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Where cells are counted."""
    (tmp_path / "cells").mkdir()
    return tmp_path / "cells"


def cells(folder: Path) -> list[str]:
    """The cells that were read, as often as they were."""
    return sorted(path.name.rsplit("-", 2)[0] for path in folder.iterdir())


def test_killed_run_goes_on(folder: Path, tmp_path: Path) -> None:
    """Assert that of a run that was killed only chunks under way are computed again, and all is there."""
    store = tmp_path / "map.nc"
    running = started(folder, store, 0.05)
    with pytest.raises(per.maps.MapFileError, match="another map is writing to it"):
        per.design_map(task(f=Counted(folder, 0.05)), GRID, 1, store=store, chunk=2)
    running.send_signal(signal.SIGKILL)
    running.wait()
    before = len(cells(folder))
    assert 5 <= before < 12
    found = per.design_map(task(f=Counted(folder, 0.05)), GRID, 1, store=store, chunk=2)
    again = len(cells(folder)) - 12
    assert 0 <= again <= 2 and len(set(cells(folder))) == 12
    assert (found["f"] == found["F"]).all() and (found["status"] == "done").all()
    assert [path.name for path in tmp_path.glob("map*")] == ["map.nc"]


def test_processes_end_with_the_one_that_is_killed(folder: Path, tmp_path: Path) -> None:
    """Assert that no process computes on, or waits, after the one that asked was killed."""
    running = started(folder, tmp_path / "map.nc", 0.2, executor=2)
    theirs = {int(path.name.rsplit("-", 1)[1]) for path in folder.iterdir()}
    assert theirs and running.pid not in theirs
    running.send_signal(signal.SIGKILL)
    running.wait()
    limit = time.monotonic() + 30
    while any(map(there, theirs)) and time.monotonic() < limit:
        time.sleep(0.1)
    assert not any(map(there, theirs))


def test_processes_end_whose_parent_ended_while_they_started(tmp_path: Path) -> None:
    """Assert that processes end as well that have not begun yet when the one that asked is killed."""
    script = tmp_path / "begin.py"
    script.write_text(BEGIN)
    running = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True)
    assert running.stdout is not None
    with running.stdout as said:
        theirs = set(map(int, said.readline().split()))
    assert running.wait(timeout=60) == -signal.SIGKILL and len(theirs) == 2
    limit = time.monotonic() + 30
    while any(map(there, theirs)) and time.monotonic() < limit:
        time.sleep(0.1)
    assert not any(map(there, theirs))


def there(process: int) -> bool:
    """Whether a process runs, if only to wait."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    state = Path(f"/proc/{process}/stat")
    return not (state.exists() and state.read_text().rpartition(")")[2].split()[0] == "Z")


def test_finished_map_is_read(folder: Path, tmp_path: Path) -> None:
    """Assert that the same call on a finished map computes nothing, and resume=False all anew."""
    given, store = task(f=Counted(folder)), tmp_path / "map.nc"
    first = per.design_map(given, GRID, 1, store=store)
    second = per.design_map(given, GRID, 1, store=store)
    assert first.identical(second) and len(cells(folder)) == 12
    per.design_map(given, GRID, 1, store=store, resume=False)
    assert len(cells(folder)) == 24


@pytest.mark.parametrize("where", ["reason", "unit", "name", "attribute", "nothing of a cell"])
def test_map_that_a_terminal_would_obey(where: str, tmp_path: Path) -> None:
    """Assert that a finished map with an escape sequence in a text is refused, its seal made anew."""
    store = tmp_path / "map.nc"
    per.design_map(task(), GRID, 1, store=store)
    data = xr.load_dataset(store, engine="h5netcdf", decode_times=False)
    if where == "reason":
        data["reason"][:] = "\x1b[31m"
    elif where == "unit":
        data["peak"].attrs["units"] = "\x1b[31m"
    elif where == "name":
        data = data.rename({"peak": "\x1b[31m"})
    elif where == "nothing of a cell":
        data = data.drop_vars("status")
    else:
        data.attrs["title"] = "a\nb"
    store.write_bytes(netcdf.packed(data))
    with pytest.raises(per.maps.MapFileError, match="another file or damaged") as caught:
        per.design_map(task(), GRID, 1, store=store)
    assert str(caught.value).isprintable()


def test_journal_with_other_numbers(tmp_path: Path) -> None:
    """Assert that a journal of the same map with numbers that the map has not is refused."""
    store, journal = tmp_path / "map.nc", tmp_path / "map.nc.journal"

    def press(progress: per.maps.Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(per.maps.MapInterrupted):
        per.design_map(task(), GRID, 1, store=store, chunk=3, progress=press)
    with closing(sqlite3.connect(journal)) as base:
        (said,) = base.execute("SELECT content FROM chunks WHERE number = 1").fetchone()
        said = said.replace('"peak"', '"other"')
        base.execute(
            "UPDATE chunks SET content = ?, digest = ? WHERE number = 1", (said, digest(said.encode()))
        )
        base.commit()
    with pytest.raises(per.maps.MapFileError, match=r"map\.nc\.journal', which is another file or damaged"):
        per.design_map(task(), GRID, 1, store=store, chunk=3)


def test_interrupted_map_has_what_there_is(tmp_path: Path) -> None:
    """Assert that Ctrl-C leaves the cells so far in its exception and in the file, and the call goes on."""
    store = tmp_path / "map.nc"

    def press(progress: per.maps.Progress) -> None:
        if progress.done == 6:
            raise KeyboardInterrupt

    with pytest.raises(per.maps.MapInterrupted, match="interrupted after 6 of 12 cells") as caught:
        per.design_map(task(), GRID, 1, store=store, chunk=3, progress=press)
    for data in (caught.value.found, xr.load_dataset(store)):
        assert (data["status"] == "not done").sum() == 6 == np.isnan(data["peak"]).sum()
    told: list[per.maps.Progress] = []
    found = per.design_map(task(), GRID, 1, store=store, chunk=3, progress=told.append)
    assert [p.done for p in told] == [9, 12] and (found["status"] == "done").all()


@pytest.mark.parametrize(
    ("other", "said"),
    [
        ({"grid": {"F": [0.5, 1.0], "zeta": [0.1]}}, "grid zeta = .*; now they are"),
        ({"task": task(other=height)}, "numbers "),
        (
            {
                "task": per.maps.Task(
                    LinearOscillator(), "Omega", (0.4, 0.55), numbers={"peak": height}, tol=1e-3
                )
            },
            "bounds ",
        ),
    ],
)
def test_other_map_is_not_gone_on_with(other: dict[str, Any], said: str, tmp_path: Path) -> None:
    """Assert that a finished and an unfinished map of something else are left alone, in one sentence."""
    asked = {"task": task(), "grid": {"F": [0.5, 1.0], "zeta": [0.1, 0.2]}}
    finished, begun = tmp_path / "done.nc", tmp_path / "begun.nc"
    per.design_map(**asked, executor=1, store=finished)
    content = finished.read_bytes()

    def press(progress: per.maps.Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(per.maps.MapInterrupted):
        per.design_map(**asked, executor=1, store=begun, chunk=2, progress=press)
    begun.unlink()  # the journal is enough
    for store in (finished, begun):
        with pytest.raises(per.maps.MapFileError, match=f"holds a map made with .*{said}.*resume=False"):
            per.design_map(**{**asked, **other}, executor=1, store=store)
    assert finished.read_bytes() == content


def test_foreign_files_are_left_alone(tmp_path: Path) -> None:
    """Assert that folders, other files and damaged ones are refused and stay as they are."""
    (tmp_path / "folder").mkdir()
    with pytest.raises(per.maps.MapFileError, match="which is no ordinary file; choose another"):
        per.design_map(task(), GRID, 1, store=tmp_path / "folder")
    with pytest.raises(per.maps.MapFileError, match=r"cannot be written \(No such file or directory\)"):
        per.design_map(task(), GRID, 1, store=tmp_path / "nowhere" / "map.nc")
    (tmp_path / "text.nc").write_text("my diary")
    xr.Dataset({"a": 1}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    per.design_map(task(), {"F": [1.0]}, 1, store=tmp_path / "damaged.nc")
    content = bytearray((tmp_path / "damaged.nc").read_bytes())
    content[len(content) // 2] ^= 1
    (tmp_path / "damaged.nc").write_bytes(content)
    for name in ("text.nc", "other.nc", "damaged.nc"):
        before = (tmp_path / name).read_bytes()
        for resume in (True, False):
            with pytest.raises(per.maps.MapFileError, match="which is another file or damaged; it is not"):
                per.design_map(task(), {"F": [1.0]}, 1, store=tmp_path / name, resume=resume)
        assert (tmp_path / name).read_bytes() == before


def test_damaged_journal_is_gone_on_with_up_to_the_damage(tmp_path: Path) -> None:
    """Assert that of a journal that was cut short the whole chunks count."""
    store, journal = tmp_path / "map.nc", tmp_path / "map.nc.journal"

    def press(progress: per.maps.Progress) -> None:
        if progress.done == 9:
            shutil.copy(journal, tmp_path / "copy")
            raise KeyboardInterrupt

    with pytest.raises(per.maps.MapInterrupted):
        per.design_map(task(), GRID, 1, store=store, chunk=3, progress=press)
    for part in (0.8, 0.0):
        content = (tmp_path / "copy").read_bytes()
        journal.write_bytes(content[: int(part * len(content))])
        found = per.design_map(task(), GRID, 1, store=store, chunk=3)
        assert (found["status"] == "done").all()
        store.unlink()


def test_full_disk_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert one warning for a disk that is full, the whole result, and the file when there is room again."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    store = tmp_path / "map.nc"

    def fill(progress: per.maps.Progress) -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096 if progress.done < 9 else before[0], before[1]))

    try:
        with pytest.warns(UserWarning, match="cannot be written to .*; the map goes on") as warned:
            found = per.design_map(task(), GRID, 1, store=store, chunk=1, progress=fill)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert len(warned) == 1 and (found["status"] == "done").all()
    assert (xr.load_dataset(store)["peak"] == found["peak"]).all()


def test_full_disk_to_the_end(tmp_path: Path) -> None:
    """Assert that a file that cannot be written at all costs a warning and not the result."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        with pytest.warns(UserWarning, match="cannot be written to"):
            resource.setrlimit(resource.RLIMIT_FSIZE, (0, before[1]))
            found = per.design_map(task(), {"F": [1.0, 2.0]}, 1, store=tmp_path / "map.nc")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert (found["status"] == "done").all() and not (tmp_path / "map.nc").exists()


def test_file_is_written_meanwhile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the file of a map under way can be read, and says what is not done."""
    monkeypatch.setattr(stores, "LEAST_SECONDS", 0.0)
    monkeypatch.setattr(stores, "RARELY", 0.0)
    store, seen = tmp_path / "map.nc", []

    def look(progress: per.maps.Progress) -> None:
        seen.append(int((xr.load_dataset(store)["status"] == "done").sum()))

    per.design_map(task(), GRID, 1, store=store, chunk=4, progress=look)
    assert seen == [4, 8, 12]


def test_file_is_written_again_when_that_costs_little(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a file whose writing took a second is written again after RARELY seconds, not before."""
    clock = [1000.0]
    monkeypatch.setattr(stores, "perf_counter", lambda: clock[0])

    def slowly(data: xr.Dataset) -> bytes:
        clock[0] += 1.0
        return b""

    monkeypatch.setattr(stores, "packed", slowly)
    with stores.Store(tmp_path / "map.nc", {}, False) as store:
        store.write(xr.Dataset(), False)
        rest = max(stores.LEAST_SECONDS, stores.RARELY)
        for later, due in ((0.9 * rest, False), (0.2 * rest, True)):
            clock[0] += later
            assert store.due() is due


def test_signal_during_the_import_of_xarray_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a map is interrupted after the import: half-way, pandas raises what nobody expects."""
    done, genuine = [], builtins.__import__

    def interrupted(name: str, *given: Any) -> Any:
        if name == "xarray":
            signal.raise_signal(signal.SIGINT)
            done.append(name)
        return genuine(name, *given)

    monkeypatch.setattr(builtins, "__import__", interrupted)
    with pytest.raises(KeyboardInterrupt):
        dataset(None, None, {})  # type: ignore[arg-type]
    assert done == ["xarray"]
