"""A run along a branch: what it counts, keeps and ends at, step by step, on solutions that are given."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import Course
from periodic.results.stop import Reason, Stop
from periodic.tracing import continuation, trace
from periodic.tracing.continuation import Continuation
from periodic.tracing.state import State
from periodic.tracing.steps.patternchange import Crossed
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.steps.taken import NEARLY, Step

CONTROL = ArclengthControl(ds=0.1, ds_min=1e-3, ds_max=0.5)


def solution(value: float = 1.0, name: str = "") -> Any:
    """A solution at a value of the parameter between 0 and 5."""
    return SimpleNamespace(value=value, name=name, orbit=name, equilibrium=False)


def met(label: Label, value: float = 1.0, name: str = "", shrunk: bool = False) -> Any:
    """A special point."""
    return SimpleNamespace(label=label, name=name, solution=solution(value), shrunk=shrunk, within=0.25)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Continuation:
    """A run that has taken four steps from 1.0 and keeps two points; it shall end at the second fold."""
    problem = SimpleNamespace(low=0.0, high=5.0)
    solver: Any = SimpleNamespace(problem=problem)
    watch: Any = SimpleNamespace(stop={"LP": 2, "event": 1}, progress=None)
    own = Continuation(solver, None, 1, CONTROL, watch, user=(2.0,))  # type: ignore[arg-type]
    own.collected = [point("first"), point("second")]
    own.state = State(solution(1.0), solution(1.5), 1, 0.1, 4, 3, True, {}, 2, 1e-3)

    def emitted(self: Continuation, found: Any, label: Label, event: str = "", within: float = 0.0) -> Any:
        self.collected.append(point(found.name, label, event, found.value))
        self.collected[-1].within = within  # type: ignore[attr-defined]
        return self.collected[-1]

    monkeypatch.setattr(Continuation, "_emitted", emitted)
    monkeypatch.setattr(continuation, "closes", lambda solver, begun, found: found.value == begun.value)
    monkeypatch.setattr(continuation, "same", lambda solver, begun, found: begun.value == found.value)
    return own


def point(name: str, label: Label = Label.NONE, event: str = "", value: float = 0.0) -> Any:
    """A point of a branch."""
    return SimpleNamespace(name=name, label=label, event=event, value=value)


def labels(run: Continuation) -> list[tuple[Label, str]]:
    """What has been added to the two points."""
    return [(p.label, p.event) for p in run.collected[2:]]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("special", "emitted", "reason"),
    [
        (met(Label.FOLD), [(Label.FOLD, "")], None),
        (met(Label.USER, 2.0), [(Label.USER, "")], None),
        (met(Label.USER, 3.0), [], None),
        (met(Label.USER, 1.0), [(Label.END, "")], Reason.CLOSED),
        (met(Label.USER, 3.0, "other event"), [(Label.USER, "other event")], None),
        (met(Label.USER, 3.0, "event"), [(Label.USER, "event")], Reason.ASKED),
        (met(Label.END, 5.0), [(Label.END, "")], Reason.BOUND),
        (met(Label.END, 3.0, "limit"), [(Label.END, "limit")], Reason.BOUND),
        (met(Label.HOPF, 3.0, shrunk=True), [(Label.HOPF, "")], Reason.EQUILIBRIUM),
    ],
)
def test_special_points_on_the_way(
    special: Any, emitted: Any, reason: Reason | None, run: Continuation
) -> None:
    """Assert the point that each gives, and which of them ends the branch."""
    list(run._met(special))
    assert labels(run) == emitted
    assert (run.stop.reason if run.stop else None) is reason


def test_begin_is_met_again_only_after_it_was_left(run: Continuation) -> None:
    """Assert that the branch closes at its first orbit once it has been elsewhere."""
    assert run.state is not None
    run.state = replace(run.state, left=False)
    list(run._met(met(Label.USER, 1.0)))
    assert run.stop is None and labels(run) == []
    run.state = replace(run.state, left=True)
    list(run._met(met(Label.USER, 1.0)))
    assert run.stop == Stop.after(Reason.CLOSED, 5)


def test_branch_ends_at_the_label_that_is_asked_for(run: Continuation) -> None:
    """Assert the count of each, and that the second fold ends it, once."""
    for _ in range(2):
        assert run.stop is None
        list(run._met(met(Label.FOLD)))
    assert run.stop == Stop.asked("LP", 2) and run._count == {"LP": 2}
    run._counted("event")
    assert run.stop == Stop.asked("LP", 2) and run._count == {"LP": 2, "event": 1}


def test_only_completed_steps_are_kept(run: Continuation) -> None:
    """Assert that points of a step that was cut short go, and before the first orbit none."""
    run.collected.append(point("third"))
    assert run.kept == 2
    stop = Stop.after(Reason.INTERRUPTED, 2)
    run.cut(stop)
    assert [p.name for p in run.collected] == ["first", "second"] and run.stop is stop  # type: ignore[attr-defined]
    run.state = None
    assert run.kept == 2


@pytest.mark.parametrize(("further", "least"), [(0.3, 1e-3), (1e-2, 1e-3), (0.5e-1, 1e-3)])
def test_completed_step(further: float, least: float, run: Continuation) -> None:
    """Assert what the state is after it."""
    run._since_remesh, course = 7, Course()
    run._completed(Step(solution(1.7, "end"), further, [], course))
    state = run.state
    assert state is not None
    assert (state.last.value, state.ds, state.steps, state.since_remesh, state.kept) == (
        1.7,
        further,
        5,
        7,
        3,
    )
    assert state.course is course and state.left and state.met == {} and labels(run) == [(Label.NONE, "")]
    assert state.least == least
    run._completed(Step(solution(1.0), further, [], course))
    assert run.state is not None and run.state.left


@pytest.mark.parametrize(
    ("before", "further", "least"),
    [(1e-6, 0.1, 1e-3), (1e-6, 1e-3, 1e-5), (1e-4, 1e-3, 1e-4), (1e-2, 1e-3, 1e-3)],
)
def test_least_step_grows_with_the_steps(
    before: float, further: float, least: float, run: Continuation
) -> None:
    """Assert a hundredth of the next step, no less than before and no more than elsewhere."""
    assert run.state is not None
    run.state = replace(run.state, least=before)
    run._completed(Step(solution(1.7), further, [], Course()))
    assert run.state.least == pytest.approx(least) and NEARLY == 1e-2


@pytest.mark.parametrize(("since", "asked"), [(18, False), (19, True), (40, True)])
def test_mesh_is_made_anew_after_some_steps(
    since: int, asked: bool, run: Continuation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert when it is asked for, that the count begins again then, and that at a grazing it is kept."""
    calls: list[bool] = []
    better = solution(1.5, "better")

    def prepared(last: Any, again: bool) -> Any:
        calls.append(again)
        return better if again else last

    monkeypatch.setattr(Continuation, "_steps", SimpleNamespace(prepared=prepared))
    run._since_remesh, last = since, solution()
    assert run._prepared(last) is (better if asked else last)
    assert calls == [asked] and run._since_remesh == (0 if asked else since + 1)
    run.collected[-1] = point("grazing", Label.GRAZING)
    assert run._prepared(last) is last and calls == [asked]


def change(**more: Any) -> Any:
    """The end of a step at a change of the pattern."""
    flags = dict.fromkeys(("grazes", "last", "strict", "final", "nearer"), False)
    each = flags | {"name": "s is grazed"} | more
    return SimpleNamespace(end=solution(2.0, "end"), change=SimpleNamespace(**each))


@pytest.mark.parametrize(
    ("grazes", "change_grazes", "distance", "wanted", "ds"),
    [
        (False, False, 0.05, 0.2, 0.2),
        (False, False, 0.3, 0.2, 0.3),
        (True, False, 0.3, 0.2, 0.1),
        (False, True, 0.3, 0.2, 0.1),
    ],
)
def test_branch_goes_on_beyond_a_change(
    grazes: bool,
    change_grazes: bool,
    distance: float,
    wanted: float,
    ds: float,
    run: Continuation,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Assert the orbit beyond with its label, and the next step: a first one after a grazing."""
    found = Crossed(solution(2.1, "beyond"), distance, grazes)
    monkeypatch.setattr(continuation, "crossed", lambda *_: found)
    points = list(run._crossed(change(grazes=change_grazes), wanted))
    assert [(p.name, p.label) for p in points] == [("beyond", Label.GRAZING if grazes else Label.NONE)]  # type: ignore[attr-defined]
    state = run.state
    assert state is not None
    assert (state.last.name, state.ds, state.kept, state.steps) == ("beyond", ds, 3, 4)  # type: ignore[attr-defined]
    assert state.least == pytest.approx(min(CONTROL.ds_min, NEARLY * ds))
    assert run._count == ({Label.GRAZING: 1} if grazes else {})


@pytest.mark.parametrize("grazes", [True, False])
def test_special_points_at_a_change(grazes: bool, run: Continuation, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that they lie beyond a grazing, and before the orbit beyond another change that is final."""
    found = Crossed(solution(2.1, "beyond"), 0.1, grazes, [Label.FOLD], within=0.5)
    monkeypatch.setattr(continuation, "crossed", lambda *_: found)
    list(run._crossed(change(final=True), 0.1))
    beyond = (Label.GRAZING if grazes else Label.NONE, 2.1)
    own = (Label.FOLD, 2.1 if grazes else 2.0)
    each = [(p.label, p.value) for p in run.collected[2:]]  # type: ignore[attr-defined]
    assert each == ([beyond, own] if grazes else [own, beyond])
    blurs = {p.label: p.within for p in run.collected[2:]}  # type: ignore[attr-defined]
    assert blurs == {beyond[0]: 0.0, Label.FOLD: 0.5}


@pytest.mark.parametrize(
    ("given", "reread", "reason", "said"),
    [
        ({"last": True}, True, Reason.SMALL_STEP, "s is grazed, beyond which the motion is another one"),
        ({"strict": True}, True, None, ""),
        ({"final": True}, True, None, ""),
        ({"final": True, "nearer": True}, True, None, ""),
        ({"strict": True, "nearer": True}, True, None, ""),
        ({"strict": True}, False, Reason.SMALL_STEP, "s is grazed, and no orbit was found beyond it"),
        ({"final": True}, False, None, ""),
        ({}, False, None, ""),
    ],
)
def test_no_orbit_beyond_a_change(
    given: Any,
    reread: bool,
    reason: Reason | None,
    said: str,
    run: Continuation,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Assert that another word is read from the motion, or that the branch ends, or that a step is longer."""
    monkeypatch.setattr(continuation, "crossed", lambda *_: None)
    monkeypatch.setattr(continuation.codim2, "picked", lambda problem: None)
    asked: list[Any] = []

    def read(self: Continuation, base: Any, other: bool = False) -> bool:
        asked.append((base.name, other))
        return reread

    monkeypatch.setattr(Continuation, "_reread", read)
    points = list(run._crossed(change(**given), 0.7))
    wanted = bool(given) and "last" not in given and given != {"final": True, "nearer": True}
    assert asked == ([("end", True)] if wanted else [])
    assert len(points) == int(reread and wanted)
    assert (run.stop.reason if run.stop else None) is reason and (run.stop.detail if run.stop else "") == said
    assert run.state is not None
    longer = not run.stop and not points
    assert run.state.ds == (0.7 if longer else 0.1)


def test_special_points_at_a_change_that_is_not_final(
    run: Continuation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the branch is first followed nearer to it."""
    monkeypatch.setattr(continuation, "crossed", lambda *_: Crossed(solution(2.1), 0.1, False, [Label.FOLD]))
    assert list(run._crossed(change(), 0.7)) == [] and labels(run) == []
    assert run.state is not None and run.state.ds == 0.7


@pytest.mark.parametrize(("distance", "ds"), [(1e-4, 1e-3), (0.05, 0.05), (0.3, 0.1)])
def test_orbit_read_from_a_motion(
    distance: float, ds: float, run: Continuation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the branch goes on there, with special points at it, by a step as long as the way to it."""
    found = Crossed(solution(2.1, "read"), distance, False)
    monkeypatch.setattr(
        continuation, "reread", lambda solver, base, control, *_: found if control is CONTROL else None
    )
    monkeypatch.setattr(continuation, "at_once", lambda *_: [Label.FOLD])
    run.stop = Stop.after(Reason.INTERRUPTED, 2)
    assert run._reread(solution(2.0))
    assert run.stop is None and labels(run) == [(Label.FOLD, ""), (Label.NONE, "")]
    state = run.state
    assert state is not None and run._count == {"LP": 1}
    assert (state.last.name, state.ds, state.kept, state.steps) == ("read", ds, 4, 5)  # type: ignore[attr-defined]
    monkeypatch.setattr(continuation, "reread", lambda *_: None)
    assert not run._reread(solution(2.0)) and len(run.collected) == 4


def test_orbit_read_from_a_motion_at_a_bound(run: Continuation, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the branch ends there: what lies beyond is not in the range."""
    monkeypatch.setattr(continuation, "reread", lambda *_: Crossed(solution(5.0), 0.1, False))
    monkeypatch.setattr(continuation, "at_once", lambda *_: [])
    assert run._reread(solution(4.9)) and labels(run) == [(Label.END, "")]
    assert run.stop == Stop.bound((0.0, 5.0), 5.0, 1.0)


class Kept:
    """A journal that notes what it is given."""

    def __init__(self) -> None:
        self.pieces: list[Any] = []

    def add(self, points: list[Any], stop: Stop, checkpoint: Any) -> None:
        """Note points and why they end."""
        self.pieces.append(([p for p in points], stop.reason, checkpoint))


def going(interrupted: bool) -> tuple[Any, Iterator[int]]:
    """A run of three steps, of one point, of two and of a point that is not kept; and its points."""
    own = SimpleNamespace(collected=[], state=None, stop=None, checkpoint="there", kept=0)

    def cut(stop: Stop) -> None:
        del own.collected[own.state.kept :]
        own.stop = stop

    own.cut = cut

    def points() -> Iterator[int]:
        for number, kept in ((1, 1), (2, 1), (3, 3), (4, 3)):
            own.collected.append(number)
            own.state = SimpleNamespace(kept=kept)
            own.kept = kept
            yield number
        if interrupted:
            raise KeyboardInterrupt
        own.stop = Stop.after(Reason.MAX_POINTS, 4)

    return own, points()


def test_each_step_is_kept_once() -> None:
    """Assert the pieces of the journal: those of steps that are done, and at the end the rest."""
    own, points = going(False)
    journal: Any = Kept()
    assert trace._exhaust(own, points, journal) is False
    asked = [([1], Reason.INTERRUPTED), ([2, 3], Reason.INTERRUPTED), ([4], Reason.MAX_POINTS)]
    assert [piece[:2] for piece in journal.pieces] == asked and {p[2] for p in journal.pieces} == {"there"}
    assert trace._exhaust(*going(False), None) is False


def test_step_that_was_interrupted_is_not_kept() -> None:
    """Assert that it is told, and that the journal ends with the last step that was done."""
    own, points = going(True)
    journal: Any = Kept()
    assert trace._exhaust(own, points, journal) is True
    assert [piece[0] for piece in journal.pieces] == [[1], [2, 3], []]
    assert own.collected == [1, 2, 3] and own.stop.reason is Reason.INTERRUPTED
