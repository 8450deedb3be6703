"""Where a guard falls to 0 along a motion: enclosures of cubics, and the root between two phases.

The step control of an integrator sees a kink where it evaluates the rates beside it. A short excursion past a
level - a stop that is just touched - lies between two evaluations, and the motion goes on as if there were
none. So the guards are evaluated along the motion. Between neighbouring phases each is represented by the
cubic with its values and rates at both ends; the error is estimated from such cubics over two of these
intervals. Bernstein coefficients enclose the guard.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from symbolic.arrays import Array

SAFE = 4.0
"""How many times its estimate the error of a cubic may be."""

RESOLVED = 1e-15
"""Phases (rad) that are so near to each other are the same."""

ITERATIONS = 50
"""Most iterations for a root."""

Motion = Callable[[float, Array, float], Array]
"""(tau, y, later) to y at a later phase."""


@dataclass(frozen=True)
class Passed:
    """A phase of a motion, y there, and the value of a guard with its derivative in tau."""

    phase: float
    y: Array
    value: float
    rate: float


Guard = Callable[[float, Array], Passed]
"""(tau, y) to a guard there."""


def lowest(values: Array, rates: Array, phase: Array) -> Array:
    """Return lower bounds of guards (K, guards) on the K-1 intervals between phases.

    An error of s''''/24 (t - a)^2 (b - t)^2 changes only the middle one of the five Bernstein coefficients.
    """
    width = (phase[1:] - phase[:-1])[:, None]
    left, right = values[:-1] + width * rates[:-1] / 3, values[1:] - width * rates[1:] / 3
    middle = (left + right) / 2 - SAFE * _fourth(values, rates, phase) * width**4 / 6
    inner = [(values[:-1] + 3 * left) / 4, middle, (3 * right + values[1:]) / 4]
    return np.min([values[:-1], *inner, values[1:]], axis=0)


def _fourth(s: Array, rate: Array, phase: Array) -> Array:
    """s''''/24 on the K-1 intervals, from the error of cubics over two of them at the phase in between.

    A cubic is off by s''''/24 (t - a)^2 (b - t)^2; for a single interval that is unknown.
    """
    if len(phase) < 3:
        return np.full((len(phase) - 1, s.shape[1]), np.inf)
    a, b = (phase[1:-1] - phase[:-2])[:, None], (phase[2:] - phase[1:-1])[:, None]
    t = a / (a + b)
    left, right = (1 + 2 * t) * (1 - t) ** 2, t**2 * (3 - 2 * t)
    slopes = (a + b) * (t * (1 - t) ** 2 * rate[:-2] - t**2 * (1 - t) * rate[2:])
    fourth = np.abs(left * s[:-2] + right * s[2:] + slopes - s[1:-1]) / (a * b) ** 2
    return np.maximum(np.concatenate([fourth[:1], fourth]), np.concatenate([fourth, fourth[-1:]]))


@dataclass(frozen=True)
class Root:
    """Phases just before and just after a guard falls through its level, y at both, and its rate there."""

    before: float
    after: float
    y_before: Array
    y_after: Array
    rate: float


def root(motion: Motion, guard: Guard, low: Passed, high: Passed, near: float) -> Root:
    """Return where a guard falls through 0 between two phases, by Newton's method on either side.

    Both sides are within `near` of 0 where the phases resolve that.
    """
    guess, found, now = crossing(low, high), [False, False], high
    for _ in range(ITERATIONS):
        at = guess if low.phase < guess < high.phase else (low.phase + high.phase) / 2
        now = guard(at, motion(low.phase, low.y, at))
        past = now.value < 0
        found[past] = found[past] or abs(now.value) <= near
        low, high = (low, now) if past else (now, high)
        if all(found) or high.phase - low.phase <= RESOLVED:
            break
        aim = near / 2 if found[True] else -near / 2
        guess = at + (aim - now.value) / now.rate if now.rate else low.phase
    return Root(low.phase, high.phase, low.y, high.y, now.rate)


def crossing(low: Passed, high: Passed) -> float:
    """Return where the cubic of a guard first vanishes between two phases; the first of them if nowhere."""
    width = high.phase - low.phase
    if width <= RESOLVED:
        return low.phase
    slope = (high.value - low.value) / width
    bend = (low.rate + high.rate - 2 * slope) / width
    powers = np.array([[bend / width], [(slope - low.rate) / width - bend], [low.rate], [low.value]])
    if not np.isfinite(powers).all():
        return low.phase
    cubic = PPoly.construct_fast(powers, np.array([low.phase, high.phase]))
    roots = cubic.roots(extrapolate=False)
    return float(roots[0]) if len(roots) else low.phase
