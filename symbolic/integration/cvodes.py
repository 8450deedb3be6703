"""One call of CVODES, by which both flows integrate."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from typing import TypeVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from symbolic.arrays import Array
from symbolic.integration.interrupts import heard

STEPS = 20_000
"""Most steps from one phase of output to the next."""

KEPT = 64
"""How many integrators are kept; each is for certain phases."""


SPACED = 2e-9
"""Phases (rad) that are nearer to each other CasADi takes for one, and leaves the state where it is."""


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


Key = TypeVar("Key", bound=Hashable)


def kept(integrators: dict[Key, ca.Function], key: Key, make: Callable[[], ca.Function]) -> ca.Function:
    """Return the integrator of a key, made where there is none; the oldest goes for it."""
    if key not in integrators:
        while len(integrators) >= KEPT:
            integrators.pop(next(iter(integrators)))
        integrators[key] = make()
    return integrators[key]


def spaced(phase: Array) -> NDArray[np.int_]:
    """Return for each phase the index of the last one, at or before it, of those that are integrated to."""
    last, found = 0, []
    for k, tau in enumerate(phase):
        last = k if tau - phase[last] >= SPACED else last
        found.append(last)
    return np.array(found)
