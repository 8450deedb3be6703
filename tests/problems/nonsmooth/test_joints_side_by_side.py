"""Joints side by side: sliders let go together or by themselves, friction beside them; judged event by event.

Models are those of the survey in parts of their ranges, the judge is `tests/reference/joints`.
"""

from __future__ import annotations

from dataclasses import replace

from survey.rows import drawn, traced, verdicts

import periodic as per


def part(kind: str, seed: int, low: float, high: float) -> per.Branch:
    """The branch of a model in a part of its range, of which it has reached the end, no point wrong."""
    case = replace(drawn(kind, seed), bounds=(low, high), start=low)
    branch = traced(case)
    assert branch.stop.reason is per.Reason.BOUND, str(branch.stop)
    found = verdicts(case, branch, seed, 5)
    assert (found.wrong, found.unjudged) == ([], [])
    assert found.judged == 5
    return branch


def test_a_slider_that_slips_by_itself_is_let_go_by_itself() -> None:
    """Assert that of two sliders held together one slips where it grazes its limit, and then parts.

    The grazing is labelled: multipliers jump there.
    """
    branch = part("joints", 150, 0.644, 0.66)
    assert branch.labelled(per.Label.GRAZING)


def test_friction_takes_a_slider_at_its_limit_along() -> None:
    """Assert a branch past where a mass on friction and a slider begins to stop on its way, and goes on."""
    branch = part("joints", 109, 0.469, 0.482)
    assert branch.labelled(per.Label.GRAZING)


def test_a_slider_leaves_its_limit_beside_friction() -> None:
    """Assert that steps are not shortened where friction lets a slider go from its limit, nor by swaps.

    Before, orbits beyond a swap were refused as too far, and the slider was taken to slip: 658 iterations.
    """
    branch = part("joints", 127, 0.43017261653623867, 0.6)
    assert branch.newton_iterations < 200
