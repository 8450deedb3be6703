"""One call of LSODA or Radau with bounded work, for motions on which CVODES gives up or is slow."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from symbolic.arrays import Array
from symbolic.integration.cvodes import IntegrationError
from symbolic.interrupts import interruptible

EVALUATIONS = 100_000
"""Most evaluations of the rates in each period of the excitation, 2 pi in tau."""

Rates = Callable[[float, Array], Array]
"""(tau, y) to y', or to its Jacobian."""


@dataclass
class Counted:
    """Rates that are evaluated `most` times, and not again after a signal, whose exception CasADi drops."""

    rates: Rates
    most: float
    raised: list[BaseException]
    count: int = 0

    def __call__(self, tau: float, y: Array) -> Array:
        if self.raised:
            raise self.raised[0]
        self.count += 1
        if self.count > self.most:
            raise failure(tau)
        return self.rates(tau, y)


def failure(phase: float) -> IntegrationError:
    """Return the error of an integration that got as far as a phase."""
    return IntegrationError(f"CVODES and LSODA both failed at tau = {phase:.6g}", phase)


def followed(
    rates: Rates,
    jacobian: Rates,
    start: Array,
    phase: Array,
    tolerance: float,
    method: Literal["LSODA", "Radau"] = "LSODA",
) -> Array:
    """Return the solution at the later phases, a row each, by LSODA or Radau. Raises IntegrationError."""
    if not np.isfinite(rates(phase[0], start)).all():
        raise failure(phase[0])
    with interruptible() as raised, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "lsoda: ", UserWarning)  # it says the same by `success`
        found = scipy.integrate.solve_ivp(
            Counted(rates, EVALUATIONS * math.ceil((phase[-1] - phase[0]) / (2 * math.pi)), raised),
            (phase[0], phase[-1]),
            start,
            method=method,
            t_eval=phase[1:],
            rtol=tolerance,
            atol=tolerance,
            jac=jacobian,
        )
    if not found.success or not np.isfinite(found.y).all():
        good = [tau for tau, y in zip(found.t, np.transpose(found.y), strict=True) if np.isfinite(y).all()]
        raise failure(max(good, default=phase[0]))
    return found.y.T
