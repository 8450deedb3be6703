"""A law of load about its preload Q, dimensionless: W/Q as a function of s = delta/delta0, W(delta0) = Q.

Films work with logarithms: out of contact W falls by many orders of magnitude while ln W stays mild.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import casadi as ca
import scipy

from symbolic.equations.assembly import Assembly

LOWEST_LOG = -30.0
"""ln s below which a law is continued as the power of s that it is there."""

DEFLECTION_ITERATIONS = 8
"""Newton's steps to a deflection in logarithms, where laws are nearly straight lines; exact for a power."""

BRACKET = (-60.0, 20.0)
"""Logarithms of the deflections (m) between which that under the preload is sought."""


class Preloaded(Protocol):
    """What parts and films ask of a law about its preload; all in the dimensionless W/Q and s."""

    @property
    def delta0(self) -> ca.SX:
        """Deflection under the preload, in m."""

    @property
    def exponent(self) -> ca.SX:
        """Slope d ln W/d ln delta at the preload: the linear stiffness is exponent Q/delta0."""

    def load(self, s: ca.SX) -> ca.SX:
        """Return W/Q at a deflection of either sign."""

    def log_load(self, log_s: ca.SX) -> ca.SX:
        """Return ln(W/Q)."""

    def log_deflection(self, log_load: ca.SX) -> ca.SX:
        """Return ln s, the inverse of `log_load`."""


@dataclass(frozen=True)
class PowerLaw:
    """W/Q = s^n in closed form."""

    delta0: ca.SX
    exponent: ca.SX

    def load(self, s: ca.SX) -> ca.SX:
        """Return max(s, 0)^n."""
        # Not 0: the derivative of 0^n in n would be 0 log 0.
        return ca.fmax(s, 1e-300) ** self.exponent

    def log_load(self, log_s: ca.SX) -> ca.SX:
        """Return n ln s."""
        return self.exponent * log_s

    def log_deflection(self, log_load: ca.SX) -> ca.SX:
        """Return ln(W/Q)/n."""
        return log_load / self.exponent


@dataclass(frozen=True)
class SolvedLaw:
    """Any law W = force(delta) that rises with delta > 0; inverted by Newton's method written out."""

    force: Callable[[ca.SX], ca.SX]
    preload: ca.SX
    delta0: ca.SX
    assembly: Assembly

    @property
    def exponent(self) -> ca.SX:
        """d ln W/d ln delta at the preload."""
        return _slope(self._log_load, ca.SX(0))

    def load(self, s: ca.SX) -> ca.SX:
        """Return W/Q."""
        return self.force(self.delta0 * s) / self.preload

    def log_load(self, log_s: ca.SX) -> ca.SX:
        """Return ln(W/Q), continued as a power below LOWEST_LOG."""
        self.assembly.smooth_at(log_s - LOWEST_LOG)
        below = _slope(self._log_load, ca.SX(LOWEST_LOG)) * ca.fmin(log_s - LOWEST_LOG, 0)
        return self._log_load(ca.fmax(log_s, LOWEST_LOG)) + below

    def log_deflection(self, log_load: ca.SX) -> ca.SX:
        """Return ln s by Newton's method from the power law that touches at the preload."""
        return _inverse(self.log_load, log_load, log_load / self.exponent)

    def _log_load(self, log_s: ca.SX) -> ca.SX:
        return ca.log(self.load(ca.exp(log_s)))


def solved(force: Callable[[ca.SX], ca.SX], assembly: Assembly, preload: ca.SX) -> SolvedLaw:
    """Return a law about its preload; delta0 is not a number where the law does not carry the preload."""

    def log_force(log_delta: ca.SX) -> ca.SX:
        return ca.log(force(ca.exp(log_delta)))

    def excess(log_delta: float) -> float:
        return assembly.nominal(log_force(ca.SX(log_delta)) - ca.log(preload))

    bracketed = excess(BRACKET[0]) < 0 < excess(BRACKET[1])
    nominal = scipy.optimize.brentq(excess, *BRACKET) if bracketed else math.nan
    return SolvedLaw(force, preload, ca.exp(_inverse(log_force, ca.log(preload), ca.SX(nominal))), assembly)


def _inverse(function: Callable[[ca.SX], ca.SX], value: ca.SX, guess: ca.SX) -> ca.SX:
    """Where a rising function has the value."""
    for _ in range(DEFLECTION_ITERATIONS):
        guess = guess - (function(guess) - value) / _slope(function, guess)
    return guess


def _slope(function: Callable[[ca.SX], ca.SX], at: ca.SX) -> ca.SX:
    y = ca.SX.sym("y")
    return ca.substitute(ca.jacobian(function(y), y), y, at)
