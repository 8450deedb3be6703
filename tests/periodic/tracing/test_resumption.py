"""Branches that are gone on with: which are refused, and where each run goes on."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from periodic.tracing import resumption
from periodic.tracing.resumption import ResumeError, check, taken_up


class Points(list[str]):
    """A branch of points from the end of the run backwards to that of the run onwards."""

    parameter, layout, made = "p", "layout", "made"

    def __init__(
        self, points: str, backwards: int = 0, signs: tuple[int, ...] = (1,), done: bool = False
    ) -> None:
        super().__init__(points)
        self.points, self.backwards = [*points], backwards
        self.stop, self.stop_backwards = "onwards", "backwards" if backwards else None
        self.checkpoints = [SimpleNamespace(sign=sign, done=done) for sign in signs]


class Run:
    """A run one way, which goes on with what follows."""

    def __init__(self, sign: int) -> None:
        self.sign = sign
        self.collected: Any = None
        self.stop: Any = None
        self.ended: Any = None

    def resumed(self, points: Any, checkpoint: Any) -> Any:
        """What follows of points."""
        yield f"after {''.join(points)} {checkpoint.sign}"

    def __iter__(self) -> Any:
        yield f"begun {self.sign}"


@pytest.fixture(autouse=True)
def given(monkeypatch: pytest.MonkeyPatch) -> None:
    """The start of a branch is its point S."""
    monkeypatch.setattr(resumption, "start_of", lambda branch: "S")
    monkeypatch.setattr(resumption, "reversed_run", lambda points: [p.lower() for p in points[::-1]])


def test_run_one_way_goes_on() -> None:
    """Assert its points, why it had ended, and what follows."""
    run: Any = Run(1)
    (following,) = taken_up([run], Points("SXY"))  # type: ignore[arg-type]
    assert list(following) == ["after SXY 1"]
    assert (run.collected, run.stop, run.ended.sign) == (["S", "X", "Y"], "onwards", 1)


def test_runs_both_ways_go_on() -> None:
    """Assert that the points backwards are those from the start on, in reverse."""
    runs: Any = [Run(-1), Run(1)]
    each = [list(points) for points in taken_up(runs, Points("ABSXY", 2, (-1, 1)))]  # type: ignore[arg-type]
    assert each == [["after Sba -1"], ["after SXY 1"]]
    assert [run.stop for run in runs] == ["backwards", "onwards"]


def test_run_that_was_not_begun() -> None:
    """Assert that it begins where the other one had not ended."""
    runs: Any = [Run(-1), Run(1)]
    each = [list(points) for points in taken_up(runs, Points("SXY", signs=(-1,)))]  # type: ignore[arg-type]
    assert each == [["after SXY -1"], ["begun 1"]]
    assert (runs[0].stop, runs[1].stop, runs[1].collected) == ("onwards", None, None)


def test_run_that_is_done() -> None:
    """Assert that nothing follows, and that its points are kept."""
    run: Any = Run(1)
    (following,) = taken_up([run], Points("SX", done=True))  # type: ignore[arg-type]
    assert list(following) == [] and run.collected == ["S", "X"]


def test_branch_of_another_direction_is_refused() -> None:
    """Assert the sentence."""
    with pytest.raises(
        ResumeError, match="^guess is a branch with another start; start and bounds must be as b"
    ):
        taken_up([Run(1)], Points("SX", signs=(-1,)))  # type: ignore[arg-type, list-item]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({}, None),
        (
            {"parameter": "q"},
            "guess is a branch in q with 2 points; it must be one in p of this system, with points",
        ),
        ({"layout": "other"}, "guess is a branch in p with 2 points; it must be one in p of this system"),
        ({"points": []}, "guess is a branch in p with 2 points; it must be one in p of this system"),
        ({"made": "differently"}, "guess is a branch made with one; and with other"),
    ],
)
def test_branches_of_other_problems(change: Any, said: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert what is refused, and that the same one is not."""
    monkeypatch.setattr(resumption, "start_of", lambda branch: SimpleNamespace(parameter=1.5))
    monkeypatch.setattr(resumption, "layout_of", lambda system: "layout")
    monkeypatch.setattr(resumption, "made_with", lambda setup: "made")
    monkeypatch.setattr(resumption, "differences", lambda a, b, may: [] if a == b else ["one", "other"])
    setup: Any = SimpleNamespace(problem=SimpleNamespace(parameter="p", full=None), begin=1.5)
    branch: Any = Points("SX")
    for name, value in change.items():
        setattr(branch, name, value)
    if said is None:
        check(branch, setup)
        setup.begin = 1.0
        said = "guess is a branch with another start; start and bounds must be as before"
    with pytest.raises(ResumeError) as refused:
        check(branch, setup)
    assert str(refused.value).startswith(said)
