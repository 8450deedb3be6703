"""Joints side by side: sliders let go together or by themselves, friction beside them; judged event by event.

Models are those of the survey from somewhere in their ranges, the judge is `tests/reference/joints`.
"""

from __future__ import annotations

import numpy as np
import pytest
from howto.test_joint import Belt
from survey.rows import TOL, drawn, verdicts

import periodic as per
import symbolic as sym

pytestmark = pytest.mark.drawn


def some(seed: int, start: float | None, points: int, beyond: float) -> per.Branch:
    """So many steps of the branch of a model from somewhere: they lead beyond a value, no point wrong."""
    case, few = drawn("joints", seed), per.ArclengthControl(max_points=points)
    bounds = (case.bounds[0] if start is None else start, case.bounds[1])
    branch = per.trace(case.system, "Omega", bounds, start=bounds[0], tol=TOL, control=few)
    assert branch[-1].parameter > beyond, str(branch.stop)
    found = verdicts(case, branch, seed, 6)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 6)
    return branch


def test_a_slider_that_slips_by_itself_is_let_go_by_itself() -> None:
    """Assert that of two sliders held together one slips where it grazes its limit, and then parts.

    The grazing is labelled: multipliers jump there.
    """
    branch = some(150, 0.644, 8, 0.65)
    assert branch.labelled(per.Label.GRAZING)


def test_friction_takes_a_slider_at_its_limit_along() -> None:
    """Assert a branch past where a mass on friction and a slider begins to stop on its way, and goes on."""
    branch = some(109, 0.469, 12, 0.476)
    assert branch.labelled(per.Label.GRAZING)


def test_a_slider_leaves_its_limit_beside_friction() -> None:
    """Assert a whole range in few iterations: the slider is not taken to slip, nor swaps to be too far off.

    Before, it took 658.
    """
    branch = some(127, None, 400, 1.25)
    assert branch.stop.reason is per.Reason.BOUND
    assert branch.newton_iterations < 300


def test_a_slider_slips_while_its_mass_is_held_on_a_belt() -> None:
    """Assert that it is at its limit, to 1e-8, where friction holds a mass that moves with a belt."""
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.1) + sym.HarmonicForce(x, 0.5)
    system = sym.compile(model + Belt(x, 0.6, 0.2) + sym.Jenkins(x, 0.5, 0.05))
    motion = sym.simulate(system, {"Omega": 0.7}, settle=3, samples=400, tolerance=1e-9)
    force = 0.5 * (motion["x"] - motion["z of x"])
    assert np.abs(force).max() < 0.05 + 1e-8
    with_belt = np.abs(motion["x'"] - 0.2) < 1e-9
    assert (force[with_belt] > 0.05 - 1e-8).sum() > 20


def test_sliders_held_at_one_turn_reach_their_limits_as_one() -> None:
    """Assert a branch past where three sliders between masses slip where the strain is back at its turn.

    Before, the search for the way on raised StopIteration.
    """
    case = drawn("joints down", 156)
    branch = per.trace(case.system, "Omega", (0.64, 0.655), start=0.655, tol=TOL)
    assert branch.stop.reason is per.Reason.BOUND
    assert len(branch.labelled(per.Label.GRAZING)) == 3
    found = verdicts(case, branch, 156, 4)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 4)


def test_a_stop_is_grazed_where_a_slider_turns() -> None:
    """Assert that a mass that meets a stop as its slider's strain turns takes the same branch both ways.

    The slider is strained then, and does not hold the mass. Before, the period doubling beside the grazing
    was put at .85511 from below.
    """
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.06) + sym.HarmonicForce(x, 1.0)
    system = sym.compile(model + sym.Jenkins(x, 0.5, 0.3) + sym.OneSidedSpring(x, 20.0, 2.5))
    up, down = (per.trace(system, "Omega", (0.5, 1.6), start=start, tol=TOL) for start in (0.5, 1.6))
    assert up.stop.reason is down.stop.reason is per.Reason.BOUND
    for label, count in ((per.Label.GRAZING, 2), (per.Label.DOUBLING, 2), (per.Label.FOLD, 2)):
        there, back = (sorted(p.parameter for p in branch.labelled(label)) for branch in (up, down))
        assert len(there) == count
        assert there == pytest.approx(back, abs=1e-5)
    grazing = min(up.labelled(per.Label.GRAZING), key=lambda p: p.parameter)
    times = np.linspace(0, grazing.orbit.period, 20001)
    assert grazing.orbit["x"](times).max() == pytest.approx(2.5, abs=1e-6)


@pytest.mark.long
def test_a_slip_begins_before_a_stop_at_which_its_force_jumps() -> None:
    """Assert that friction that holds is let go just before another stop, and held again just after it.

    The force on it is largest there and jumps, so that nothing is grazed smoothly. Before, the steps shrank
    to nothing, and the motion had to be read: 609 iterations for 124.
    """
    case = drawn("joints", 148)
    branch = per.trace(case.system, "Omega", (0.4192, 0.4225), start=0.4192, tol=TOL)
    assert branch.stop.reason is per.Reason.BOUND
    assert branch.newton_iterations < 200
    counts = [len(point.orbit.phases) for point in branch]
    assert (counts[0], counts[-1]) == (46, 48)
    found = verdicts(case, branch, 148, 2)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 2)


@pytest.mark.parametrize("start", [0.654, 0.657])
def test_a_slider_has_left_its_limit_as_long_as_friction_says_so(start: float) -> None:
    """Assert a branch past where a mass slips ever more briefly from where its slider stopped, both ways.

    Linear prediction puts the slider back at its limit before the slip ends. Before, the branch ended there
    from above: no orbit was found beyond.
    """
    case = drawn("joints down", 147)
    branch = per.trace(case.system, "Omega", (0.654, 0.657), start=start, tol=TOL)
    assert branch.stop.reason is per.Reason.BOUND
    assert {24, 25, 26} <= {len(point.orbit.phases) for point in branch}
    found = verdicts(case, branch, 147, 6)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 6)


@pytest.mark.parametrize(("seed", "below"), [(124, 0.61), (184, 0.67)])
def test_a_guess_far_off_grazes_no_level_that_its_base_does_not(seed: int, below: float) -> None:
    """Assert that a speed without an extremum after its slip is not taken to graze there at once.

    The tangent of the first step has an extremum on the other side of the level. Before, the first orbit was
    said to graze, no orbit was found beyond, and the branch ended where it began.
    """
    case = drawn("joints down", seed)
    few = per.ArclengthControl(max_points=10)
    branch = per.trace(case.system, "Omega", case.bounds, start=case.start, tol=TOL, control=few)
    assert branch[-1].parameter < below, str(branch.stop)
    assert not branch.labelled(per.Label.GRAZING)
    found = verdicts(case, branch, seed, 3)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 3)


@pytest.mark.long
@pytest.mark.parametrize("start", [4.2236, 4.2243])
def test_a_slip_begins_shortly_after_a_stop_at_both_places_of_a_symmetric_orbit(start: float) -> None:
    """Assert that slips begin at once 0.005 rad after stops, both ways: no orbit is without symmetry.

    Before, an extremum so near an event node of its surface was taken for rounding.
    """
    case = drawn("joints down", 162)
    branch = per.trace(case.system, "Omega", (4.2236, 4.2243), start=start, tol=TOL)
    assert branch.stop.reason is per.Reason.BOUND
    assert {len(point.orbit.phases) for point in branch} == {16, 20}
    found = verdicts(case, branch, 162, 4)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 4)


@pytest.mark.long
def test_a_slip_that_begins_slowly_grazes_nothing() -> None:
    """Assert a step from an orbit whose slips begin slowly, where rounding makes an extremum beside them.

    Before, the branch ended where it began: the extremum was taken for grazing.
    """
    case, few = drawn("joints down", 162), per.ArclengthControl(max_points=4)
    branch = per.trace(case.system, "Omega", (4.0, case.start), start=case.start, tol=TOL, control=few)
    assert branch.stop.reason is per.Reason.MAX_POINTS
    found = verdicts(case, branch, 162, 4)
    assert (found.wrong, found.unjudged, found.judged) == ([], [], 4)
