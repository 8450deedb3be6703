"""Small functions of maps, of branches that are given: values by hand."""

from __future__ import annotations

import signal
from concurrent.futures import Future
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.numpy_systems import LinearOscillator

import periodic as per
from periodic.bifurcations.label import Label
from periodic.maps import chunks, grid
from periodic.maps.cell import Outcome
from periodic.maps.dataset import _column, _owner, _status, check_numbers, dataset
from periodic.maps.numbers import extremes
from periodic.maps.numbers.places import _alone
from periodic.maps.numbers.reading import read, settled, unit_of
from periodic.workers import executors

HEIGHT = per.PeakToPeak("x")


class Given(list[Any]):
    """A branch of points that are given."""

    @property
    def stable(self) -> Any:
        """Whether each is."""
        return np.array([point.stable for point in self])

    @property
    def values(self) -> Any:
        """Their parameters."""
        return np.array([point.parameter for point in self])

    def labelled(self, label: str) -> list[Any]:
        """Those of a kind."""
        return [point for point in self if point.label == label]


def branch(stable: str, heights: Any = (), labels: Any = ()) -> Any:
    """A branch at parameters 1, 2, ... of which s points are stable, u are not."""
    heights = [*heights, *[0.0] * len(stable)]
    labels = [*labels, *[Label.NONE] * len(stable)]
    points = (
        SimpleNamespace(
            parameter=1.0 + k,
            stable=kind == "s",
            label=labels[k],
            maximum={"x": 3.0 + heights[k]},
            minimum={"x": 3.0},
            orbit=object(),
        )
        for k, kind in enumerate(stable)
    )
    return Given(points)


TASK: Any = SimpleNamespace(system=LinearOscillator(), parameter="Omega", watch=None)


@pytest.mark.parametrize(
    ("stable", "ranges"),
    [
        ("ssuuss", [(1.0, 2.0), (5.0, 6.0)]),
        ("uuu", []),
        ("sss", [(1.0, 3.0)]),
        ("sus", [(1.0, 1.0), (3.0, 3.0)]),
        ("usu", [(2.0, 2.0)]),
    ],
)
def test_ranges_that_are_stable(stable: str, ranges: list[tuple[float, float]]) -> None:
    """Assert the parameter at both ends of each."""
    found = per.maps.StableRanges()(TASK, branch(stable))
    assert list(zip(found["from"], found["to"], strict=True)) == ranges


@pytest.mark.parametrize(
    ("stable", "fold", "counts"),
    [
        ("ssuu", 2, [True, True, True, False]),
        ("uuss", 1, [False, True, True, True]),
        ("uuuu", 1, [False, False, False, False]),
        ("suuu", 2, [True, False, False, False]),
    ],
)
def test_folds_end_stable_stretches(stable: str, fold: int, counts: list[bool]) -> None:
    """Assert that a critical point counts beside a stable one, and no other."""
    labels = [Label.FOLD if k == fold else Label.NONE for k in range(4)]
    assert settled(branch(stable, labels=labels)).tolist() == counts


def test_points_between_two_stable_stretches() -> None:
    """Assert that a single one that is not stable parts them, and is in neither."""
    assert _alone(branch("susuus")).tolist() == [False, True, False, False, False, False]
    fold = [Label.NONE, Label.FOLD, Label.NONE]
    assert per.maps.StableRanges()(TASK, branch("sus", labels=fold)) == {"from": [1.0, 3.0], "to": [1.0, 3.0]}


@pytest.mark.parametrize(
    ("kind", "stable", "only", "value", "at"),
    [
        (per.maps.Highest, "ssss", False, 9.0, 4.0),
        (per.maps.Lowest, "ssss", False, 1.0, 1.0),
        (per.maps.Highest, "ssuu", True, 5.0, 2.0),
        (per.maps.Lowest, "uuss", True, 7.0, 3.0),
    ],
)
def test_extremes_at_points(kind: Any, stable: str, only: bool, value: float, at: float) -> None:
    """Assert the value and the parameter of a branch on which heights rise."""
    found = kind(HEIGHT, stable=only)(TASK, branch(stable, [1.0, 5.0, 7.0, 9.0]))
    assert found == {"": value, "at": at}


def test_extreme_of_no_orbit() -> None:
    """Assert that it is no number."""
    found = per.maps.Highest(HEIGHT, stable=True)(TASK, branch("uu"))
    assert np.isnan([found[""], found["at"]]).all()


@pytest.mark.parametrize(
    ("sign", "between", "value", "at"),
    [(1.0, 8.0, 8.0, 2.25), (1.0, 6.0, 7.0, 2.0), (-1.0, 2.0, 2.0, 2.25), (1.0, None, 7.0, 2.0)],
)
def test_extremes_between_points(
    sign: float, between: float | None, value: float, at: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the stationary value where it exceeds that of the best point, else this one's."""
    found = None if between is None else (between, 2.25)
    monkeypatch.setattr(extremes, "stationary", lambda *_: found)
    heights = [1.0, 7.0, 2.0] if sign > 0 else [9.0, 3.0, 8.0]
    got = extremes._extreme(TASK, branch("sss", heights), HEIGHT, sign, False)
    assert got == {"": value, "at": at}


def test_places_of_special_points() -> None:
    """Assert the parameter, or a functional, of each."""
    labels = [Label.NONE, Label.FOLD, Label.NONE, Label.FOLD]
    given = branch("ssss", [1.0, 5.0, 7.0, 9.0], labels)
    assert per.maps.Places("LP")(TASK, given) == [2.0, 4.0]
    assert per.maps.Places("LP", HEIGHT)(TASK, given) == [5.0, 9.0]
    assert per.maps.Places("PD")(TASK, given) == []
    assert per.maps.Places("LP").units(TASK) == {"": "rad/s"}
    assert per.maps.Places("LP", HEIGHT).units(TASK) == {"": "m"}


def test_sheets_at_a_value() -> None:
    """Assert each orbit there once, also where it stands twice at a special point, and which are stable."""
    given = branch("suss", [1.0, 5.0, 7.0, 9.0])
    for point in given[1:]:
        point.parameter = 2.0
    given[2].orbit = given[1].orbit
    assert per.maps.Sheets(HEIGHT, 2.0)(TASK, given) == {"": [5.0, 9.0], "stable": [0.0, 1.0]}
    assert per.maps.Sheets(HEIGHT, 3.0)(TASK, given) == {"": [], "stable": []}
    assert per.maps.Sheets(HEIGHT, 2.0).units(TASK) == {"": "m", "stable": ""}


def test_what_points_know_is_read_off_them() -> None:
    """Assert maximum, minimum and their difference, and that any other functional is computed."""
    (point,) = branch("s", [2.0])
    system = TASK.system
    assert [read(system, point, kind("x")) for kind in (per.Maximum, per.Minimum, per.PeakToPeak)] == [
        5,
        3,
        2,
    ]
    functional: Any = lambda system, orbit: 7.0  # noqa: E731
    assert read(system, point, functional) == 7.0
    assert [unit_of(system, each) for each in (HEIGHT, per.Value("F"), functional)] == ["m", "N", ""]


def test_order_in_which_cells_are_walked() -> None:
    """Assert rows there and back, and chunks of neighbours."""
    plan = per.maps.Grid({"a": (1.0, 2.0), "b": (3.0, 4.0, 5.0)})
    ((first, second),) = plan.rounds({}, 4)
    assert first == ((1.0, 3.0), (1.0, 4.0), (1.0, 5.0), (2.0, 5.0))
    assert second == ((2.0, 4.0), (2.0, 3.0))
    laid = plan.arranged({})
    assert dict(laid.dimensions) == {"a": 2, "b": 3} and laid.cells[1] == (1.0, 4.0)
    assert dict(laid.coordinates) == {"a": ("a", (1.0, 2.0)), "b": ("b", (3.0, 4.0, 5.0))}
    assert plan.described() == {"a": [1.0, 2.0], "b": [3.0, 4.0, 5.0]} and plan.total == 6


@pytest.mark.parametrize(("count", "refused"), [(1000, False), (1001, True)])
def test_most_cells(count: int, refused: bool) -> None:
    """Assert a million of them."""
    values = {"a": range(count), "b": range(1000)}
    if refused:
        with pytest.raises(ValueError, match="^grid has 1001000 cells; it must have at most 1000000$"):
            per.maps.Grid(values)
    else:
        assert per.maps.Grid(values).total == grid.MOST_CELLS


@pytest.mark.parametrize(
    ("given", "further", "values"),
    [
        ([1.0, None, 3.0], (), [1.0, np.nan, 3.0]),
        ([[1.0, 2.0], None, [3.0], []], ("n number",), [[1, 2], [np.nan] * 2, [3, np.nan], [np.nan] * 2]),
        ([[1.0], 5.0], ("n number",), [[1.0], [5.0]]),
    ],
)
def test_column_of_a_number(given: list[Any], further: tuple[str, ...], values: list[Any]) -> None:
    """Assert that several values have a dimension of their own, filled up with NaN."""
    found, column = _column("n", given)
    assert found == further
    np.testing.assert_array_equal(column, np.array(values, dtype=float))


def test_owner_and_status() -> None:
    """Assert the number that a column is of, by the longest name, and what became of a cell."""
    task: Any = SimpleNamespace(numbers={"peak": 1, "peak load": 2})
    assert [_owner(task, name) for name in ("peak", "peak at", "peak load", "peak load at")] == [
        *["peak"] * 2,
        *["peak load"] * 2,
    ]
    states = [Outcome((1.0,)), Outcome((1.0,), reason="why"), Outcome((1.0,), reason="died", lost=True)]
    assert [_status(each) for each in states] == ["done", "failed", "lost"]
    with pytest.raises(ValueError, match="numbers has 'cell', which a map has already"):
        check_numbers(SimpleNamespace(numbers={"cell": 1}), ["a"])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="numbers has 'a', which"):
        check_numbers(SimpleNamespace(numbers={"a": 1}), ["a"])  # type: ignore[arg-type]


def test_dataset_of_a_map() -> None:
    """Assert numbers, statements and units over the parameters, also of cells that are not done."""
    task: Any = SimpleNamespace(
        system=LinearOscillator(),
        parameter="Omega",
        bounds=(1, 2),
        numbers={"peak": 1},
        units={"peak": "m", "peak at": "rad/s"},
    )
    plan = per.maps.Grid({"zeta": (0.1, 0.2), "F": (1.0,)})
    cell = Outcome((0.2, 1.0), {"peak": 3.0, "peak at": 4.0}, points=5, newton=6, seconds=7.0)
    found = dataset(task, plan, {cell.cell: cell})
    np.testing.assert_array_equal(found["peak"].values, [[np.nan], [3.0]])
    assert found["peak at"].dims == ("zeta", "F") and found["peak at"].attrs == {"units": "rad/s"}
    assert found["status"].values.tolist() == [["not done"], ["done"]]
    assert [found[name].values[1, 0] for name in ("points", "newton", "seconds")] == [5, 6, 7.0]
    assert found["seconds"].attrs == {"units": "s"} and found["F"].attrs == {"units": "N"}
    assert found.attrs == {"parameter": "Omega", "bounds": [1.0, 2.0]}


@pytest.mark.parametrize(("begins", "attempts"), [(1.0, 1), (1.5, 2)])
def test_neighbour_whose_sheet_does_not_reach_the_start(begins: float, attempts: int) -> None:
    """Assert that a branch from a neighbour counts where it begins at the start, and is traced anew else."""
    asked: list[Any] = []

    def traced(values: Any, near: Any) -> Any:
        asked.append(near)
        at = begins if near is not None else 1.0
        return SimpleNamespace(points=[SimpleNamespace(parameter=at)], backwards=0, stops=())

    task: Any = SimpleNamespace(traced=traced, begin=1.0)
    found, reason = chunks._attempted(task, {}, "orbit")  # type: ignore[arg-type]
    assert found is not None and found.points[0].parameter == 1.0 and reason == ""
    assert asked == ["orbit", None][:attempts]


@pytest.mark.parametrize("error", chunks.FAILURES)
def test_numbers_that_fail_are_a_reason(error: type[Exception]) -> None:
    """Assert that a cell has none of its numbers then, and which failed; a defect comes out."""

    def fails(task: Any, branch: Any) -> float:
        raise error("it is lost")

    good: Any = lambda task, branch: {"": 1.0, "at": [2.0, 3.0]}  # noqa: E731
    task: Any = SimpleNamespace(numbers={"peak": good})
    assert chunks._read(task, None) == ({"peak": 1.0, "peak at": [2.0, 3.0]}, "")  # type: ignore[arg-type]
    task.numbers["other"] = fails
    numbers, reason = chunks._read(task, None)  # type: ignore[arg-type]
    assert numbers == {} and reason.startswith("other: ") and "it is lost" in reason
    task.numbers["other"] = lambda task, branch: "text"
    with pytest.raises(TypeError):
        chunks._read(task, None)  # type: ignore[arg-type]


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="Windows has no such signals")
def test_process_that_tidies_up_does_not_hear_a_closed_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is started with the signal blocked, which is let through again afterwards."""
    from loky.backend import resource_tracker

    blocked: list[bool] = []

    def running() -> None:
        blocked.append(signal.SIGHUP in signal.pthread_sigmask(signal.SIG_BLOCK, set()))
        raise RuntimeError("not started")

    monkeypatch.setattr(resource_tracker, "ensure_running", running)
    before = signal.pthread_sigmask(signal.SIG_BLOCK, set())
    with pytest.raises(RuntimeError, match="not started"):
        executors._tracked()
    assert blocked == [True] and signal.pthread_sigmask(signal.SIG_BLOCK, set()) == before


def test_users_executor_is_left_as_it_is() -> None:
    """Assert that work is given on, that what has not begun is cancelled, and nothing else."""

    class Executor:
        """Keeps work, and does none."""

        def __init__(self) -> None:
            self.given: list[Any] = []

        def submit(self, function: Any, *arguments: Any) -> Future[Any]:
            future: Future[Any] = Future()
            self.given.append((function, arguments, future))
            return future

    user: Any = Executor()
    own = executors.Given(user)
    first, second = own.submit(max, 1, 2), own.submit(min, 3)
    assert [each[:2] for each in user.given] == [(max, (1, 2)), (min, (3,))] and not own.own
    first.set_result(2)
    own.close()
    assert second.cancelled() and first.result() == 2 and not first.cancelled()
