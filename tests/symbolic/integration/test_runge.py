"""Single steps of order 8: exact for their order, and nothing where a step is too long."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from symbolic.integration.runge import MOST, Steps


def steps(power: int) -> Steps:
    """Steps of y' = p y^power."""
    y, tau, p = ca.SX.sym("y"), ca.SX.sym("tau"), ca.SX.sym("p")
    return Steps(ca.Function("rates", [y, tau, p], [p * y**power]))


def test_growth() -> None:
    """Assert exp(t) at each of five phases to the tolerance, and nothing for more phases than MOST + 1."""
    phase = np.linspace(0.0, 0.4, 5)
    found = steps(1).run(np.ones(1), phase, np.ones(1), 1e-10)
    assert found is not None and found[:, 0] == pytest.approx(np.exp(phase), rel=1e-10)
    assert steps(1).run(np.ones(1), np.linspace(0.0, 1e-3, MOST + 2), np.ones(1), 1e-10) is None


@pytest.mark.parametrize("rate", [30.0, 1e27, 1e200])
def test_steps_that_are_too_long(rate: float) -> None:
    """Assert that nothing is returned, without a warning, where errors are large or beyond all numbers."""
    assert steps(1).run(np.ones(1), np.array([0.0, 1.0]), np.array([rate]), 1e-10) is None
