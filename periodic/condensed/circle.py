"""How many Floquet multipliers lie outside a circle, from the winding of a determinant.

det K_mu (see `periodic.condensed.repeating`) vanishes at the multipliers and has its poles at those of the
linear part by itself, exp(lambda T); far from 0 it tends to a constant. Once round the circle its argument
therefore turns (poles - zeros outside) times (the argument principle).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.repeating import CondensedRepeating
from periodic.orbit.scheme import Array

FEWEST = 24
"""Intervals into which the half circle is cut first; the angles of poles near it are added."""

TURN = 0.8
"""Largest turn (rad) of the determinant's argument from one angle to the next."""

DEEPEST = 40
"""Most halvings of an interval until the determinant turns by less."""

NEAR_CIRCLE = 0.3
"""Poles whose modulus is more than this part of the radius are near the circle."""


class Beside(Protocol):
    """Linearised motions about an orbit, as `periodic.condensed.variations.CondensedVariations` has them."""

    @property
    def given(self) -> SplitLinearisation:
        """The system about the orbit, with all modes."""

    def repeating(self, multiplier: complex) -> CondensedRepeating:
        """Return the equations of the motions that are multiplied by a number."""


@dataclass(frozen=True)
class Circle:
    """The determinant round a circle about 0.

    Parameters
    ----------
    variations : Beside
        The motions beside the orbit.
    radius : float
        Radius of the circle.
    """

    variations: Beside
    radius: float = 1.0

    @property
    def poles(self) -> Array:
        """exp(lambda T) of all modes, conjugates included."""
        response = self.variations.given.response
        grown = np.exp(response.modes.exponents * response.period)
        return np.concatenate([grown, grown[response.modes.exponents.imag != 0].conj()])

    def outside(self) -> int:
        """Return how many multipliers lie outside.

        Raises FloatingPointError where one lies on the circle, to rounding.
        """
        near = self.poles[(np.abs(self.poles) > NEAR_CIRCLE * self.radius) & (self.poles.imag > 0)]
        angles = np.unique(np.concatenate([np.linspace(0, np.pi, FEWEST + 1), np.angle(near)]))
        places = [(float(angle), self._value(float(angle))) for angle in angles]
        turn = sum(self._turn(*ends, DEEPEST) for ends in pairwise(places))
        return int((np.abs(self.poles) > self.radius).sum()) - round(turn / np.pi)

    def _value(self, angle: float) -> complex:
        """The determinant over its modulus, at an angle."""
        mu = self.radius * np.exp(1j * angle)
        sign = np.linalg.slogdet(self.variations.repeating(mu).coupled.matrix)[0]
        if not np.isfinite(sign) or sign == 0:
            raise FloatingPointError(f"a multiplier lies on the circle of radius {self.radius:g}")
        return complex(sign)

    def _turn(self, begin: tuple[float, complex], end: tuple[float, complex], left: int) -> float:
        """How far the determinant's argument turns between two angles."""
        turn = float(np.angle(end[1] / begin[1]))
        if abs(turn) < TURN:
            return turn
        if left == 0:
            raise FloatingPointError(f"a multiplier lies on the circle of radius {self.radius:g}")
        angle = (begin[0] + end[0]) / 2
        middle = (angle, self._value(angle))
        return self._turn(begin, middle, left - 1) + self._turn(middle, end, left - 1)
