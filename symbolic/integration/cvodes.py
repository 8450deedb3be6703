"""CVODES for ordinary differential equations, along any phases."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.interrupts import interruptible

STEPS = 20_000
"""Most steps from one phase of output to the next."""

KEPT = 128
"""How many integrators are kept; each is for certain parts of an interval."""

LENGTH = 1e6
"""Length to which every interval is scaled: CasADi takes times nearer than 1e-9 for the same time."""

ROUNDING = 4.0
"""By how many units in its last place a phase is rounded, so that like parts of intervals are the same."""


class IntegrationError(ArithmeticError):
    """The integrator gave up; the message says where, `phase` (tau) where that is known."""

    def __init__(self, message: str, phase: float = math.nan) -> None:
        super().__init__(message)
        self.phase = phase


@dataclass(frozen=True, eq=False)
class Cvodes:
    """Integrates an ODE y' = f(y, tau, p).

    Parameters
    ----------
    problem : dict of str to casadi.SX
        x = y, t = tau, p, and ode = f.
    """

    problem: dict[str, ca.SX]
    _integrators: dict[tuple[float, ...], ca.Function] = field(default_factory=dict, init=False, repr=False)

    def run(self, start: Array, phase: Array, parameter: Array, tolerance: float) -> Array | None:
        """Return y at all phases (K,), which rise, shape (K, w); None where CVODES fails.

        tolerance: relative and absolute.
        """
        begin, width = phase[0], phase[-1] - phase[0]
        parts, place = np.unique(_rounded(phase), return_inverse=True)
        if len(parts) == 1:
            return np.repeat(start[None], len(phase), axis=0)
        given = np.concatenate([parameter, [begin, width / LENGTH]])
        try:
            with interruptible():
                later = self._integrator(tuple(parts), tolerance)(x0=start, p=given)["xf"]
        except RuntimeError:  # what CasADi raises for every failure of CVODES
            return None
        found = np.concatenate([start[None], np.array(later).T])
        return found[place] if np.isfinite(found).all() else None

    def _integrator(self, parts: tuple[float, ...], tolerance: float) -> ca.Function:
        """CVODES from the first of some parts of an interval to the others, from a cache."""
        key = (*parts, tolerance)
        if key not in self._integrators:
            while len(self._integrators) >= KEPT:
                self._integrators.pop(next(iter(self._integrators)))
            options = {
                "reltol": tolerance,
                "abstol": tolerance,
                "max_num_steps": STEPS,
                "disable_internal_warnings": True,
                "show_eval_warnings": False,
            }
            times = [LENGTH * part for part in parts]
            made = ca.integrator("flow", "cvodes", self._stretched, times[0], times[1:], options)
            self._integrators[key] = made
        return self._integrators[key]

    @cached_property
    def _stretched(self) -> dict[str, ca.SX]:
        """The problem with its interval, (begin, width / LENGTH), as parameters."""
        interval, own = ca.SX.sym("interval", 2), self.problem
        ode = ca.substitute(own["ode"], own["t"], interval[0] + interval[1] * own["t"])
        return own | {"p": ca.vertcat(own["p"], interval), "ode": interval[1] * ode}


def _rounded(phase: Array) -> Array:
    """Phases as parts of their interval, rounded to the decimals that are significant."""
    width = phase[-1] - phase[0]
    if not width:
        return np.zeros(len(phase))
    unit = ROUNDING * np.spacing(np.abs(phase).max()) / width
    return np.round((phase - phase[0]) / width, max(0, math.floor(-math.log10(unit))))
