"""Inertia of coordinates."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, not_negative


@dataclass(frozen=True)
class Mass(Part):
    """Inertia: m d2q/dt2 on the left of the equation of motion.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    m : float or Parameter
        m in kg.

    Raises
    ------
    ValueError
        For a negative mass.
    """

    q: Coordinate
    m: Value

    def __post_init__(self) -> None:
        not_negative("mass m", self.m)

    def contribute(self, assembly: Assembly) -> None:
        """Add m to the coordinate's mass."""
        assembly.motion(self.q).mass += assembly.parameter(self.m, "m", "kg", NOT_NEGATIVE)


@dataclass(frozen=True)
class ReducedMass(Part):
    """Inertia of the relative motion of two free bodies, m1 m2 / (m1 + m2).

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    m1, m2 : float or Parameter
        Masses of the bodies in kg.
    """

    q: Coordinate
    m1: Value
    m2: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add the reduced mass to the coordinate's mass."""
        m1 = assembly.parameter(self.m1, "m1", "kg", NOT_NEGATIVE)
        m2 = assembly.parameter(self.m2, "m2", "kg", NOT_NEGATIVE)
        assembly.motion(self.q).mass += m1 * m2 / (m1 + m2)
