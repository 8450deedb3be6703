"""Single steps of the method of Dormand and Prince of order 8, one from each phase to the next.

Where phases lie so near to each other that one step leads from each to the next, this is faster than an
integrator that starts anew with small steps. Where the error that the method estimates (Hairer, Norsett &
Wanner 1993, II.10) is too large, nothing is returned.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np
from scipy.integrate import DOP853

from symbolic.arrays import Array
from symbolic.integration.buffered import Buffered

PART = 0.1
"""Part of the tolerance that the error of a step may be: those of many steps add up."""

MOST = 32
"""Most steps in a row: CVODES begins with as many small ones, and is faster after them. Between 8 and 32 the
times of models with joints differ by no more than a tenth."""

WEIGHTS = DOP853.B, DOP853.E5, DOP853.E3
"""Weights of the stages in a step, and in the differences of methods of orders 5 and 3 from it."""


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps of an ODE y' = f(y, tau, p): y (w,), given p; f a function of the three."""

    rates: ca.Function

    def run(self, start: Array, phase: Array, given: Array, tolerance: float) -> Array | None:
        """Return y at all phases (K,), which rise, shape (K, w); None where they are many, or far apart."""
        if len(phase) > MOST + 1:
            return None
        step = self._step
        (y, at, p), (later, error) = step.given, step.results
        found = np.empty((len(phase), len(start)))
        y[:], p[:], found[0] = start, given, start
        for k, width in enumerate(phase[1:] - phase[:-1]):
            at[:] = phase[k], width, tolerance
            step()
            if not error[0] <= PART:  # or not a number
                return None
            y[:] = found[k + 1] = later
        return found

    @cached_property
    def _step(self) -> Buffered:
        """Function of y, (tau, width, tolerance), p: y after a step, and its error."""
        y, p, at = self.rates.sx_in(0), self.rates.sx_in(2), ca.SX.sym("at", 3)
        stages: list[ca.SX] = []
        for row, c in zip(DOP853.A, DOP853.C[: DOP853.n_stages], strict=False):
            inner = sum((at[1] * a * k for a, k in zip(row, stages, strict=False) if a), y)
            stages.append(self.rates(inner, at[0] + c * at[1], p))
        parts = [sum(at[1] * b * k for b, k in zip(w, stages, strict=False) if b) for w in WEIGHTS]
        later = ca.densify(y + parts[0])
        scale = at[2] * (1 + ca.fmax(ca.fabs(y), ca.fabs(later)))
        error = _error(parts[1] / scale, parts[2] / scale)
        return Buffered(ca.Function("step", [y, at, p], ca.cse([later, ca.densify(error)])))


def _error(fifth: ca.SX, third: ca.SX) -> ca.SX:
    """The error of a step, of differences relative to the tolerance; NaN where there is none."""
    own = ca.sumsqr(fifth)
    both = own + 0.01 * ca.sumsqr(third)
    return ca.if_else(both == 0, own, own / ca.sqrt(both * fifth.numel()))
