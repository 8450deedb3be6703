"""The mass and its stop in closed form: matrix exponentials from passage to passage of the gap.

q'' + c q' + q + k max(q - g, 0) = F cos(Omega t) is linear on either side of the gap, (q, q', 1, cos, sin)' =
G (q, q', 1, cos, sin). The field is continuous, so perturbations take the same exponentials.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from periodic.orbit.scheme import Array

DAMPING, FORCE, GAP = 0.1, 0.5, 1.0

PIECES = 400
"""Of a period; q has at most one extremum in each."""


def orbit(stiffness: float, omega: float, phase: float, guess: Array) -> tuple[Array, Array]:
    """Return (q, q') of the periodic orbit at a phase, by Newton from a guess, and the monodromy matrix.

    Raises ArithmeticError where there is none near the guess.
    """
    state = np.array(guess, dtype=float)
    for _ in range(20):
        end, monodromy = period(stiffness, omega, phase, state)
        if np.abs(end - state).max() < 1e-12 * max(1.0, float(np.abs(monodromy).max())):
            return state, monodromy
        state = state + np.linalg.solve(np.eye(2) - monodromy, end - state)
    raise ArithmeticError("no orbit in closed form was found near the guess")


def period(stiffness: float, omega: float, phase: float, begin: Array) -> tuple[Array, Array]:
    """Return (q, q') a period later, and its derivative in (q, q')."""
    z, derivative = np.array([*begin, 1.0, math.cos(phase), math.sin(phase)]), np.eye(5)
    sides = [_generator(0.0, omega), _generator(stiffness, omega)]
    steps = [2 * math.pi / omega / PIECES, min(2 * math.pi / omega / PIECES, 0.3 / math.sqrt(1 + stiffness))]
    flows = [expm(side * step) for side, step in zip(sides, steps, strict=True)]
    t, span, pressed = 0.0, 2 * math.pi / omega, int(z[0] > GAP)
    while span - t > 1e-14 * span:
        length = min(steps[pressed], span - t)
        flow = flows[pressed] if length == steps[pressed] else expm(sides[pressed] * length)
        hit = _passage(sides[pressed], z, flow @ z, length, pressed)
        if hit is not None:
            length, flow = hit, expm(sides[pressed] * hit)
        z, derivative, t = flow @ z, flow @ derivative, t + length
        pressed = 1 - pressed if hit is not None else pressed
    return z[:2], derivative[:2, :2]


def _generator(stiffness: float, omega: float) -> Array:
    matrix = np.zeros((5, 5))
    matrix[0, 1], matrix[1, :4] = 1.0, [-1.0 - stiffness, -DAMPING, stiffness * GAP, FORCE]
    matrix[3, 4], matrix[4, 3] = -omega, omega
    return matrix


def _passage(side: Array, begin: Array, end: Array, length: float, pressed: int) -> float | None:
    """When the gap is passed within a piece, first looked for before an extremum inside it."""
    sign = 1.0 if pressed else -1.0

    def past(t: float) -> float:
        return sign * float((expm(side * t) @ begin)[0] - GAP)

    def rate(t: float) -> float:
        return sign * float((expm(side * t) @ begin)[1])

    marks = [0.0, length]
    if sign * begin[1] < 0 < sign * end[1] or sign * begin[1] > 0 > sign * end[1]:
        if sign * (end[0] - GAP) > 0 and sign * (begin[0] - GAP) > length * abs(begin[1]):
            return None
        marks.insert(1, float(brentq(rate, 0.0, length, xtol=1e-15)))
    for a, b in zip(marks[:-1], marks[1:], strict=True):
        if past(b) < -1e-15:
            return float(brentq(past, a, b, xtol=1e-16, rtol=1e-15)) if past(a) > 0 else a
    return None
