"""Time integration through impacts: pieces from one zero of a switch to the next, the state mapped there."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
import scipy

from symbolic.arrays import Array
from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.interrupts import heard
from symbolic.integration.lsoda import Rates

MOST = 1000
"""Most impacts in a period of the excitation, 2 pi in tau: after more they pile up in a point."""

STEP = 0.05
"""Longest step in tau, so that no impact is passed over."""

Switch = Callable[[float, Array], float]
Reset = Callable[[float, Array], Array]


def bouncing(
    rates: Rates, impacts: Mapping[Switch, Reset], start: Array, phase: Array, tolerance: float
) -> tuple[Array, Array]:
    """Return phases and states, a row each: those asked for, and every impact twice, before and after it.

    Each switch is positive but at its impacts. Raises IntegrationError.
    """
    at, y, found = float(phase[0]), start, [(phase[:1], start[None])]
    left = MOST * math.ceil((phase[-1] - phase[0]) / (2 * math.pi))
    events = [_terminal(switch) for switch in impacts]
    while True:
        later = phase[phase > at]
        with heard():
            piece = scipy.integrate.solve_ivp(
                rates,
                (at, phase[-1]),
                y,
                method="LSODA",
                t_eval=later,
                events=events,
                rtol=tolerance,
                atol=tolerance,
                max_step=STEP,
            )
        values = np.reshape(piece.y, (len(start), -1)).T
        if not piece.success or not np.isfinite(values).all():
            raise IntegrationError(f"LSODA failed after tau = {at:.6g}", at)
        found.append((np.array(piece.t), values))
        if piece.status == 0:
            return np.concatenate([t for t, _ in found]), np.concatenate([x for _, x in found])
        assert piece.t_events is not None and piece.y_events is not None
        which = next(k for k, times in enumerate(piece.t_events) if len(times))
        at, before = float(piece.t_events[which][0]), np.array(piece.y_events[which][0])
        y, left = list(impacts.values())[which](at, before), left - 1
        found.append((np.array([at, at]), np.array([before, y])))
        if left < 0:
            raise IntegrationError(f"impacts pile up at tau = {at:.6g}", at)


def _terminal(switch: Switch) -> Switch:
    def value(tau: float, y: Array) -> float:
        return switch(tau, y)

    value.terminal, value.direction = True, -1.0  # type: ignore[attr-defined]
    return value
