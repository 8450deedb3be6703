"""Fixed points of the return map of motions in time: x(2 pi) = x(0), whatever happens in between.

Where a motion settles slowly, or to one that repeats itself after several periods, Newton's method on the map
itself finds the orbit of one period: the events are followed, so that no word need be known. Derivatives are
differences, then secants (Broyden 1965), steps are kept where they lead nearer (Powell's hybrid method).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import fsolve

from periodic.orbit.scheme import Array

DIFFERENCE = 1e-4
"""Step of differences, in parts of a state's range: Newton's steps need no more accurate ones."""

LEAST = 1e-2
"""Least range of a state in that, as a part of the largest range of all states."""

STEPS = 15
"""How many steps at the most, each with differences in every state."""


@dataclass
class ReturnMap:
    """The map of a state over a period, and the ranges of the states.

    Parameters
    ----------
    follow : callable
        A state (n,) at the beginning of a period to the states (K, n) in it; the last is that at its end.
        Raises what the integration raises.
    tolerance, enough : float
        Distance of x(2 pi) from x(0), as a part of the largest range of a state: the aim, and what is taken
        where no step leads nearer, as at a kink of the map.
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
        """Return the state at the beginning of an orbit near a given state; None where none is found."""
        off = self.residual(state)
        if not np.isfinite(off).all() or not self.range.any():
            return None
        scale = np.maximum(self.range, LEAST * self.range.max())

        def moved(place: Array) -> Array:  # places about 1, so that differences are parts of the range
            return state + scale * (place - 1)

        def apart(place: Array) -> list[float]:
            return list(self.residual(moved(place)) / scale)

        place, found, *_ = fsolve(
            apart,
            np.ones(len(state)),
            full_output=True,
            xtol=self.tolerance,
            maxfev=STEPS * (len(state) + 1),
            epsfcn=DIFFERENCE**2,
            factor=1.0,
        )
        near = np.abs(found["fvec"] * scale).max() <= self.enough * self.range.max()
        return moved(place) if near else None
