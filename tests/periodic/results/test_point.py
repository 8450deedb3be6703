"""What a point says of its orbit, from its numbers."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.results.point import _distance


@pytest.mark.parametrize(
    ("multipliers", "count", "distance"),
    [
        ([1 + 1e-3j, 1 - 1e-3j, 0.5, 3.0], 2, 1e-6),
        ([1.02, 0.5, 0.99, 1.1], 2, 1.02 * 0.99 - 1),
        ([0.3, 1.01, -1.0], 1, 0.01),
        ([1.2, 0.9, 2.0], 2, 0.08),
        ([1.0, 1.0], 0, None),
    ],
)
def test_distance_of_the_trivial_multipliers(
    multipliers: list[complex], count: int, distance: float | None
) -> None:
    """Assert how far the mean and the product of those nearest 1 are from it, the farther of the two."""
    found = _distance(np.array(multipliers, dtype=complex), count)
    assert found == (None if distance is None else pytest.approx(distance, rel=1e-9))
