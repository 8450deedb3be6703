"""A mass on a moving belt before a rigid wall, in closed form from event to event.

x'' + c x' + x = cos(w t) - f sign(x' - v); x' becomes -e x' where x, or -x, arrives at the gap.
Sliding is a forced oscillator, sticking is x' = v as long as |cos(w t) - x - c v| <= f. Shares nothing with
`periodic` and `symbolic`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.optimize import brentq

from reference.integration import Array

SAMPLES = 4000
"""Places in a period at which guards are looked at."""

AT = 1e-12
"""A guard that is as near to 0 is 0."""

MOST = 200
"""Most events in a period."""


@dataclass(frozen=True)
class BeltWall:
    """The machine: damping c, belt's speed v, limit f, gap, restitution e, side of the wall."""

    c: float
    v: float
    f: float
    gap: float
    e: float
    below: bool = False

    def slides(self, t0: float, state: Array, w: float, side: float) -> Callable[[Array], Array]:
        """Return t to (x, x', x'') of sliding with a sign of x' - v."""
        c, wd = self.c, np.sqrt(1 - self.c**2 / 4)
        big = 1 / (1 - w**2 + 1j * c * w)

        def forced(t: Array) -> Array:
            z = big * np.exp(1j * w * t)
            return np.array([z.real - self.f * side, (1j * w * z).real, (-(w**2) * z).real])

        x, v = np.array(state) - forced(np.array(t0))[:2]
        free = x + 1j * (-(v + c / 2 * x) / wd)  # Re(free exp(p t))
        p = -c / 2 + 1j * wd

        def at(t: Array) -> Array:
            z = free * np.exp(p * (t - t0))
            return forced(t) + np.array([z.real, (p * z).real, (p * p * z).real])

        return at

    def after(self, t: float, state: Array, w: float) -> tuple[Array, Array, str]:
        """Return state and monodromy matrix after a period, and the word of what happens.

        Modes + - 0 that begin, and impacts: P after which x' > v, M after which it is less.
        """
        end, y, word = t + 2 * np.pi / w, np.array(state, dtype=float), ""
        mode, matrix = float(np.sign(y[1] - self.v)), np.eye(2)
        for _ in range(MOST):
            later, arrived, what = self._piece(t, end, y, w, mode)
            matrix = self._free(later - t, mode) @ matrix
            if not what:
                return arrived, matrix, word
            before = self._rates(later, arrived, w, mode)
            mode, after, told = self._passed(later, arrived, w, mode, what)
            reset = np.diag([1.0, -self.e]) if what == "wall" else np.eye(2)
            normal = {"wall": np.array([1.0, 0.0]), "turn": np.array([0.0, 1.0])}.get(what)
            if normal is not None:
                jump = self._rates(later, after, w, mode) - reset @ before
                matrix = (reset + np.outer(jump, normal) / (normal @ before)) @ matrix
            t, y, word = later, after, word + told
        raise ArithmeticError("too many events")

    def _rates(self, t: float, y: Array, w: float, mode: float) -> Array:
        """(x', x'') in a mode."""
        return np.array([y[1], (np.cos(w * t) - y[0] - self.c * y[1] - self.f * mode) if mode else 0.0])

    def _free(self, span: float, mode: float) -> Array:
        """What perturbations of a mode become."""
        if mode == 0:
            return np.array([[1.0, 0.0], [0.0, 0.0]])
        rates = np.array([[0.0, 1.0], [-1.0, -self.c]])
        return np.asarray(scipy.linalg.expm(span * rates))

    def _pulled(self, t: float, y: Array, w: float) -> float:
        return float(np.cos(w * t) - y[0] - self.c * self.v)

    def _passed(self, t: float, y: Array, w: float, mode: float, what: str) -> tuple[float, Array, str]:
        if what == "wall":
            y = np.array([y[0], -self.e * y[1]])
            after = float(np.sign(y[1] - self.v))
            return after, y, "P" if after > 0 else "M"
        pulled = self._pulled(t, y, w)
        if what == "turn":
            y = np.array([y[0], self.v])
            mode = 0.0 if abs(pulled) < self.f else float(np.sign(pulled))
        else:
            mode = float(np.sign(pulled))
        return mode, y, "0" if mode == 0 else "+" if mode > 0 else "-"

    def _piece(self, t: float, end: float, y: Array, w: float, mode: float) -> tuple[float, Array, str]:
        """Follow one mode to its end: when, where, and what ends it."""
        way = -1.0 if self.below else 1.0
        if mode == 0:

            def at(s: Array) -> Array:
                return np.array([y[0] + self.v * (s - t), self.v + 0 * s, 0 * s])

            def own(s: Array) -> Array:
                return self.f - np.abs(np.cos(w * s) - at(s)[0] - self.c * self.v)

        else:
            at = self.slides(t, y, w, mode)

            def own(s: Array) -> Array:
                return mode * (at(s)[1] - self.v)

        def wall(s: Array) -> Array:
            return self.gap - way * at(s)[0]

        found = [(_first(g, t, end), name) for g, name in ((wall, "wall"), (own, "turn" if mode else "slip"))]
        first, what = min(found)
        if first > end:
            return end, at(np.array(end))[:2], ""
        return first, at(np.array(first))[:2], what


def _first(guard: Callable[[Array], Array], begin: float, end: float) -> float:
    """The first fall of a guard to 0 after the begin, where it may be 0; infinite if none."""
    s = np.linspace(begin, end, SAMPLES + 1)
    values = guard(s)
    low = np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:])) + 1
    for i in low:  # a dip between samples
        fit = np.polyfit(s[i - 1 : i + 2] - s[i], values[i - 1 : i + 2], 2)
        if values[i] > 0 and fit[0] > 0:
            dip = s[i] - fit[1] / (2 * fit[0])
            if guard(np.array(dip)) < 0:
                values[i], s[i] = guard(np.array(dip)), dip
    start = 1 if abs(values[0]) < AT or values[0] < 0 else 0
    past = np.flatnonzero(values[start:] < 0)
    if not len(past):
        return np.inf
    j = int(past[0]) + start
    if j == start == 1:  # within the first sample: it rises from 0 and falls again, or never rose
        inside = np.linspace(s[0], s[1], 101)[1:]
        rises = np.flatnonzero(guard(inside) > 0)
        if not len(rises):
            return float(s[0])
        return float(brentq(lambda t: float(guard(np.array(t))), inside[rises[-1]], s[1], xtol=1e-15))
    a, b = float(s[j - 1]), float(s[j])
    return float(brentq(lambda t: float(guard(np.array(t))), a, b, xtol=1e-15))
