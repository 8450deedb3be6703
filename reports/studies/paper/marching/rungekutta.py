"""The classical Runge-Kutta method of fourth order with a fixed step, for many runs at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symbolic.arrays import Array
from symbolic.motion.explicit import Rates


@dataclass(frozen=True, kw_only=True)
class Marched:
    """N runs of n states each.

    phase (K, N) and state (K, N, n): after the steps kept; not a number after a failure. failed (N,): the
    number of the step that gave something that is not finite, or -1. last (2, N, n): the last finite states.
    """

    phase: Array
    state: Array
    failed: NDArray[np.int64]
    last: Array


def factor(z: NDArray[np.complex128], order: int = 4) -> NDArray[np.complex128]:
    """Return R(z) = 1 + z + ... + z^p/p!, z = lambda dt: what a step of p = `order` stages makes of a mode.

    Of explicit Runge-Kutta methods whose order is their number of stages, p <= 4.
    """
    value = np.ones_like(z)
    for k in range(order, 0, -1):
        value = 1 + z / k * value
    return value


def growth(z: NDArray[np.complex128]) -> Array:
    """Return |R(z)| of the classical method; above 1 a mode grows."""
    return np.asarray(np.abs(factor(z)))


def stages(rates: Rates, state: Array, phase: Array, parameter: Array, size: Array) -> list[Array]:
    """Return the four states (N, n) at which a step evaluates the rates, and the state that it ends at."""
    column, half = size[:, None], size / 2
    k1 = rates(state, phase, parameter)
    second = state + column / 2 * k1
    k2 = rates(second, phase + half, parameter)
    third = state + column / 2 * k2
    k3 = rates(third, phase + half, parameter)
    fourth = state + column * k3
    k4 = rates(fourth, phase + size, parameter)
    return [state, second, third, fourth, state + column / 6 * (k1 + 2 * k2 + 2 * k3 + k4)]


def march(
    rates: Rates, start: Array, phase: Array, parameter: Array, size: Array, keep: NDArray[np.int64]
) -> Marched:
    """Step by `size` (N,) in tau from `start` (N, n) at `phase` (N,); parameter (p, N).

    keep (K,): rising numbers of the steps after which states are returned, 0 for the start; the last ends
    the runs. A run that fails is not continued; the others are.
    """
    kept = np.full((len(keep), *start.shape), np.nan)
    places = {int(number): place for place, number in enumerate(keep)}
    failed, last = np.full(len(start), -1), np.array([start, start])
    runs = np.arange(len(start))
    if 0 in places:
        kept[0] = start
    for index in range(1, int(keep[-1]) + 1):
        before = phase[runs] + (index - 1) * size[runs]
        with np.errstate(all="ignore"):
            new = stages(rates, last[1, runs], before, parameter[:, runs], size[runs])[-1]
        finite = np.isfinite(new).all(axis=1)
        if not finite.all():
            failed[runs[~finite]] = index
            runs, new = runs[finite], new[finite]
        last[0, runs], last[1, runs] = last[1, runs], new
        if index in places:
            kept[places[index], runs] = new
    return Marched(phase=phase + keep[:, None] * size, state=kept, failed=failed, last=last)
