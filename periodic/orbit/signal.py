"""One of an orbit's states or unknowns, or the velocity of a state, over time in SI units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from periodic.orbit.layout import Column
from periodic.orbit.scheme import Array


@dataclass(frozen=True)
class Signal:
    """A function of time: y(t) = scale * Omega^order * u(Omega t), u scaled and a function of tau.

    Parameters
    ----------
    column : Column
        Its name and unit, and where the orbit has it.
    omega : float
        Angular frequency Omega in rad/s.
    scaled : callable
        All scaled states, rates or unknowns at phases tau (K,), shape (K, columns).
    """

    column: Column
    omega: float
    scaled: Callable[[Array], Array] = field(repr=False)

    @property
    def name(self) -> str:
        """The signal's name."""
        return self.column.name

    @property
    def unit(self) -> str:
        """Its unit in SI."""
        return self.column.unit

    def __call__(self, t: ArrayLike) -> Array:
        """Return the values at times t in s, in the shape of t."""
        time = np.asarray(t, dtype=float)
        values = self.scaled(self.omega * time.ravel())[:, self.column.index]
        factor = self.column.scale * self.omega**self.column.order
        return np.asarray(factor * values.reshape(time.shape))
