"""Two speeds and their difference: where two of them vanish at once, so does the third.

Two masses with sliders and friction from either to the ground and between both: a model of the survey.
"""

from __future__ import annotations

import numpy as np
import pytest
from reference.joints.judging import judged
from support.drawn.jointcases import JointCase
from survey.rows import TOL, drawn

import periodic as per
from periodic.tracing import continuation

RANGE = (0.77, 0.8)
FOLDS = 0.7979576241, 0.7798095701


@pytest.fixture(scope="module")
def case() -> JointCase:
    """The model."""
    return drawn("joints", 160)


def folds(branch: per.Branch) -> list[float]:
    """Where a branch turns."""
    return [point.parameter for point in branch if point.label is per.Label.FOLD]


def read(*args: object, **options: object) -> None:
    """In place of what reads the word from a motion."""
    raise AssertionError("the word was read from a motion")


def test_three_events_change_places_at_once(monkeypatch: pytest.MonkeyPatch, case: JointCase) -> None:
    """Assert that a branch gets past such a meeting by the table alone, and back round two folds.

    Beside the first fold it is unstable. A motion from there settled on the sheet that had led to the fold,
    and the branch went back over itself.
    """
    monkeypatch.setattr(continuation, "reread", read)
    there = per.trace(case.system, "Omega", RANGE, start=RANGE[0], tol=TOL)
    assert there.stop.reason is per.Reason.BOUND
    assert there[-1].parameter == RANGE[1]
    assert folds(there) == pytest.approx(FOLDS, abs=2e-9)
    unstable = [k for k, point in enumerate(there) if np.abs(point.multipliers).max() > 1.05]
    for k in (0, *unstable[:: len(unstable) // 4], len(there) - 1):
        assert judged(case.exact, there[k], case.states).wrong(there[k], TOL) == ""


def test_the_branch_is_the_same_from_the_other_end(case: JointCase) -> None:
    """Assert the same folds from above."""
    back = per.trace(case.system, "Omega", RANGE, start=RANGE[1], tol=TOL)
    assert back[-1].parameter == RANGE[0]
    assert folds(back) == pytest.approx(FOLDS[::-1], abs=2e-9)


@pytest.mark.parametrize(
    ("seed", "bounds", "events"),
    [
        # both speeds pass 0, on one side the difference does so before and after, in both halves of a period
        (197, (0.685, 0.686), (24, 20)),
        # the difference ends held, reached from either side
        (104, (0.895, 0.9), (40, 38)),
        # one speed ends held, so that the difference and the other speed pass 0 as one
        (169, (0.498, 0.499), (21, 20)),
        # a difference ends held only up to there, of a slider and friction
        (169, (0.5141, 0.5146), (29, 29)),
        # sliders of the difference slip all along on one side, and are strained for a while on the other
        (104, (1.25, 1.253), (30, 27)),
        # the difference slips before it is torn off the other way, to either side of what it held together
        (197, (0.836, 0.8405), (24, 18)),
        (197, (0.846, 0.849), (18, 24)),
    ],
)
def test_round_an_intersection_on_either_side(
    seed: int, bounds: tuple[float, float], events: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that branches from both ends get past it, by the table alone, to the same orbits, judged."""
    monkeypatch.setattr(continuation, "reread", read)
    other = drawn("joints", seed)
    there, back = (
        per.trace(
            other.system, "Omega", bounds, start=start, tol=TOL, control=per.ArclengthControl(max_points=40)
        )
        for start in bounds
    )
    for branch, ways in ((there, bounds), (back, bounds[::-1])):
        assert [branch[0].parameter, branch[-1].parameter] == list(ways)
        for point in (branch[0], branch[-1]):
            assert judged(other.exact, point, other.states).wrong(point, TOL) == ""
    for one, same in ((there[0], back[-1]), (there[-1], back[0])):
        for name in one.maximum:
            assert one.maximum[name] == pytest.approx(same.maximum[name], rel=1e-6, abs=1e-6)
    assert [len(there[k].orbit.phases) for k in (0, -1)] == list(events)
