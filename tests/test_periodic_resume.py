"""Interrupted branches that are taken up again, from memory and from a file, end as uninterrupted ones."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from traces import DUFFING_A, RPM, disc_system, duffing_system

import periodic as per


def interrupted_after(count: int) -> Callable[[per.Point], None]:
    """A progress callback that is Ctrl-C at the given point."""
    left = [count]

    def progress(point: per.Point) -> None:
        left[0] -= 1
        if left[0] == 0:
            raise KeyboardInterrupt

    return progress


def duffing_options() -> dict[str, Any]:
    """A branch traced both ways, with user points, events and columns."""
    return {
        "system": duffing_system(*DUFFING_A),
        "parameter": "Omega",
        "bounds": (0.3, 3.0),
        "start": 1.0,
        "at": [1.7],
        "columns": {"amplitude": per.Amplitude("x")},
        "events": {"three": per.Level(per.PeakToPeak("x"), 3.0)},
    }


def disc_options() -> dict[str, Any]:
    """The disc through its folds."""
    return {
        "system": disc_system("vitrea79-810N"),
        "parameter": "speed",
        "bounds": (200 * RPM, 300 * RPM),
        "start": 300 * RPM,
    }


@cache
def whole(which: str) -> per.Branch:
    """The branch without an interrupt."""
    return per.trace(**OPTIONS[which]())


OPTIONS = {"duffing": duffing_options, "disc": disc_options}


@pytest.mark.parametrize(
    ("which", "count"),
    [*(("duffing", k) for k in (1, 2, 8, 17, 18, 19, 30, 40, 41, 42, 60, 71)), ("disc", 15), ("disc", 40)],
)
def test_resumed_branch_is_the_uninterrupted_one(which: str, count: int, tmp_path: Path) -> None:
    """Assert that points, labels and reasons agree, the parameter to 1e-11, wherever it was cut."""
    options, expected = OPTIONS[which](), whole(which)
    part = per.trace(**options, progress=interrupted_after(count))
    assert per.Reason.INTERRUPTED in (part.stop.reason, part.stop_backwards and part.stop_backwards.reason)
    assert count - 4 <= len(part) <= count
    part.save(tmp_path / "part.nc")
    found = per.trace(**options, resume=per.Branch.load(tmp_path / "part.nc"))
    assert len(found) == len(expected)
    assert [p.label for p in found] == [p.label for p in expected]
    assert [p.event for p in found] == [p.event for p in expected]
    assert found.values == pytest.approx(expected.values, rel=1e-11)
    assert found.peak_to_peak("x") == pytest.approx(expected.peak_to_peak("x"), rel=1e-7)
    assert (found.stop, found.stop_backwards) == (expected.stop, expected.stop_backwards)
    assert found.newton_iterations >= part.newton_iterations


def test_interrupted_again_and_again() -> None:
    """Assert that a branch interrupted every few points ends as an uninterrupted one."""
    options, expected = duffing_options(), whole("duffing")
    branch = per.trace(**options, progress=interrupted_after(5))
    for _ in range(40):
        if per.Reason.INTERRUPTED not in (branch.stop.reason,):
            break
        branch = per.trace(**options, resume=branch, progress=interrupted_after(7))
    assert len(branch) == len(expected)
    assert branch.values == pytest.approx(expected.values, rel=1e-11)


def test_interrupt_before_a_resumed_run_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that nothing is lost where Ctrl-C comes while a branch is taken up again."""
    options = duffing_options()
    part = per.trace(**options, progress=interrupted_after(15))

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(per.Run, "_first", interrupt)
        again = per.trace(**options, resume=part)
    assert again.values == pytest.approx(part.values)
    found = per.trace(**options, resume=again)
    assert found.values == pytest.approx(whole("duffing").values, rel=1e-11)


def test_interrupt_in_the_first_of_two_keeps_the_second() -> None:
    """Assert that a run that had used up its points stays while the other goes on."""
    options = duffing_options()
    part = per.trace(**options, settings=per.Settings(step=per.StepSettings(max_points=12)))
    again = per.trace(**options, settings=per.Settings(), resume=part, progress=interrupted_after(3))
    assert len(again) >= len(part)


def test_finished_branch_stays_as_it_is() -> None:
    """Assert that resuming a finished branch gives it back."""
    expected = whole("duffing")
    again = per.trace(**duffing_options(), resume=expected)
    assert [id(p.orbit) for p in again] == [id(p.orbit) for p in expected]
    assert (again.stop, again.stop_backwards) == (expected.stop, expected.stop_backwards)


def test_more_points_can_be_asked_for() -> None:
    """Assert that a branch that used up its points goes on with more."""
    options = duffing_options()
    few = per.Settings(step=per.StepSettings(max_points=12))
    part = per.trace(**options, settings=few)
    assert part.stop.reason is per.Reason.MAX_POINTS
    found = per.trace(**options, settings=per.Settings(), resume=part)
    expected = per.trace(**options, settings=per.Settings())
    assert found.values == pytest.approx(expected.values, rel=1e-11)


def test_other_branches_are_refused() -> None:
    """Assert the sentences about a branch of another system, parameter or start."""
    branch = whole("duffing")
    with pytest.raises(
        ValueError, match="resume is a branch in Omega with .* points; it must be one in speed"
    ):
        per.trace(**disc_options(), resume=branch)
    with pytest.raises(ValueError, match="resume is a branch in Omega with .* it must be one in F"):
        per.trace(duffing_system(*DUFFING_A), "F", (0.1, 1.0), resume=branch)
    system = duffing_system(*DUFFING_A)
    changes: dict[str, dict[str, Any]] = {
        "bounds": {"bounds": (1.0, 3.0)},
        "method": {"method": per.HarmonicBalance()},
        "values": {"values": {"c": 0.2}},
        "settings": {"accuracy": per.Accuracy.FINE},
        "at": {"at": ()},
    }
    for name, change in changes.items():
        with pytest.raises(ValueError, match=f"resume is a branch made with {name} .*; now they are"):
            per.trace(**{**duffing_options(), **change}, resume=branch)
    options: dict[str, Any] = {"system": system, "parameter": "Omega", "bounds": (0.3, 3.0)}
    part = per.trace(**options, progress=interrupted_after(5))
    with pytest.raises(ValueError, match="start and bounds must be as before"):
        per.trace(**options, start=3.0, resume=part)


def test_counts_survive() -> None:
    """Assert that the n-th point of a kind is counted from the branch's own start."""
    system = duffing_system(*DUFFING_A)
    options: dict[str, Any] = {
        "system": system,
        "parameter": "Omega",
        "bounds": (0.3, 3.0),
        "stop": {"LP": 2},
    }
    expected = per.trace(**options)
    part = per.trace(**options, progress=interrupted_after(len(expected) - 2))
    assert [p.label for p in part].count(per.Label.FOLD) == 1
    found = per.trace(**options, resume=part)
    assert np.array([p.parameter for p in found]) == pytest.approx(expected.values, rel=1e-11)
    assert found.stop == expected.stop
