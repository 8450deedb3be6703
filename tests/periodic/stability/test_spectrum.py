"""What is known of multipliers beside their values."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.stability.spectrum import Spectrum


@pytest.mark.parametrize("growth", [-0.6, 0.0, 0.4])
@pytest.mark.parametrize("rate", [0.3, 2.3])
def test_turns_of_a_pair_are_counted_through_the_period(rate: float, growth: float) -> None:
    """Assert the angle of exp((growth + i rate) tau) after a period, which its multiplier has lost."""
    tau = np.linspace(0.0, 2 * np.pi, 41)
    turn = np.array([[np.cos(rate * tau), -np.sin(rate * tau)], [np.sin(rate * tau), np.cos(rate * tau)]])
    (pair,) = Spectrum(np.moveaxis(np.exp(growth * tau) * turn, -1, 0), 0).pairs
    assert pair.turned == pytest.approx(2 * np.pi * rate, rel=1e-12)
