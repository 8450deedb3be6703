"""One call of CVODES, by which both flows integrate."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.integration.interrupts import heard

STEPS = 20_000
"""Most steps from one phase of output to the next."""


class IntegrationError(ArithmeticError):
    """The integrator gave up; the message says where, `phase` (tau) where that is known."""

    def __init__(self, message: str, phase: float = math.nan) -> None:
        super().__init__(message)
        self.phase = phase


def integrator(problem: dict[str, ca.SX], phase: tuple[float, ...], tolerance: float) -> ca.Function:
    """Return CVODES for an ODE from phase[0] to each of the later phases."""
    options = {
        "reltol": tolerance,
        "abstol": tolerance,
        "max_num_steps": STEPS,
        "disable_internal_warnings": True,
        "show_eval_warnings": False,
    }
    return ca.integrator("flow", "cvodes", problem, phase[0], list(phase[1:]), options)


def integrated(integrator: ca.Function, start: Array, parameter: Array) -> Array | None:
    """Return the solution at the later phases, a column each, or None where CVODES fails."""
    try:
        with heard():
            return np.array(integrator(x0=start, p=parameter)["xf"])
    except RuntimeError:  # what CasADi raises for every failure of CVODES
        return None
