"""Roots between two places."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from periodic.linear.root import root


@pytest.mark.parametrize(
    ("function", "ends", "exact"),
    [
        (lambda x: x - 0.3, (0.0, 1.0), 0.3),
        (lambda x: math.exp(-50 * x) - 0.5, (0.0, 1.0), math.log(2) / 50),
        (lambda x: (x - 0.9) ** 9, (0.0, 1.0), 0.9),
        (lambda x: math.copysign(1.0, x - 0.2), (1.0, -1.0), 0.2),
        (lambda x: x * (1 - x), (0.0, 0.5), 0.0),
    ],
)
def test_root(function: Callable[[float], float], ends: tuple[float, float], exact: float) -> None:
    """Assert a root to its precision, of a line, a steep fall, a multiple root, a jump, and at an end."""
    places: list[float] = []

    def counted(x: float) -> float:
        places.append(x)
        return function(x)

    found = root(counted, *ends, 1e-10)
    assert found == pytest.approx(exact, abs=2e-10)
    assert found in places and min(ends) <= min(places) and max(places) <= max(ends)
    assert len(places) <= 60
