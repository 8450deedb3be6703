"""Chunks on workers that die, refuse and stop, cells one after the other, and what a run tells: by hand."""

from __future__ import annotations

from concurrent.futures import BrokenExecutor, Future
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.maps import chunks, store
from periodic.maps import map as maps
from periodic.maps.cell import Outcome
from periodic.maps.map import Run
from periodic.maps.numbers import stationary
from periodic.maps.progress import Progress
from periodic.maps.store import LEAST_SECONDS, RARELY, Store
from periodic.workers.execution import DIED, Execution, ExecutorGoneError

CHUNKS = [((1.0,), (2.0,)), ((3.0,), (4.0,)), ((5.0,),)]


class Workers:
    """Does work at once, but for cells of which a worker dies; some are done later, the last first."""

    def __init__(self, deadly: tuple[float, ...] = (), own: bool = True, ahead: int = 2) -> None:
        self.deadly, self.own, self.ahead = deadly, own, ahead
        self.closed, self.most = 0, 0
        self.asked: list[Any] = []
        self.under_way: list[Any] = []

    def submit(self, chunk: Any) -> Future[Any]:
        """What becomes of a chunk."""
        future: Future[Any] = Future()
        self.asked.append(chunk)
        if any(cell[0] in self.deadly for cell in chunk):
            future.set_exception(BrokenExecutor("a worker died"))
        else:
            future.set_result([Outcome(cell) for cell in chunk])
        return future

    def close(self) -> None:
        """Note it."""
        self.closed += 1


def done(workers: Any, work: Any = CHUNKS) -> list[Any]:
    """Cells with the reason why they have no numbers, chunk by chunk."""
    found = Execution(workers, lambda chunk: (chunk,), maps._lost).outcomes(work)
    return [[(outcome.cell[0], outcome.reason, outcome.lost) for outcome in each] for each in found]


def fine(*cells: float) -> list[Any]:
    """Cells that are computed."""
    return [(cell, "", False) for cell in cells]


def test_chunks_in_the_order_in_which_they_are_done() -> None:
    """Assert each chunk once, and nothing closed."""
    workers = Workers()
    assert done(workers) == [fine(1, 2), fine(3, 4), fine(5)]
    assert workers.asked == CHUNKS and workers.closed == 0


def test_no_more_than_so_many_are_begun_ahead() -> None:
    """Assert that a chunk is given when one of two is done."""
    given: list[Any] = []

    class Later(Workers):
        """Does the one that was given last."""

        def submit(self, chunk: Any) -> Future[Any]:
            given.append((chunk, Future()))
            if len(given) >= 2:
                given[-1][1].set_result([Outcome(cell) for cell in chunk])
            if len(given) == 3:
                given[0][1].set_result([Outcome(cell) for cell in given[0][0]])
            return given[-1][1]  # type: ignore[no-any-return]

    assert sorted(done(Later())) == sorted([fine(3, 4), fine(5), fine(1, 2)])


@pytest.mark.parametrize("deadly", [1.0, 2.0])
def test_cell_of_which_a_worker_dies(deadly: float) -> None:
    """Assert that the chunk is tried again by itself, then cell by cell, and that one cell is lost."""
    workers = Workers((deadly,))
    found = done(workers)
    lost = [(deadly, DIED, True)]
    assert sorted(found) == sorted([lost, fine(3.0 - deadly), fine(3, 4), fine(5)])
    assert workers.asked.count(CHUNKS[0]) == 2 and workers.closed == 3


def test_chunk_beside_one_that_died_is_not_lost() -> None:
    """Assert that of two chunks that were under way only the cell is lost of which both died."""

    class All(Workers):
        """All die with one."""

        def submit(self, chunk: Any) -> Future[Any]:
            future = super().submit(chunk)
            if len(self.asked) == 2 and chunk == CHUNKS[1]:
                future = Future()
                future.set_exception(BrokenExecutor("died with the other"))
            return future

    found = done(All((5.0,)), [CHUNKS[2], CHUNKS[1]])
    assert sorted(found) == sorted([[(5.0, DIED, True)], fine(3, 4)])


def test_executor_of_the_users_that_breaks_is_gone() -> None:
    """Assert what is said, and that nothing of it is closed."""
    workers = Workers((3.0,), own=False, ahead=1)
    with pytest.raises(ExecutorGoneError, match="^BrokenExecutor: a worker died$"):
        done(workers)
    assert workers.closed == 0


def test_executor_that_takes_no_more_work() -> None:
    """Assert that what is done by then is given first."""

    class Full(Workers):
        """Takes two chunks."""

        def submit(self, chunk: Any) -> Future[Any]:
            if len(self.asked) == 2:
                raise RuntimeError("cannot schedule\n new futures")
            return super().submit(chunk)

    found: list[Any] = []
    with pytest.raises(ExecutorGoneError, match="^RuntimeError: cannot schedule new futures$"):
        for outcomes in Execution(Full(ahead=3), lambda chunk: (chunk,), maps._lost).outcomes(CHUNKS):  # type: ignore[arg-type]
            found.append(outcomes)
    assert [len(each) for each in found] == [2, 2]


def test_work_that_is_called_off() -> None:
    """Assert the sentence."""

    class Off(Workers):
        """Cancels."""

        def submit(self, chunk: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    with pytest.raises(ExecutorGoneError, match="^it called off work that it had accepted$"):
        done(Off())


def test_defects_are_raised() -> None:
    """Assert that what the work itself raises is no worker that died."""

    class Defect(Workers):
        """Raises."""

        def submit(self, chunk: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_exception(KeyError("a defect"))
            return future

    with pytest.raises(KeyError, match="a defect"):
        done(Defect())


class Branches:
    """A task whose branches are given: by the cell's value and whether they begin near another."""

    begin = 0.0

    def __init__(self, **numbers: Any) -> None:
        self.numbers = numbers or {"peak": lambda task, branch: branch.peak}
        self.asked: list[Any] = []

    def traced(self, values: Any, near: Any) -> Any:
        """A branch; cell 3 has none, cell 4 ends early, cell 5 begins elsewhere if it begins near another."""
        (value,) = values.values()
        self.asked.append((value, near))
        if value == 3.0:
            raise ArithmeticError("no  orbit\nat all")
        stop = SimpleNamespace(reason=SimpleNamespace(numerical=value == 4.0))
        elsewhere = 1.0 if value == 5.0 and near is not None else 0.0
        own = Points([1, 2, 3])
        own.peak, own.stops, own.newton_iterations, own.begins = 10 * value, [stop], 7, elsewhere
        return own


class Points(list[Any]):
    """A branch."""

    peak: float
    stops: list[Any]
    newton_iterations: int
    begins: float


@pytest.fixture
def cells(monkeypatch: pytest.MonkeyPatch) -> Any:
    """What becomes of cells, one after the other."""
    monkeypatch.setattr(chunks, "Task", Branches)

    def start(branch: Any) -> Any:
        return SimpleNamespace(orbit=f"orbit of {branch.peak:g}", parameter=branch.begins)

    monkeypatch.setattr(chunks, "start_of", start)

    def computed(task: Branches, *values: float) -> list[Outcome]:
        return chunks.computed(task, ["p"], [(value,) for value in values])  # type: ignore[arg-type]

    return computed


def test_cells_begin_at_the_one_before(cells: Any) -> None:
    """Assert the first orbit from which each begins, the numbers and what they took."""
    task = Branches()
    found = cells(task, 1.0, 2.0)
    assert task.asked == [(1.0, None), (2.0, "orbit of 10")]
    assert [(o.cell, o.numbers, o.reason, o.points, o.newton, o.lost) for o in found] == [
        ((1.0,), {"peak": 10.0}, "", 3, 7, False),
        ((2.0,), {"peak": 20.0}, "", 3, 7, False),
    ]
    assert all(0 <= outcome.seconds < 10 for outcome in found)


def test_cells_that_fail(cells: Any) -> None:
    """Assert the reason, that each is tried from scratch too, and where the next one begins."""
    task = Branches()
    found = cells(task, 1.0, 3.0, 4.0, 5.0)
    near = "orbit of 10"
    assert task.asked == [(1, None), (3, near), (3, None), (4, near), (4, None), (5, near), (5, None)]
    assert [outcome.numbers for outcome in found] == [{"peak": 10.0}, {}, {}, {"peak": 50.0}]
    assert found[1].reason == "ArithmeticError: no orbit at all" and (found[1].points, found[1].newton) == (
        0,
        0,
    )
    assert found[2].reason and (found[2].points, found[2].newton) == (3, 7)


def test_numbers_of_a_branch(cells: Any) -> None:
    """Assert names of several, sequences, and what is no number."""

    def wrong(task: Any, branch: Any) -> Any:
        raise ValueError("no such output")

    several = {"a": lambda task, branch: {"": 1, "at": [2, 3.5]}, "b": lambda task, branch: np.array([4.0])}
    (found,) = cells(Branches(**several), 1.0)
    assert found.numbers == {"a": 1.0, "a at": [2.0, 3.5], "b": [4.0]}
    (found,) = cells(Branches(a=several["b"], b=wrong), 1.0)
    assert found.numbers == {} and found.reason == "b: no such output"
    for value in ("x", [[1.0]]):
        task = Branches(a=lambda task, branch, value=value: value)
        with pytest.raises(TypeError, match="^number a gave .*; it must give a number or a sequence of num"):
            cells(task, 1.0)


def known(**cells: Any) -> Run:
    """A run of four cells, some of which are known."""
    plan: Any = SimpleNamespace(total=4, rounds=lambda found, size: [[((1.0,), (2.0,)), ((3.0,), (4.0,))]])
    own = Run(None, plan, 2, None, None, begun=100.0)  # type: ignore[arg-type]
    own.found = {(float(k),): Outcome((float(k),), reason=why) for k, why in enumerate(cells.values(), 1)}
    return own


def test_progress_of_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert cells done and failed, the time, and that left at the rate of this call."""
    monkeypatch.setattr(maps, "perf_counter", lambda: 130.0)
    run = known(a="", b="why", c="")
    assert run._progress(1) == Progress(3, 4, 1, 30.0, 15.0)
    assert run._progress(3) == Progress(3, 4, 1, 30.0, float("inf"))


def test_run_computes_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the chunks without what is known, what is told after each, and the sentence of one that ends."""
    run, told, asked = known(a=""), list[Progress](), list[Any]()
    run.progress = told.append

    def outcomes(work: Any) -> Any:
        asked.extend(work)
        return iter([[Outcome(cell) for cell in chunk] for chunk in work])

    run.through(SimpleNamespace(outcomes=outcomes))  # type: ignore[arg-type]
    assert asked == [((2.0,),), ((3.0,), (4.0,))] and sorted(run.found) == [(1.0,), (2.0,), (3.0,), (4.0,)]
    assert [progress.done for progress in told] == [2, 4]
    assert run.stopped("interrupted") == "interrupted after 4 of 4 cells, which are in its `found`"


@pytest.mark.parametrize(("lost", "complete"), [(False, True), (True, False)])
def test_map_is_complete_without_lost_cells(
    lost: bool, complete: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert what the store is told, and where it is kept."""
    run = known(a="", b="", c="", d="")
    run.found[(4.0,)] = Outcome((4.0,), lost=lost)
    told: list[Any] = []
    run.store = SimpleNamespace(
        write=lambda data, complete: told.append((data, complete)), path=Path("a/b.nc")
    )  # type: ignore[assignment]
    monkeypatch.setattr(Run, "dataset", lambda self: "data")
    assert run.written() == "data" and told == [("data", complete)]  # type: ignore[comparison-overlap]
    assert run.stopped("why").endswith("in its `found` and kept in 'a/b.nc'; the same call goes on")


@pytest.mark.parametrize(
    ("cost", "since", "due"),
    [
        (0.0, LEAST_SECONDS * 0.99, False),
        (0.0, LEAST_SECONDS * 1.01, True),
        (2.0, RARELY * 2.0 * 0.99, False),
        (2.0, RARELY * 2.0 * 1.01, True),
    ],
)
def test_time_to_write(cost: float, since: float, due: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert ten seconds since the last time, or twenty times as long as that took."""
    monkeypatch.setattr(store, "perf_counter", lambda: 1000.0 + since)
    own: Any = SimpleNamespace(_written=1000.0, _cost=cost)
    assert Store.due(own) is due


@pytest.mark.parametrize(
    ("values", "place", "between"),
    [
        ([1.0, 2.0, 3.0], 5.0, True),
        ([1.0, 2.0, 3.0], 5.01, False),
        ([1.0, 2.0, 3.0], -1.0, True),
        ([1.0, 2.0, 3.0], -1.01, False),
        ([1.0, 2.0, 1.5], 2.9, True),
    ],
)
def test_place_beside_a_point(values: list[float], place: float, between: bool) -> None:
    """Assert that it lies among a point and its neighbours, or as far again beyond them."""
    branch: Any = SimpleNamespace(values=np.array([9.0, *values, 9.0]))
    assert stationary._between(branch, 2, place) is between


def test_parameter_that_is_free_to_be_held() -> None:
    """Assert the first that is neither continued in nor determined."""
    system = SimpleNamespace(parameters=[SimpleNamespace(name=name) for name in "abc"])
    task: Any = SimpleNamespace(parameter="a", system=system, problem=SimpleNamespace(determined={"b": None}))
    assert stationary._another(task) == "c"
    task.problem.determined = {"b": None, "c": None}
    assert stationary._another(task) is None
