"""Time integration through events: pieces from one zero of a switch to the next, the state mapped there."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, Literal, TypeVar

import numpy as np
import scipy

from symbolic.arrays import Array
from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.interrupts import heard
from symbolic.integration.lsoda import Rates

MOST = 1000
"""Most events in a period of the excitation, 2 pi in tau: after more they pile up in a point."""

STEP = 0.05
"""Longest step in tau, so that no event is passed over."""

STIFF = 10.0
"""Modes that turn by so many rad within the longest step are not followed."""

LOOSE = 1e-6
"""Tolerance from which on they need not be; to a finer one LSODA takes as few steps."""

Mode = TypeVar("Mode")
"""What the equations depend on besides: it is the same between two events."""

Value = Callable[[float, Array], float]


@dataclass(frozen=True)
class Event(Generic[Mode]):
    """Where `value` falls to 0 a piece ends; `after` gives state and mode with which the next one begins."""

    value: Value
    after: Callable[[float, Array], tuple[Array, Mode]]


def pieced(
    rates: Callable[[Mode], Rates],
    events: Callable[[Mode], Sequence[Event[Mode]]],
    mode: Mode,
    start: Array,
    phase: Array,
    tolerance: float,
    *,
    fastest: float = 0.0,
) -> tuple[Array, Array]:
    """Return phases and states, a row each: those asked for, and every jump of the state before and after it.

    fastest: largest |eigenvalue| of the equations' slope, per rad of tau: modes far faster than the steps,
    which ring and die away, are LSODA's worst case, and Radau IIA's best.

    Raises IntegrationError.
    """
    at, y, found = float(phase[0]), start, [(phase[:1], start[None])]
    method: Literal["Radau", "LSODA"] = "Radau" if fastest * STEP > STIFF and tolerance >= LOOSE else "LSODA"
    left = MOST * math.ceil((phase[-1] - phase[0]) / (2 * math.pi))
    while True:
        later, here = phase[phase > at], events(mode)
        with heard():
            piece = scipy.integrate.solve_ivp(
                rates(mode),
                (at, phase[-1]),
                y,
                method=method,
                t_eval=later,
                events=[_terminal(event.value) for event in here],
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
        (y, mode), left = here[which].after(at, before), left - 1
        if not np.array_equal(y, before):
            found.append((np.array([at, at]), np.array([before, y])))
        if left < 0:
            raise IntegrationError(f"events pile up at tau = {at:.6g}", at)


def _terminal(switch: Value) -> Value:
    def value(tau: float, y: Array) -> float:
        return switch(tau, y)

    value.terminal, value.direction = True, -1.0  # type: ignore[attr-defined]
    return value
