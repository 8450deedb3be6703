"""How rejected steps are shortened."""

from __future__ import annotations

import pytest

from periodic.tracing.steps.taken import shortened


def test_failures_in_a_row_shorten_by_more() -> None:
    """Assert that ten decades take as few trials as their number's root, not as many as they are."""
    ds, trials = 0.1, 0
    while ds > 1e-11:
        trials += 1
        ds = shortened(ds, 0.6, trials, 1e-12)
    assert trials == 10 and ds == pytest.approx(0.1 * 0.6**55)


@pytest.mark.parametrize(("shorter", "failed"), [(0.6, 0), (0.6, 1), (0.25, 0)])
def test_measured_rejections_shorten_as_measured(shorter: float, failed: int) -> None:
    """Assert that a rejection with a measure, and the first failure, shorten as they say."""
    assert shortened(0.02, shorter, failed, 1e-7) == 0.02 * shorter


def test_the_least_step_is_tried() -> None:
    """Assert that no power leads past the least step before that is tried."""
    assert shortened(1e-6, 0.6, 5, 3e-7) == 3e-7
    assert shortened(4e-7, 0.6, 5, 3e-7) < 3e-7
