"""Friction between two masses that have joints of their own: stops that become one where it holds both.

The judge is `tests/reference/joints`, which follows the motion event by event.
"""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn.jointcases import JointCase, compiled
from support.drawn.joints import Attached, JointModel
from survey.rows import drawn, verdicts

import periodic as per
from periodic.system import STUCK

pytestmark = pytest.mark.drawn

RANGE = (1.18, 1.34)


def held_together(start: float) -> JointCase:
    """Two masses, friction between them, a slider to the ground at each."""
    joints = (
        Attached(kind="coulomb", i=0, to=1, limits=(0.2,)),
        Attached(kind="jenkins", i=0, to=None, stiffness=0.6, limits=(0.15,)),
        Attached(kind="jenkins", i=1, to=None, stiffness=0.5, limits=(0.1,)),
    )
    model = JointModel(
        seed=0,
        mass=np.eye(2),
        damping=0.05 * np.eye(2),
        stiffness=np.diag([1.0, 1.5]),
        places=(0, 1),
        links=((0, None, 1.0, 0.05), (1, None, 1.5, 0.05)),
        forced=0,
        attached=joints,
        bounds=RANGE,
    )
    return JointCase(compiled(model), model.record(), RANGE, start, model)


def joint_stops(point: per.Point) -> int:
    """At how many event nodes two sliders stop."""
    return sum(len([m for _, m in event.modes if m == STUCK]) > 1 for event in point.orbit.mesh.events)


@pytest.fixture(scope="module")
def both_ways() -> list[tuple[JointCase, per.Branch]]:
    """The branch from below and from above."""
    cases = [held_together(start) for start in RANGE]
    return [(case, per.trace(case.system, "Omega", RANGE, start=case.start)) for case in cases]


def test_stops_become_one_and_part(both_ways: list[tuple[JointCase, per.Branch]]) -> None:
    """Assert that both ways they are one from 1.222 to 1.297, and all is right there and elsewhere."""
    for case, branch in both_ways:
        assert branch.stop.reason is per.Reason.BOUND
        joined = [point.parameter for point in branch if joint_stops(point)]
        assert 1.221 < min(joined) < 1.225
        assert 1.293 < max(joined) < 1.299
        found = verdicts(case, branch, 1, 12)
        assert (found.wrong, found.unjudged, found.judged) == ([], [], 12)


def test_both_ways_alike(both_ways: list[tuple[JointCase, per.Branch]]) -> None:
    """Assert the same ends to 1e-6."""
    up, down = (branch for _, branch in both_ways)
    for one, other in ((up[0], down[-1]), (up[-1], down[0])):
        for name in ("q0", "q1"):
            assert one.peak_to_peak(name) == pytest.approx(other.peak_to_peak(name), abs=1e-6)


def test_first_orbit_with_stops_at_once() -> None:
    """Assert a first orbit of 45 events, two of them at once: read one after the other, Newton finds none."""
    case = drawn("joints", 100)
    begin = case.bounds[0]
    branch = per.trace(case.system, "Omega", (begin, begin + 1e-4), start=begin, tol=1e-6)
    assert branch.stop.reason is per.Reason.BOUND
    assert len(branch[0].orbit.mesh.events) == 45
    assert joint_stops(branch[0]) == 1
    found = verdicts(case, branch, 100, 2)
    assert (found.wrong, found.unjudged) == ([], [])


def test_a_joint_is_held_elsewhere_where_one_limit_is_reached_first() -> None:
    """Assert that a branch goes on with the joint amid its limits, to where it slips there and back."""
    case = drawn("joints", 105)
    bounds = (0.734, 0.741)
    branch = per.trace(case.system, "Omega", bounds, start=bounds[0], tol=1e-6)
    assert branch.stop.reason is per.Reason.BOUND
    found = verdicts(case, branch, 105, 6)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 6)


def test_a_held_joint_reaches_its_limit_where_friction_stops_the_motion() -> None:
    """Assert that a branch goes on with the joint off its limit, where events keep it from the middle."""
    case = drawn("joints", 166)
    bounds = (0.78, 0.88)
    branch = per.trace(case.system, "Omega", bounds, start=bounds[0], tol=1e-6)
    assert branch.stop.reason is per.Reason.BOUND
    found = verdicts(case, branch, 166, 6)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 6)
