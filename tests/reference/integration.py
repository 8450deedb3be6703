"""Time integration by SciPy, and the limit cycles to which motions settle."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Rates = Callable[[float, Array], ArrayLike]
TWO_PI = 2 * math.pi


def path(
    rates: Rates,
    start: ArrayLike,
    until: float = TWO_PI,
    *,
    rtol: float = 1e-12,
    atol: float | ArrayLike = 1e-12,
    max_step: float = math.inf,
) -> Array:
    """States (n, steps) of y' = rates(t, y), y(0) = start, at the steps of DOP853 from 0 to `until`."""
    tight = {"method": "DOP853", "rtol": rtol, "atol": atol, "max_step": max_step}
    found = solve_ivp(rates, (0.0, until), start, **tight)
    assert found.success, found.message
    return np.asarray(found.y)


def limit_cycle(
    rates: Rates, start: ArrayLike, until: float, crossing: int, *, turns: int = 1, method: str = "DOP853"
) -> tuple[Array, float]:
    """Where the motion settled after `until` begins a cycle, and its period.

    A cycle lies between a rising passage of the state `crossing` through its mean and the one `turns` later.
    """
    tight = {"method": method, "rtol": 1e-11, "atol": 1e-12}
    settled = solve_ivp(rates, (0.0, until), start, **tight)
    mean = float(settled.y[crossing, settled.t > until / 2].mean())

    def passage(t: float, y: Array) -> float:
        return float(y[crossing]) - mean

    passage.direction, passage.terminal = 1.0, turns + 1  # type: ignore[attr-defined]
    found = solve_ivp(rates, (0.0, until), settled.y[:, -1], events=passage, **tight)
    assert found.status == 1, "no cycle"
    times = found.t_events[0]
    return found.y_events[0][0], float(times[turns] - times[0])


def over_period(
    rates: Rates, begin: ArrayLike, period: float, count: int = 401, method: str = "DOP853"
) -> tuple[Array, Array]:
    """Phases from 0 to 2 pi, shape (count,), and the states of one period there, shape (count, n)."""
    tight = {"method": method, "rtol": 1e-11, "atol": 1e-12}
    found = solve_ivp(rates, (0.0, period), begin, dense_output=True, **tight)
    assert found.success, found.message
    phase = np.linspace(0.0, TWO_PI, count)
    return phase, found.sol(phase * period / TWO_PI).T
