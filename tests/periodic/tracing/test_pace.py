"""In how many periods a motion settles: of distances that are known."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.tracing.pace import LAST, periods_left


@pytest.mark.parametrize(("part", "wanted", "left"), [(0.5, 2.0**-7, 4.0), (0.1, 1e-5, 2.0), (0.5, 1.0, 0.0)])
def test_distances_that_shrink_evenly(part: float, wanted: float, left: float) -> None:
    """Assert the periods from 1, q, q^2, q^3 to the wanted distance; none where it is reached."""
    assert periods_left(part ** np.arange(4.0), wanted) == pytest.approx(left, abs=1e-9)


def test_distances_that_do_not_shrink() -> None:
    """Assert that a motion never settles whose distances grow, or stay."""
    assert periods_left([1e-3, 2e-3], 1e-5) == np.inf
    assert periods_left([1e-3, 1e-3], 1e-5) > 1e9
    assert periods_left([0.0, 1e-3], 1e-5) == np.inf


def test_a_beat_is_seen_through() -> None:
    """Assert 20 periods of 2^-k with a beat of five periods on it, whose last distances rise."""
    beat = 2.0 ** -np.arange(10.0) * np.tile([1.0, 0.25, 0.125, 0.25, 1.0], 2)
    assert beat[-1] > beat[-2]
    assert periods_left(beat, 2.0**-29) == pytest.approx(20, abs=3)


def test_the_last_periods_count() -> None:
    """Assert that what was before the last ones is forgotten."""
    late = 0.5 ** np.arange(float(LAST))
    assert periods_left([1e-6, *late], 1e-6) == pytest.approx(periods_left(late, 1e-6))
