"""The requested tolerance: one number, and what follows from it for orbits and for Newton's iteration."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from periodic.checks import number
from periodic.correction.newton import NewtonSettings

FINEST, COARSEST = 1e-11, 1e-2
"""Bounds of a requested tolerance."""

MULTIPLIER_SHARE = 1e-4
"""Distance from an orbit, in tolerances, within which its multipliers are computed."""


class Accuracy(float, Enum):
    """Named tolerances of the motion, places of folds and multipliers."""

    DRAFT = 1e-4
    STANDARD = 1e-6
    FINE = 1e-9


@dataclass(frozen=True, kw_only=True)
class Tolerance:
    """How accurate orbits are to be.

    Parameters
    ----------
    orbit : float
        Bound of an orbit's error estimate, relative, from 1e-13 to 0.1.
    newton : NewtonSettings
        When Newton's iteration is converged.
    """

    orbit: float = 1e-7
    newton: NewtonSettings = NewtonSettings()

    def __post_init__(self) -> None:
        if not isinstance(self.newton, NewtonSettings):
            raise ValueError(f"newton is {self.newton!r}; it must be NewtonSettings(...)")
        if not 1e-13 <= number("tolerance", self.orbit) <= 1e-1:
            raise ValueError(f"tolerance is {self.orbit}; it must lie between 1e-13 and 0.1")

    @classmethod
    def of(cls, tol: float | Tolerance) -> Tolerance:
        """Return the tolerances that bring the motion, places of folds and multipliers to a relative `tol`.

        Parameters
        ----------
        tol : float or Tolerance
            The relative tolerance; a Tolerance is returned as it is.

        Returns
        -------
        Tolerance
            Bounds of orbits and of Newton's iteration.

        Raises
        ------
        ValueError
            Unless 1e-11 <= tol <= 1e-2.
        """
        if isinstance(tol, cls):
            return tol
        if isinstance(tol, bool) or not isinstance(tol, int | float | np.number):
            raise ValueError(f"tol is {tol!r}; it must be a number between {FINEST:g} and {COARSEST:g}")
        orbit = float(tol)
        if not FINEST <= orbit <= COARSEST:
            raise ValueError(f"tol is {orbit}; it must lie between {FINEST:g} and {COARSEST:g}")
        increment = max(1e-2 * orbit, 1e-10) ** 0.75
        newton = NewtonSettings(
            tolerance=increment, close=MULTIPLIER_SHARE * orbit / increment, max_iterations=16
        )
        return cls(orbit=orbit, newton=newton)
