"""Workers that die and executors that go away: a cell with its reason or one sentence, nothing lost."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.maps import GRID, Deadly, task

import periodic as per
from periodic.workers.execution import DIED

pytestmark = pytest.mark.faults


class KilledWorker(Exception):  # noqa: N818
    """As dask.distributed says that several workers have died of one piece of work."""


class Failing(Executor):
    """Computes here, and fails in a way of its own at chunks that hold a cell."""

    def __init__(self, cell: tuple[float, ...], how: Callable[[Future[Any]], object]) -> None:
        self.cell, self.how = cell, how

    def submit(self, function: Any, /, *arguments: Any, **_: Any) -> Future[Any]:
        future: Future[Any] = Future()
        if self.cell in arguments[2]:
            self.how(future)
        else:
            future.set_result(function(*arguments))
        return future


def refuse(future: Future[Any]) -> None:
    """As a closed executor does."""
    raise RuntimeError("cannot schedule new futures after shutdown")


def test_cell_that_kills_its_process() -> None:
    """Assert that all other cells are computed, and that the deadly one says so."""
    grid = {"F": [1.0], "zeta": [0.1, 0.2, 0.3, 0.4]}
    found = per.design_map(task(z=Deadly((0.2,))), grid, 2, store=None, chunk=2)
    assert found["status"].values.tolist() == [["done", "lost", "done", "done"]]
    assert found["reason"].values.tolist() == [["", DIED, "", ""]]
    assert found["z"].values[0, [0, 2, 3]].tolist() == [0.1, 0.3, 0.4] and np.isnan(found["z"].values[0, 1])


def test_lost_cells_are_tried_again(tmp_path: Path) -> None:
    """Assert that the same call computes what was lost, and that alone."""
    store, cell = tmp_path / "map.nc", (1.0, 0.2)
    pool = Failing(cell, lambda future: future.set_exception(KilledWorker("4 workers died")))
    found = per.design_map(task(), GRID, pool, store=store, chunk=3)
    assert found["reason"].sel(F=1.0, zeta=0.2) == DIED and (found["status"] == "done").sum() == 11
    told: list[per.maps.Progress] = []
    again = per.design_map(task(), GRID, 1, store=store, chunk=3, progress=told.append)
    assert [p.done for p in told] == [12] and (again["status"] == "done").all()
    assert [path.name for path in tmp_path.iterdir()] == ["map.nc"]


@pytest.mark.parametrize(
    ("how", "said"),
    [
        (lambda future: future.cancel() and future.set_running_or_notify_cancel(), "it called off work"),
        (refuse, "RuntimeError: cannot schedule new futures after shutdown"),
        (lambda future: future.set_exception(BrokenExecutor("all dead")), "BrokenExecutor: all dead"),
    ],
)
def test_executor_that_goes_away(how: Any, said: str, tmp_path: Path) -> None:
    """Assert one sentence, what was computed in it and in the store, and that the call goes on."""
    store = tmp_path / "map.nc"
    with pytest.raises(per.maps.MapStoppedError) as caught:
        per.design_map(task(), GRID, Failing((1.5, 0.3), how), store=store, chunk=2)
    sentence, found = str(caught.value), caught.value.found
    assert sentence.startswith(f"the executor went away ({said}") and "the same call goes on" in sentence
    done = int((found["status"] == "done").sum())
    assert 0 < done < 12 and f"after {done} of 12 cells" in sentence
    told: list[per.maps.Progress] = []
    again = per.design_map(task(), GRID, 1, store=store, chunk=2, progress=told.append)
    assert told[0].done == done + 2 and (again["status"] == "done").all()
    assert again["peak"].equals(per.design_map(task(), GRID, 1, store=None, chunk=2)["peak"])
    assert np.isnan(found["peak"].values[found["status"] == "not done"]).all()


def test_defect_in_a_worker_is_raised_and_the_rest_kept(tmp_path: Path) -> None:
    """Assert that an exception that is no failure of a cell comes out, after what was done is kept."""
    pool = Failing((1.0, 0.3), lambda future: future.set_exception(KeyError("x")))
    with pytest.raises(KeyError):
        per.design_map(task(), GRID, pool, store=tmp_path / "map.nc", chunk=2)
    told: list[per.maps.Progress] = []
    per.design_map(task(), GRID, 1, store=tmp_path / "map.nc", chunk=2, progress=told.append)
    assert told[0].done > 2
