"""Time steps of the modes of a linear part: the exact response of one mode to a constant force."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.condensed.timestepping import Holding, Step


@pytest.mark.parametrize("exponent", [0.0, -2.0, complex(-0.1, 3.0)])
def test_step_of_a_mode(exponent: complex) -> None:
    """Assert z' = lambda z + b f over a step h: exp(lambda h), b (exp(lambda h) - 1) / lambda."""
    modes: Any = SimpleNamespace(
        exponents=np.array([exponent], dtype=complex),
        inputs=np.array([[2.0 + 0j, 1j]]),
        outputs=np.array([[3.0 + 0j]]),
        direct=np.array([[0.5, 0.25]]),
    )
    h = 0.25
    found = Step.over(h, modes)
    grown = np.exp(exponent * h)
    mean = h if exponent == 0 else (grown - 1) / exponent
    assert found.grown == pytest.approx([grown], rel=1e-14)
    assert found.kicked == pytest.approx(np.array([[2 * mean, 1j * mean]]), rel=1e-13)
    assert found.local == pytest.approx(
        np.array([[(6 * mean).real + 0.5, (3j * mean).real + 0.25]]), rel=1e-13
    )
    assert found.width == h


@pytest.mark.parametrize(
    ("before", "now", "gives"),
    [(0.5, 0.7, False), (0.5, 0.9, True), (-0.5, -0.9, True), (0.9, 0.95, False), (np.nan, 0.9, False)],
)
def test_holding_force_that_gives_way(before: float, now: float, gives: bool) -> None:
    """Assert it where the mean 0.9, after 0.5 in a step as long, is 1.1 at the end: past its limit."""
    assert Holding(1.0, np.array([now])).gives_way(Holding(1.0, np.array([before]))) is gives


def test_holding_over_steps_of_two_lengths() -> None:
    """Assert that the rate is that between the middles of the steps: (0.9 - 0.5) / 2 each half of 1 + 3."""
    now, before = Holding(1.0, np.array([0.9])), Holding(3.0, np.array([0.5]))
    assert not now.gives_way(before)  # 0.9 + 0.4 / 4 = 1.0
    assert Holding(1.0, np.array([0.91])).gives_way(before)
