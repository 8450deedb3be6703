"""Pieces of a motion in one mode, by Taylor's series, and the first zero of a guard.

z(t + x h) = sum_j D_j x^j, 0 <= x <= 1, exact to rounding: h is what the fastest mode takes for 1.5
radians. A guard on the piece is a polynomial, enclosed by its Bernstein coefficients: where they are positive
it is, everywhere on the piece; else the piece is halved until it is decided.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from reference.joints.model import Array, Equations

ORDER = 22
"""Terms of a series."""

LONGEST = 1.5
"""Length of a piece times the fastest rate: the first term left out of a series is 1.5^22/22! = 7e-18."""

SAMPLES = 24
"""Pieces of a period, at the least."""

BLOCK = 16
"""Pieces that are taken at once where the mode is linear."""

ROUNDING = 1e-14
"""Of a guard; one that dips less below 0, as one that stays on 0 does, does not."""

HALVINGS = 45
"""Of a piece, at the most."""

BERNSTEIN = np.array([[comb(i, j) / comb(ORDER - 1, j) for j in range(ORDER)] for i in range(ORDER)])
"""From the coefficients of a polynomial on 0 to 1 to Bernstein's."""


@dataclass(frozen=True)
class Moved:
    """What a stretch of one mode made of z: after a length, by a matrix, up to guard `hit` if any.

    passed: states on the way from which it was computed, shape (pieces, N), each a step before the next.
    """

    length: float
    z: Array
    matrix: Array
    hit: int | None
    passed: Array


def taylor(equations: Equations, z: Array, h: float) -> Array:
    """D (ORDER, N)."""
    found = np.zeros((ORDER, len(z)))
    found[0] = z
    if not equations.rows.size:
        for j in range(1, ORDER):
            found[j] = equations.linear @ found[j - 1] * (h / j)
        return found
    u, w = np.zeros((2, ORDER, len(equations.rows)))
    for j in range(1, ORDER):
        u[j - 1] = equations.rows @ found[j - 1]
        w[j - 1] = (u[:j] * u[:j][::-1]).sum(axis=0)
        cube = (w[:j] * u[:j][::-1]).sum(axis=0)
        found[j] = (equations.linear @ found[j - 1] + equations.columns @ cube) * (h / j)
    return found


def product(u: Array, w: Array) -> Array:
    """Coefficients of a product, as many as those of its factors, shape (terms, c)."""
    each = [np.convolve(one, other)[: len(u)] for one, other in zip(u.T, w.T, strict=True)]
    return np.array(each).T


def variation(equations: Equations, series: Array, h: float) -> Array:
    """The series of dz(t + x h)/dz(t), shape (ORDER, N, N)."""
    size = series.shape[1]
    found = np.zeros((ORDER, size, size))
    found[0] = np.eye(size)
    u = series @ equations.rows.T
    w = 3 * product(u, u)
    turned = np.zeros((ORDER, *equations.rows.shape))
    for j in range(1, ORDER):
        turned[j - 1] = equations.rows @ found[j - 1]
        rows = (w[:j, :, None] * turned[:j][::-1]).sum(axis=0)
        found[j] = (equations.linear @ found[j - 1] + equations.columns @ rows) * (h / j)
    return found


def guards(equations: Equations, series: Array) -> Array:
    """Coefficients of the guards, shape (ORDER, g)."""
    found = series @ equations.guards.T
    if equations.rows.size:
        u = series @ equations.rows.T
        found += product(product(u, u), u) @ equations.cubes.T
    return found


def at(series: Array, x: float) -> Array:
    """Sum of a series."""
    return np.asarray(np.tensordot(x ** np.arange(len(series)), series, 1))


def first_below(coefficients: Array, small: float) -> float | None:
    """Where on 0 to 1 a polynomial first falls through 0, to less than -small."""
    found = _first_below(BERNSTEIN @ coefficients, 0.0, 1.0, coefficients, small, HALVINGS)
    return None if found is None else min(max(found, 0.0), 1.0)


def _first_below(
    hull: Array, low: float, high: float, polynomial: Array, small: float, depth: int
) -> float | None:
    if hull.min() >= -small:
        return None
    falls = hull[0] > 0 and hull[-1] < -small and np.count_nonzero(np.diff(np.sign(hull))) == 1
    if falls:
        return float(brentq(lambda x: float(at(polynomial, x)), low, high, xtol=1e-16, rtol=1e-15))
    if depth == 0:
        return low if hull[-1] < -small else None
    left, right = halves(hull)
    middle = (low + high) / 2
    found = _first_below(left, low, middle, polynomial, small, depth - 1)
    if found is None:
        found = _first_below(right, middle, high, polynomial, small, depth - 1)
    return found


def halves(hull: Array) -> tuple[Array, Array]:
    """Bernstein's coefficients on both halves of an interval (de Casteljau)."""
    left, right, row = np.empty_like(hull), np.empty_like(hull), hull
    for j in range(len(hull)):
        left[j], right[-1 - j] = row[0], row[-1]
        row = (row[1:] + row[:-1]) / 2
    return left, right


class Straight:
    """A linear mode: blocks of pieces by powers of exp(G h)."""

    def __init__(self, equations: Equations, Omega: float) -> None:
        self.equations = equations
        self.step = step(equations.linear, Omega)
        size = len(equations.linear)
        flow, self.flows = expm(equations.linear * self.step), np.zeros((BLOCK, size, size))
        self.flows[0] = flow
        for k in range(1, BLOCK):
            self.flows[k] = flow @ self.flows[k - 1]
        rows = np.zeros((ORDER, *equations.guards.shape))
        rows[0] = equations.guards
        for j in range(1, ORDER):
            rows[j] = rows[j - 1] @ equations.linear * (self.step / j)
        self.hulls = np.einsum("ij,jgn->gin", BERNSTEIN, rows)
        self.sizes = np.abs(equations.guards)

    def moved(self, z: Array, left: float, varied: bool = True) -> Moved:
        """At most a block, no more than what is left, up to the first event."""
        count = max(1, min(BLOCK, int(left / self.step)))
        most = min(1.0, left / self.step)
        begun = np.concatenate([z[None], self.flows[: count - 1] @ z])
        small = ROUNDING * (1 + self.sizes @ np.abs(z))
        below = np.einsum("kn,gin->kgi", begun, self.hulls).min(axis=2) < -small
        for k in np.flatnonzero(below.any(axis=1)):
            series = taylor(self.equations, begun[k], self.step)
            hit = earliest(guards(self.equations, series), np.flatnonzero(below[k]), small, most)
            if hit is not None:
                part = expm(self.equations.linear * (hit[1] * self.step))
                flow = part @ self.flows[k - 1] if k else part
                return Moved((k + hit[1]) * self.step, at(series, hit[1]), flow, hit[0], begun[: k + 1])
        if most < 1:
            flow = expm(self.equations.linear * left)
            return Moved(left, flow @ z, flow, None, begun)
        flow = self.flows[count - 1]
        return Moved(count * self.step, flow @ z, flow, None, begun)


class Curved:
    """A mode with cubic springs: a piece at a time."""

    def __init__(self, equations: Equations, Omega: float) -> None:
        self.equations, self.Omega = equations, Omega
        self.sizes = np.abs(equations.guards)

    def moved(self, z: Array, left: float, varied: bool = True) -> Moved:
        """One piece, no more than what is left, up to the first event."""
        e = self.equations
        slope = e.linear + e.columns @ (3 * (e.rows @ z)[:, None] ** 2 * e.rows)
        h = step(slope, self.Omega)
        series = taylor(e, z, h)
        while np.abs(series[-2:]).max() > 1e-17 * np.abs(series).max():
            h /= 2
            series = taylor(e, z, h)
        small = ROUNDING * (1 + self.sizes @ np.abs(z))
        most = min(1.0, left / h)
        hit = earliest(guards(e, series), range(len(small)), small, most)
        x = most if hit is None else hit[1]
        flow = at(variation(e, series, h), x) if varied else np.eye(len(z))
        return Moved(x * h, at(series, x), flow, None if hit is None else hit[0], z[None])


def step(matrix: Array, Omega: float) -> float:
    """The length h of a piece."""
    fastest = float(np.abs(np.linalg.eigvals(matrix)).max())
    return float(min(2 * np.pi / Omega / SAMPLES, LONGEST / fastest))


def earliest(polynomials: Array, which: range | Array, small: Array, most: float) -> tuple[int, float] | None:
    """The guard that is first to fall below 0 on a piece, and where."""
    found: tuple[int, float] | None = None
    for k in which:
        x = first_below(polynomials[:, k], float(small[k]))
        if x is not None and x <= most and (found is None or x < found[1]):
            found = int(k), x
    return found
