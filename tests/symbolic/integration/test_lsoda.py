"""LSODA's work has an end: after so many evaluations, and after a signal that the rates have dropped."""

from __future__ import annotations

import signal
import warnings
from contextlib import suppress
from types import SimpleNamespace

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


def test_what_lsoda_says_beside_its_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that where LSODA fails an IntegrationError tells how far it came, and SciPy warns of nothing."""

    def failing(*given: object, **settings: object) -> SimpleNamespace:
        warnings.warn(
            "lsoda: Repeated convergence failures (perhaps bad Jacobian)", UserWarning, stacklevel=2
        )
        return SimpleNamespace(success=False, t=np.array([0.25, 0.5]), y=np.array([[1.0, np.nan]]))

    monkeypatch.setattr(lsoda.scipy.integrate, "solve_ivp", failing)
    with pytest.raises(IntegrationError, match="CVODES and LSODA both failed at tau = 0.25") as caught:
        lsoda.followed(fast, jacobian, np.ones(2), PHASE, 1e-8)
    assert caught.value.phase == 0.25
