"""Fixed points of the map over some periods, stable or not: Newton's method from many places at once.

Derivatives are the tangents of the motions themselves, through kinks, impacts and sliding. Roots that are
known are deflated: with M = prod(1 / |x - r|^2 + 1) Newton's step for M F is that for F times
1 / (1 - grad M . step / M) (Brown & Gartling, SIAM J. Appl. Math. 20 (1971); Farrell, Birkisson & Funke, SIAM
J. Sci. Comput. 37 (2015)), so that the same starts lead elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.system.ensembles import FOLLOWED

ITERATIONS = 60
"""Newton's steps from a place, shortened ones included."""

SHORTER = 4.0
"""By what a step is shortened that leads no nearer."""

LEAST = 1e-3
"""Part of a step at which the search ends."""

LONGEST = 0.25
"""Longest step, in widths of the box."""

FOUND = 1e-6
"""Residual and step of a fixed point, in widths of the box."""

OUTSIDE = 3.0
"""How far outside the box, in its widths, a search goes on."""


@dataclass(frozen=True, eq=False)
class FixedPoints:
    """The map x(0) -> x(2 pi periods) of a crowd, with units (n,) of the states and their middle (n,)."""

    crowd: Crowd
    periods: int
    unit: Array
    middle: Array

    def found(self, start: Array, known: Array) -> Array:
        """Return fixed points (K, n) reached from states (S, n), those known (R, n) left out.

        A step that does not lead to a smaller |M F| is shortened.
        """
        base, now = start.copy(), start.copy()
        step, size, part = np.zeros_like(start), np.full(len(start), np.inf), np.ones(len(start))
        roots: list[Array] = []
        left = np.arange(len(start))
        for _ in range(ITERATIONS):
            if not len(left):
                break
            residual, slope = self._map(now[left])
            merit = np.linalg.norm(residual / self.unit, axis=1) * self._deflation(now[left], known)
            nearer = merit < size[left]
            better, worse = left[nearer], left[~nearer]
            base[better], size[better], part[better] = now[better], merit[nearer], 1.0
            part[worse] /= SHORTER
            newton = self._newton(residual[nearer], slope[nearer])
            step[better] = self._limited(self._deflated(now[better], newton, known))
            done = (np.abs(residual[nearer] / self.unit).max(axis=1, initial=0.0) < FOUND) & (
                np.abs(newton / self.unit).max(axis=1, initial=0.0) < FOUND
            )
            roots += list(now[better[done]] + newton[done])
            now[left] = base[left] + part[left, None] * step[left]
            inside = np.abs((now - self.middle) / self.unit).max(axis=1) < OUTSIDE
            left = left[inside[left] & (part[left] > LEAST) & ~np.isin(left, better[done])]
        return np.array(roots).reshape(-1, start.shape[1])

    def _limited(self, step: Array) -> Array:
        """The steps, no longer than LONGEST."""
        size = np.abs(step / self.unit).max(axis=1, initial=0.0)
        return step * np.minimum(1.0, LONGEST / np.maximum(size, LONGEST))[:, None]

    def _deflation(self, x: Array, known: Array) -> Array:
        """M at states (S, n)."""
        if not len(known):
            return np.ones(len(x))
        squares = np.maximum((((x[:, None] - known) / self.unit) ** 2).sum(axis=2), 1e-30)
        return np.asarray(np.prod(1 / squares + 1, axis=1))

    def _map(self, x: Array) -> tuple[Array, Array]:
        """P(x) - x, (S, n), and its derivative (S, n, n); NaN where the motion is lost."""
        n = x.shape[1]
        y = self.crowd.begin(x)
        tangents = self.crowd.tangents(y)
        after = self.crowd.run(y, 1, FORCED * self.periods, tangents=tangents, raw=True)
        lost = after.outcome != FOLLOWED
        residual, slope = after.ends[:, :n] - x, np.swapaxes(after.tangents[:, :, :n], 1, 2) - np.eye(n)
        residual[lost] = np.nan
        return residual, slope

    @staticmethod
    def _newton(residual: Array, slope: Array) -> Array:
        """The steps, by least squares where a matrix is singular."""
        step = np.full_like(residual, np.nan)
        good = np.isfinite(residual).all(axis=1) & np.isfinite(slope).all(axis=(1, 2))
        if good.any():
            inverse = np.linalg.pinv(slope[good], rcond=1e-12)
            step[good] = -np.einsum("sij,sj->si", inverse, residual[good])
        return step

    def _deflated(self, x: Array, step: Array, known: Array) -> Array:
        """The steps with the known roots deflated."""
        if not len(known):
            return step
        away = (x[:, None] - known) / self.unit
        squares = np.maximum((away**2).sum(axis=2), 1e-30)
        along = np.einsum("srn,sn->sr", away, step / self.unit)
        share = (-2 * along / squares**2 / (1 / squares + 1)).sum(axis=1)
        factor = 1 / (1 - share)
        return step * np.clip(factor, -1.0 / FOUND, 1.0 / FOUND)[:, None]
