"""Fixed points of return maps: unstable ones, and beside kinks."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.tracing.returnmap import ReturnMap

Array = np.ndarray


def on(follow: object, tolerance: float = 1e-8, enough: float = 1e-8) -> ReturnMap:
    """A map whose period has two points."""
    return ReturnMap(lambda x: np.array([x, np.zeros(len(x)), follow(x)]), tolerance, enough)  # type: ignore[operator]


def test_an_unstable_fixed_point() -> None:
    """Assert that of the Henon map (1976), a = 1.4, b = 0.3, which iteration leaves."""

    def henon(x: Array) -> Array:
        return np.array([1 - 1.4 * x[0] ** 2 + x[1], 0.3 * x[0]])

    found = on(henon).fixed(np.array([0.5, 0.1]))
    exact = (-0.7 + np.sqrt(0.49 + 4 * 1.4)) / 2.8
    assert found is not None
    assert found == pytest.approx([exact, 0.3 * exact], abs=1e-6)


def test_a_fixed_point_beyond_a_kink() -> None:
    """Assert that of a map of two slopes, begun where its slope leads away."""

    def kinked(x: Array) -> Array:
        return np.array([np.where(x[0] < 0, 0.5 * x[0] + 1.0, -3.0 * x[0] + 1.0), 0.5 * x[1] + 1.0])

    found = on(kinked).fixed(np.array([-0.5, 0.0]))
    assert found is not None
    assert found == pytest.approx([0.25, 2.0], abs=1e-6)


def test_none_where_there_is_none() -> None:
    """Assert that a map without a fixed point gives none."""
    assert on(lambda x: x + 1 + x**2).fixed(np.array([0.3])) is None
