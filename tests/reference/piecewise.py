"""Piecewise linear systems in closed form: exact to rounding through every grazing.

Between passages of the switches s_i(y) = c_i . y - g_i the equations are linear with a harmonic excitation,

    y' = A y + b + f cos(Omega t),    A = A0 + sum_i [s_i > 0] k_i c_i',   b = -sum_i [s_i > 0] k_i g_i,

so a piece is one matrix exponential of (y, 1, cos, sin). Passages are the zeros of s_i, looked for between
the zeros of its derivative: an excursion is found however short it is. The field is continuous, so
perturbations are multiplied by the same exponentials; no integrator takes part.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from reference.integration import TWO_PI, Array
from reference.shooting import in_order

SAMPLES = 200
"""Pieces of a period within which a switch has at most one extremum."""

AT = 1e-13
"""Time after an event within which a switch is not looked at."""


@dataclass(frozen=True)
class Piecewise:
    """A0 (n, n), force f (n,), and of each switch c (switches, n), gap g, and the column k (switches, n)."""

    matrix: Array
    force: Array
    normals: Array
    gaps: Array
    columns: Array

    def generator(self, Omega: float, sides: NDArray[np.bool_]) -> Array:
        """The matrix of (y, 1, cos, sin)."""
        n = len(self.matrix)
        full = np.zeros((n + 3, n + 3))
        full[:n, :n] = self.matrix + np.einsum("i,ia,ib->ab", sides * 1.0, self.columns, self.normals)
        full[:n, n] = -(sides * self.gaps) @ self.columns
        full[:n, n + 1] = self.force
        full[n + 1, n + 2], full[n + 2, n + 1] = -Omega, Omega
        return full


@dataclass(frozen=True)
class Period:
    """One period from a state: where it leads, the monodromy matrix, the passages (switch, direction, tau),
    and the largest value of each switch.
    """

    start: Array
    end: Array
    monodromy: Array
    passages: list[tuple[int, int, float]]
    highest: Array

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of the monodromy matrix, largest modulus first."""
        return in_order(np.linalg.eigvals(self.monodromy))


def period(system: Piecewise, Omega: float, start: ArrayLike, periods: int = 1, phase: float = 0.0) -> Period:
    """Follow y over so many periods from a phase on, in t with tau = phase + Omega t."""
    n, begin = len(system.matrix), np.array(start, dtype=float)
    z = np.concatenate([begin, [1.0, np.cos(phase), np.sin(phase)]])
    normals = np.concatenate([system.normals, -system.gaps[:, None], np.zeros((len(system.gaps), 2))], axis=1)
    sides = normals @ z > 0
    monodromy, passages, highest = np.eye(n), [], normals @ z
    t, step, span = 0.0, TWO_PI / Omega / SAMPLES, TWO_PI * periods / Omega
    while t < span - 1e-14 * span:
        generator = system.generator(Omega, sides)
        fastest = float(np.abs(np.linalg.eigvals(generator)).max())
        length = min(step, 1.0 / fastest, span - t)
        hit, first = None, length
        for i, row in enumerate(normals):
            at = _leaves(generator, row, z, length, bool(sides[i]))
            if at is not None and at < first:
                hit, first = i, at
        flow = scipy.linalg.expm(generator * first)
        z, monodromy, t = flow @ z, flow[:n, :n] @ monodromy, t + first
        highest = np.maximum(highest, normals @ z)
        if hit is not None:
            sides[hit] = not sides[hit]
            passages.append((hit, 1 if sides[hit] else -1, phase + t * Omega))
    return Period(begin, z[:n], monodromy, passages, highest)


def _leaves(generator: Array, row: Array, z: Array, length: float, above: bool) -> float | None:
    """First time within a piece at which a switch leaves its side."""
    sign = 1.0 if above else -1.0

    def value(t: float) -> float:
        return sign * float(row @ scipy.linalg.expm(generator * t) @ z)

    def slope(t: float) -> float:
        return sign * float(row @ generator @ scipy.linalg.expm(generator * t) @ z)

    ends = [AT, length]
    if slope(AT) * slope(length) < 0:
        ends.insert(1, scipy.optimize.brentq(slope, AT, length, xtol=1e-15))
    for a, b in zip(ends[:-1], ends[1:], strict=True):
        if value(b) < 0:
            return float(scipy.optimize.brentq(value, a, b, xtol=1e-15)) if value(a) > 0 else a
    return None


def periodic(
    system: Piecewise, Omega: float, guess: ArrayLike, periods: int = 1, phase: float = 0.0
) -> Period:
    """Newton on y(T) - y(0) = 0 from a guess of y(0)."""
    state = np.array(guess, dtype=float)
    for _ in range(40):
        found = period(system, Omega, state, periods, phase)
        gap = found.end - found.start
        if np.abs(gap).max() < 1e-12 * max(1.0, np.abs(found.monodromy).max()):
            return found
        state = state + np.linalg.solve(np.eye(state.size) - found.monodromy, gap)
    raise ArithmeticError("shooting did not converge")
