"""The survey of random models: rows are kept, gone on from, and counted on a page."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

import periodic as per
from periodic.events import switchpolynomials
from periodic.system import HELD
from reports.studies.pages.engine import current
from survey import rows as surveyed
from survey.page import page
from survey.rows import BACK, Limits, Row, drawn, models, read, row, write
from survey.sampled import FAR, outside, strays


def test_all_models_are_drawn_once() -> None:
    """Assert that there are 900, 100 chains among them."""
    drawn = list(models())
    assert len(set(drawn)) == len(drawn) == 900
    assert sum(kind == "chains" for kind, _ in drawn) == 100


def test_row_is_kept(tmp_path: Path) -> None:
    """Assert that a model is traced and judged, and its row read as written."""
    file = tmp_path / "rows.jsonl"
    found = row("gears", 100, 2)
    assert (found.fate, found.judged, found.wrong, found.gaps) == ("to the end", 2, (), ())
    assert found.engine.removesuffix("+") == current().commit
    assert 0 < found.ratio < 1
    write(file, found)
    assert read([file, tmp_path / "none"]) == {("gears", 100): found}


def test_branch_that_comes_back_at_another_orbit() -> None:
    """Assert that it is traced to its end: past a fold, not along itself; others that come back are not."""
    found = row("gears", 102, 0)
    assert BACK in found.told
    assert (found.fate, found.retraced) == ("to the end", False)
    assert replace(found, retraced=True).fate == "other"
    for reason, fate in (("UNBOUNDED", "to the end"), ("VANISHED", "to the end"), ("SMALL_STEP", "other")):
        assert replace(found, reason=reason).fate == fate


def test_page_counts() -> None:
    """Assert what the page says of one that is right, one that is wrong and one that is not traced."""
    right = Row("gears", 100, "BOUND", "bound reached: upper end", 10, judged=8, ratio=0.5)
    wrong = Row("gears", 101, "BOUND", "bound reached: upper end", 5, judged=8, wrong=("Omega 1: orbit",))
    short = Row("chains", 100, "MAX_POINTS", "largest number of points reached: 400 points", 400)
    told = page([right, wrong, short])
    assert "3 of 900 models: one to three masses" in told
    assert "**2 of 3 are traced to the end; 1 of the 16 points judged is wrong.**" in told
    assert "| gears | 2 | 2 | 0 | 0 | 0 | 15 | 16 | 1 | 0 | 0.5 | 0 |" in told
    assert "| chains | 1 | 0 | 1 | 0 | 0 | 400 | 0 | 0 | 0 | 0 | 0 |" in told
    assert "| gears 101 | Omega 1: orbit |" in told
    assert "| chains 100 | largest number of points reached: 400 points (400 points, 0 s) |" in told


def test_models_with_joints_count_from_both_ends() -> None:
    """Assert what the page says of two models, one of which is traced to its end from one end only."""
    rows = [
        Row(kind, seed, "BOUND", "bound reached") for kind in ("joints", "joints down") for seed in (1, 2)
    ]
    rows[3] = Row("joints down", 2, "NO_START", "no orbit found at the start")
    assert "**Of 2 models with several joints traced from both ends 1 are so from both.**" in page(rows)
    assert "**Of 1 models with several joints traced from both ends 1 are so from both.**" in page(rows[:3])
    assert "| chains |" not in page(rows)


def test_page_tells_of_narrower_limits() -> None:
    """Assert how many models with several joints ended at limits of work below those of today."""
    assert "allowed less" not in page([Row("joints", 1, "INTERRUPTED", "interrupted", seconds=3520.0)])
    rows = [Row("joints", 1, "INTERRUPTED", "interrupted", seconds=300.0)]
    rows += [Row("joints", 2, "MAX_NEWTON", "iterations", newton=40000), Row("joints", 3, "BOUND", "end")]
    rows += [
        Row("joints", 4, "MAX_POINTS", "points", points=3000),
        Row("gears", 5, "INTERRUPTED", "interrupted"),
    ]
    assert " 3 that ended at a limit of work were allowed less than those traced today.\n" in page(rows)


def test_page_names_engines() -> None:
    """Assert that the page has the commit of one engine, and of several how many models each has traced."""
    old, new = (Row("gears", 100 + k, "BOUND", "bound reached", engine=f"abc{k}") for k in range(2))
    assert "\nEngine at commit `abc0`.\n" in page([old])
    told = page([old, new, new, Row("gears", 102, "BOUND", "bound reached")])
    assert (
        "\nEngine at commit `abc1` (2 models), commit `abc0` (1 models), commits not recorded (1 models).\n"
        in told
    )


def test_points_that_do_not_keep_their_words(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that samples show friction past its limit before an event that tears it off.

    As long as it looked for that at the joint's own event nodes alone, such points claimed 1e-10.
    """
    case = drawn("joints", 197)
    bounds = (0.846, 0.86)
    right = per.trace(case.system, "Omega", bounds, start=bounds[0], tol=1e-6)
    assert strays(case.system, right) == []
    monkeypatch.setattr(switchpolynomials, "torn", lambda *_: False)
    wrong = per.trace(case.system, "Omega", bounds, start=bounds[0], tol=1e-6)
    told = strays(case.system, wrong)
    assert told and f"Omega {wrong[-1].parameter!r}: " in told[-1]
    assert all("d(q0 - q2)/dt = 0" in each and "outside its mode" in each for each in told)


def test_joints_are_judged() -> None:
    """Assert that points of three masses with two joints of Coulomb and cubic springs are right."""
    found = row("joints down", 123, 3)
    assert (found.judged, found.wrong, found.unjudged) == (3, (), ())
    assert 0 < found.ratio < 1


@pytest.mark.parametrize(("kind", "seed", "count"), [("friction", 134, 4), ("impacts", 193, 15)])
def test_motions_that_stay_where_they_are(
    kind: str, seed: int, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that points are right where friction holds two masses together, or chatter ends in rest.

    Of impacts 193 the last of these points lies 1e-8 before the place where its bounces are no longer
    complete; the branch is cut there by its points, as how far it comes in a time is the machine's affair.
    """
    monkeypatch.setattr(surveyed, "FEW", Limits(max(count, 15), 4000, 600.0))
    found = row(kind, seed, count)
    assert (found.wrong, found.unjudged) == ((), ())
    assert found.judged == count
    assert found.ratio < 1


@pytest.mark.parametrize(("past", "seen"), [(2e-16, False), (2e-13, True)])
def test_samples_allow_for_rounding(past: float, seen: bool) -> None:
    """Assert that what is held with limits of 1e-11 beside a state of 1 is looked at but for rounding."""
    system = Surfaces([joint()], [[0.0, 1.0], [0.0, -1.0], [0.0, 1.0]])
    motion = partial(barely, past=past)
    far, where = outside(system, along(motion, modes=[(0, HELD)]))
    assert bool(far > FAR) is seen
    assert where.startswith("s1 at 0.0000 rad") is seen


def barely(tau: Any, past: float) -> Any:
    """A large state, and a small one that is a little below 0 where tau is 0."""
    return np.array([np.ones_like(tau), 1e-11 * np.sin(tau / 2) ** 2 - past]).T
