"""Fixed points of the return map of motions in time: x(2 pi) = x(0), whatever happens in between.

Where a motion settles slowly, or to one that repeats itself after several periods, Newton's method on the map
itself finds the orbit of one period: the events are followed, so that no word need be known. Derivatives are
differences, then secants (Broyden 1965). A step that does not lead nearer is halved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from periodic.orbit.scheme import Array

DIFFERENCE = 1e-4
"""Differences, in parts of a state's range: they are as exact as the steps that they are for need them."""

LEAST = 1e-2
"""Least range of a state in that, as a part of the largest."""

PARTS = (1.0, 0.5, 0.25, 0.125, 0.0625)
"""Parts of a step that are tried."""

ENOUGH = 0.25
"""Of what a part of a step should take away from the residual, what it has to."""

KINKS = 3
"""How often a whole step is taken where no part of it leads nearer: there the map has a kink."""

STEPS = 15
"""Most steps."""

HELD = 1e-4
"""Singular values below this part are those of places that are not determined, as where a slider holds."""


@dataclass
class ReturnMap:
    """The map of a state over a period, and how far its motion ranges.

    Parameters
    ----------
    follow : callable
        A state (n,) at the beginning of a period to the states (K, n) in it; the last is that at its end.
        Raises what the integration raises.
    tolerance, enough : float
        How far apart the ends of an orbit may be, as a part of its largest range: what is aimed at, and what
        will do where no step leads nearer, as at a kink of the map.
    """

    follow: Callable[[Array], Array]
    tolerance: float
    enough: float
    range: Array = field(default_factory=lambda: np.zeros(0), init=False)

    def residual(self, state: Array) -> Array:
        """Return x(2 pi) - x(0), shape (n,)."""
        path = self.follow(state)
        self.range = np.ptp(path, axis=0)
        return np.asarray(path[-1] - path[0])

    def fixed(self, state: Array) -> Array | None:
        """Return the state at the beginning of an orbit near one; None where none is found."""
        off, slope = self.residual(state), None
        if not np.isfinite(off).all() or not self.range.any():
            return None
        scale = np.maximum(self.range, LEAST * self.range.max())
        best, kinks = (state, float(np.abs(off).max())), 0
        for _ in range(STEPS):
            if best[1] <= self.tolerance * self.range.max():
                break
            moved = None if slope is None else self._nearer(state, off, slope, scale)
            if moved is None:
                slope = self._slope(state, off, scale)
                moved = self._nearer(state, off, slope, scale)
            if moved is None and slope is not None and kinks < KINKS:
                moved, kinks = self._across(state, off, slope, scale), kinks + 1
            if moved is None or slope is None:
                break
            way, change = (moved[0] - state) / scale, (moved[1] - off) / scale
            slope = slope + np.outer(change - slope @ way, way) / (way @ way)
            state, off = moved
            best = min(best, (state, float(np.abs(off).max())), key=lambda pair: pair[1])
        return best[0] if best[1] <= self.enough * self.range.max() else None

    def _slope(self, state: Array, off: Array, scale: Array) -> Array:
        """The derivatives of the residual by differences, both in parts of the range."""
        steps = DIFFERENCE * np.diag(scale)
        return np.array([(self.residual(state + step) - off) / scale for step in steps]).T / DIFFERENCE

    def _across(self, state: Array, off: Array, slope: Array, scale: Array) -> tuple[Array, Array] | None:
        """The state a whole step away, and its residual: past a kink of the map it has other slopes."""
        moved = state - scale * (np.linalg.pinv(slope, rcond=HELD) @ (off / scale))
        return (moved, self.residual(moved)) if np.isfinite(moved).all() else None

    def _nearer(self, state: Array, off: Array, slope: Array, scale: Array) -> tuple[Array, Array] | None:
        """A state nearer to an orbit on Newton's step, and its residual."""
        step = -scale * (np.linalg.pinv(slope, rcond=HELD) @ (off / scale))
        size = float(np.linalg.norm(off / scale))
        for part in PARTS if np.isfinite(step).all() else ():
            moved = state + part * step
            now = self.residual(moved)
            if np.linalg.norm(now / scale) < (1 - ENOUGH * part) * size:
                return moved, now
        return None
