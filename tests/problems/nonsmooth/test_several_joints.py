"""Several joints that stick on coupled masses: through their range from both ends, judged event by event.

Models are those of the survey (`tests/support/drawn/joints.py`), the judge is `tests/reference/joints`.
"""

from __future__ import annotations

import numpy as np
import pytest
from reference.joints.judging import judged
from survey.rows import TOL, drawn, traced, verdicts

import periodic as per
import symbolic as sym

pytestmark = pytest.mark.drawn


@pytest.mark.parametrize("seed", [128])
def test_random_models(seed: int) -> None:
    """Assert that they get through from below, and that no point is wrong: orbits and multipliers."""
    case = drawn("joints", seed)
    branch = traced(case)
    assert branch.stop.reason is per.Reason.BOUND
    found = verdicts(case, branch, seed, 4)
    assert (found.wrong, found.unjudged) == ([], [])


def test_a_stop_breaks_while_two_masses_rest() -> None:
    """Assert the fold with which a slip begins there, the same from both sides, and that no point is wrong.

    The mass q3 rests on q2, which rests as well, so that the force between them stays as it is until q2 is
    torn off. Beyond the force's limit q3 passes on, and stops again after that. Where the slider between q0
    and q2 rests is not determined, as it never slips, and the fold depends on that: two machines whose
    settled motions differ found it at .43437562 and .43438057. Either way along one branch it is the same.
    """
    case = drawn("joints", 148)
    problem, few = per.Problem(case.system, "Omega", (0.4335, 0.4355)), per.ArclengthControl(max_points=16)
    there = per.trace(case.system, "Omega", problem.bounds, start=0.4335, tol=TOL, control=few)
    back = list(per.continuation(problem, there[-1].orbit, sign=1, tol=TOL, control=few))
    folds = [[point for point in points if point.label is per.Label.FOLD] for points in (there, back)]
    assert [len(each) for each in folds] == [1, 1]
    assert folds[0][0].parameter == pytest.approx(folds[1][0].parameter, abs=5e-9)
    for points, (fold,), begin, end in ((there, folds[0], 46, 47), (back, folds[1], 47, 46)):
        assert fold.parameter == pytest.approx(0.434378, abs=5e-6)
        assert [len(points[k].orbit.mesh.events) for k in (0, -1)] == [begin, end]
        assert max(point.parameter for point in points) - fold.parameter < 5e-9
        for k in (0, len(points) - 1):
            assert judged(case.exact, points[k], case.states).wrong(points[k], TOL) == ""


def two_joints() -> sym.CompiledSystem:
    """Two masses, each on friction to the ground, the force on the first."""
    x, y = (sym.coordinate(name, unit="m") for name in "xy")
    model = (
        sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.Spring(x, 1.0) + sym.Spring(y, 1.5) + sym.Damper(x, 0.05)
    )
    model = model + sym.Damper(y, 0.05) + sym.Spring(x, 0.8, to=y) + sym.HarmonicForce(x, 1.0)
    return sym.compile(model + sym.CoulombFriction(x, 0.2) + sym.CoulombFriction(y, 0.3))


@pytest.fixture(scope="module")
def both_ways() -> list[per.Branch]:
    """The branch of two joints from below and from above."""
    system = two_joints()
    return [per.trace(system, "Omega", (0.5, 2.2), start=start) for start in (0.5, 2.2)]


def test_both_ways_alike(both_ways: list[per.Branch]) -> None:
    """Assert that both come to their ends, past the same grazings, and are the same there to 1e-6."""
    up, down = both_ways
    assert up.stop.reason is down.stop.reason is per.Reason.BOUND
    there, back = (sorted({round(p.parameter, 5) for p in b.labelled(per.Label.GRAZING)}) for b in both_ways)
    assert len(there) == 1  # the second joint slips no more above
    assert there == pytest.approx(back, abs=2e-5)
    ends = [(b[0], b[-1]) for b in both_ways]
    for one, other in ((ends[0][0], ends[1][1]), (ends[0][1], ends[1][0])):
        for name in "xy":
            assert one.peak_to_peak(name) == pytest.approx(other.peak_to_peak(name), abs=1e-6)


def test_what_is_held_all_along_is_followed(both_ways: list[per.Branch]) -> None:
    """Assert that the mass of a joint that never slips rests."""
    held = [p for branch in both_ways for p in branch if p.orbit.mesh.modes and not slips(p, "y")]
    assert held
    for point in held:
        tau = point.orbit.grid.left / point.parameter
        assert np.ptp(point.orbit["y"](tau)) < 1e-9


def slips(point: per.Point, name: str) -> bool:
    """Whether a coordinate moves."""
    return point.peak_to_peak(name) > 1e-6
