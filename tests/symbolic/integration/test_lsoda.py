"""LSODA's work has an end: after so many evaluations, and after a signal that the rates have dropped."""

from __future__ import annotations

import signal
from contextlib import suppress

import numpy as np
import pytest

from symbolic.arrays import Array
from symbolic.integration import lsoda
from symbolic.integration.cvodes import IntegrationError

PHASE = np.array([0.0, 2 * np.pi])


def fast(tau: float, y: Array) -> Array:
    """y'' + 1e6 y = 0 as rates."""
    return np.array([y[1], -1e6 * y[0]])


def jacobian(tau: float, y: Array) -> Array:
    """Its Jacobian."""
    return np.array([[0.0, 1.0], [-1e6, 0.0]])


def test_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the integration ends after its share of evaluations, and says how far it came."""
    monkeypatch.setattr(lsoda, "EVALUATIONS", 500)
    with pytest.raises(IntegrationError, match="failed at tau = 0.0") as caught:
        lsoda.followed(fast, jacobian, np.ones(2), PHASE, 1e-8)
    assert 0 < caught.value.phase < 0.1


def test_signal_that_the_rates_drop() -> None:
    """Assert that Ctrl-C ends the integration though the rates swallow what it raises, as CasADi may."""
    calls = []

    def rates(tau: float, y: Array) -> Array:
        calls.append(tau)
        if len(calls) == 20:
            with suppress(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
        return fast(tau, y)

    with pytest.raises(KeyboardInterrupt):
        lsoda.followed(rates, jacobian, np.ones(2), PHASE, 1e-8)
    assert len(calls) == 20


def test_what_lsoda_says_beside_its_outcome() -> None:
    """Assert that rates of a motion that ends, y' = y^2, are an IntegrationError and no warning of SciPy's."""
    with pytest.raises(IntegrationError, match="CVODES and LSODA both failed at tau = ") as caught:
        lsoda.followed(lambda tau, y: y**2, lambda tau, y: np.diag(2 * y), np.ones(1), PHASE, 1e-8)
    assert caught.value.phase < 1.0
