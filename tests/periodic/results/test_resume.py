"""Interrupted branches that are taken up again, from memory and from a file, end as uninterrupted ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.grids import spread
from support.resumed import OPTIONS, disc_options, duffing_options, whole
from support.traces import DUFFING_A, duffing_system

import periodic as per
from periodic.results.journal import Journal
from periodic.tracing.start import Start


def interrupted_after(count: int) -> Callable[[per.Point], None]:
    """A progress callback that is Ctrl-C at the given point."""
    left = [count]

    def progress(point: per.Point) -> None:
        left[0] -= 1
        if left[0] == 0:
            raise KeyboardInterrupt

    return progress


def cut(count: int, which: str = "duffing", **options: Any) -> per.Branch:
    """The branch that is interrupted at a point, or a whole one that has fewer."""
    given = OPTIONS[which](progress=interrupted_after(count))
    try:
        return per.trace(**{**given, **options})
    except per.Interrupted as interrupted:
        return interrupted.branch


@pytest.mark.parametrize(
    ("which", "count"),
    [
        *spread((("duffing", k) for k in (1, 2, 8, 17, 18, 19, 20, 21, 30, 40, 41, 42, 47, 52)), 4),
        *spread([("disc", 15), ("disc", 40)], 1),
    ],
)
def test_resumed_branch_is_the_uninterrupted_one(which: str, count: int, tmp_path: Path) -> None:
    """Assert that points, labels and reasons agree, the parameter to 1e-11, wherever it was cut."""
    options, expected = OPTIONS[which](), whole(which)
    part = cut(count, which)
    assert per.Reason.INTERRUPTED in (part.stop.reason, part.stop_backwards and part.stop_backwards.reason)
    assert count - 4 <= len(part) <= count
    part.save(tmp_path / "part.nc")
    found = per.trace(**options, guess=per.Branch.load(tmp_path / "part.nc"))
    assert len(found) == len(expected)
    assert [p.label for p in found] == [p.label for p in expected]
    assert [p.event for p in found] == [p.event for p in expected]
    assert found.values == pytest.approx(expected.values, rel=1e-11)
    assert found.peak_to_peak("x") == pytest.approx(expected.peak_to_peak("x"), rel=1e-10)
    assert (found.stop, found.stop_backwards) == (expected.stop, expected.stop_backwards)
    assert found.newton_iterations >= part.newton_iterations


def test_interrupted_again_and_again() -> None:
    """Assert that a branch interrupted every few points ends as an uninterrupted one."""
    expected, branch = whole("duffing"), cut(5)
    for _ in range(40):
        if per.Reason.INTERRUPTED not in (branch.stop.reason,):
            break
        branch = cut(7, guess=branch)
    assert len(branch) == len(expected)
    assert branch.values == pytest.approx(expected.values, rel=1e-11)


def test_interrupt_before_a_resumed_run_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that nothing is lost where Ctrl-C comes while a branch is taken up again."""
    options = duffing_options()
    part = cut(15)

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Start, "found", interrupt)
        with pytest.raises(per.Interrupted) as interrupted:
            per.trace(**options, guess=part)
    again = interrupted.value.branch
    assert again.values == pytest.approx(part.values)
    found = per.trace(**options, guess=again)
    assert found.values == pytest.approx(whole("duffing").values, rel=1e-11)


def test_interrupt_in_the_first_of_two_keeps_the_second() -> None:
    """Assert that a run that had used up its points stays while the other goes on."""
    part = per.trace(**duffing_options(), control=per.ArclengthControl(max_points=12))
    again = cut(3, guess=part)
    assert len(again) >= len(part)


def test_finished_branch_stays_as_it_is() -> None:
    """Assert that resuming a finished branch gives it back."""
    expected = whole("duffing")
    again = per.trace(**duffing_options(), guess=expected)
    assert [id(p.orbit) for p in again] == [id(p.orbit) for p in expected]
    assert (again.stop, again.stop_backwards) == (expected.stop, expected.stop_backwards)


def test_more_points_can_be_asked_for() -> None:
    """Assert that a branch that used up its points goes on with more."""
    options = duffing_options()
    part = per.trace(**options, control=per.ArclengthControl(max_points=12))
    assert part.stop.reason is per.Reason.MAX_POINTS
    found, expected = per.trace(**options, guess=part), whole("duffing")
    assert found.values == pytest.approx(expected.values, rel=1e-11)


def test_other_branches_are_refused() -> None:
    """Assert the sentences about a branch of another system, parameter or start."""
    branch = whole("duffing")
    with pytest.raises(
        ValueError, match="guess is a branch in Omega with .* points; it must be one in speed"
    ):
        per.trace(**disc_options(), guess=branch)
    with pytest.raises(ValueError, match="guess is a branch in Omega with .* it must be one in F"):
        per.trace(duffing_system(*DUFFING_A), "F", (0.1, 1.0), guess=branch)
    system = duffing_system(*DUFFING_A)
    changes: dict[str, dict[str, Any]] = {
        "bounds": {"bounds": (1.0, 3.0)},
        "method": {"method": per.HarmonicBalance()},
        "values": {"values": {"c": 0.2}},
        "tolerance": {"tol": per.Accuracy.FINE},
        "at": {"at": ()},
    }
    for name, change in changes.items():
        with pytest.raises(ValueError, match=f"guess is a branch made with {name} .*; now they are"):
            per.trace(**{**duffing_options(), **change}, guess=branch)
    options: dict[str, Any] = {"system": system, "parameter": "Omega", "bounds": (0.3, 3.0)}
    with pytest.raises(per.Interrupted) as interrupted:
        per.trace(**options, watch=per.Watch(progress=interrupted_after(5)))
    part = interrupted.value.branch
    with pytest.raises(ValueError, match="start and bounds must be as before"):
        per.trace(**options, start=3.0, guess=part)


def test_counts_survive() -> None:
    """Assert that the n-th point of a kind is counted from the branch's own start."""
    system = duffing_system(*DUFFING_A)
    options: dict[str, Any] = {
        "system": system,
        "parameter": "Omega",
        "bounds": (0.3, 3.0),
    }
    expected = per.trace(**options, watch=per.Watch(stop={"LP": 2}))
    pressed = interrupted_after(len(expected) - 2)
    with pytest.raises(per.Interrupted) as interrupted:
        per.trace(**options, watch=per.Watch(stop={"LP": 2}, progress=pressed))
    part = interrupted.value.branch
    assert [p.label for p in part].count(per.Label.FOLD) == 1
    found = per.trace(**options, guess=part, watch=per.Watch(stop={"LP": 2}))
    assert np.array([p.parameter for p in found]) == pytest.approx(expected.values, rel=1e-11)
    assert found.stop == expected.stop


def test_branch_from_a_guess_is_taken_up() -> None:
    """Assert that a branch begun at an orbit of other parameters, from a place of its own, is taken up."""
    system = duffing_system(*DUFFING_A)
    (upper, *_) = per.trace(system, "Omega", (0.3, 3.0), at=[1.8], values={"c": 0.12}).labelled("UZ")
    options: dict[str, Any] = {"system": system, "parameter": "Omega", "bounds": (1.5, 2.5)}
    expected = per.trace(**options, guess=upper.orbit)
    assert expected[0].orbit.parameters["c"] == 0.12
    with pytest.raises(per.Interrupted) as interrupted:
        per.trace(**options, guess=upper.orbit, watch=per.Watch(progress=interrupted_after(9)))
    found = per.trace(**options, guess=interrupted.value.branch)
    assert found.values == pytest.approx(expected.values, rel=1e-11)
    assert (found.stop, found.stop_backwards) == (expected.stop, expected.stop_backwards)
    with pytest.raises(per.ResumeError, match="guess is a branch made with values .*c = 0.12"):
        per.trace(**options, guess=interrupted.value.branch, values={"c": 0.1})


def test_branch_from_a_doubling_is_taken_up() -> None:
    """Assert that a branch that was begun at an orbit of its own making goes on as it would have."""
    system = duffing_system(*DUFFING_A)
    (fold, _) = whole("duffing").labelled("LP")
    options: dict[str, Any] = {"determined": {"F": per.FoldCondition()}, "tol": 1e-5}
    expected = per.trace(system, "Omega", (2.0, 2.4), guess=fold.orbit, **options)
    with pytest.raises(per.Interrupted) as interrupted:
        watch = per.Watch(progress=interrupted_after(5))
        per.trace(system, "Omega", (2.0, 2.4), guess=fold.orbit, watch=watch, **options)
    found = per.trace(system, "Omega", (2.0, 2.4), guess=interrupted.value.branch, **options)
    assert found.column("F") == pytest.approx(expected.column("F"), rel=1e-12)


class Keeper:
    """A progress callback with much behind it, and itself."""

    def __init__(self) -> None:
        self.chain: list[Any] = []
        for _ in range(3000):
            self.chain = [self.chain, self]

    def show(self, point: per.Point) -> None:
        """Do nothing."""


def test_what_watches_is_not_described() -> None:
    """Assert that callbacks and journals are no part of what a branch is made with."""
    branch = per.trace(
        duffing_system(*DUFFING_A), "Omega", (0.3, 0.5), watch=per.Watch(progress=Keeper().show)
    )
    assert not {"is", "progress", "journal"} & set(branch.made)
    assert "code" not in str(branch.made["method"])


def test_interrupt_while_the_journal_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that Ctrl-C during any write, the last one too, leaves with the branch, each point once."""
    arguments = (duffing_system(*DUFFING_A), "Omega", (0.3, 0.6))
    expected, add = per.trace(*arguments), Journal.add
    for which in (2, 4, 10**6):
        count = 0

        def pressed(self: Journal, *given: Any, at: int = which) -> None:
            nonlocal count
            count += 1
            add(self, *given)
            if count == at or given[1].reason is per.Reason.BOUND:
                raise KeyboardInterrupt

        with monkeypatch.context() as patch:
            patch.setattr(Journal, "add", pressed)
            with pytest.raises(per.Interrupted) as interrupted:
                per.trace(*arguments, watch=per.Watch(journal=tmp_path / f"{which}"))
        known = per.recovered(tmp_path / f"{which}")
        assert len(known) == len(interrupted.value.branch) <= len(expected)
        assert known.values == pytest.approx(expected.values[: len(known)], rel=1e-12)
        (tmp_path / f"{which}").unlink()


def test_journal_of_a_single_step(tmp_path: Path) -> None:
    """Assert that what a trace had done after its first step is recovered: names, scales and points."""
    branch = cut(1)
    with Journal(tmp_path / "one", replace(branch, points=())) as journal:
        journal.add(branch.points, branch.stop, branch.checkpoints[0] if branch.checkpoints else None)
    found = per.recovered(tmp_path / "one")
    assert found.values.tolist() == branch.values.tolist() and found.parameter == branch.parameter
    assert [found.layout, found.made] == [branch.layout, branch.made]
