"""Joints side by side: sliders let go together or by themselves, friction beside them; judged event by event.

Models are those of the survey from somewhere in their ranges, the judge is `tests/reference/joints`.
"""

from __future__ import annotations

from survey.rows import TOL, drawn, verdicts

import periodic as per


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
