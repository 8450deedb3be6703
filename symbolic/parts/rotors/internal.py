"""Damping that turns with the shaft."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, apart, not_negative


@dataclass(frozen=True)
class InternalDamping(Part):
    """Damping of a turning shaft: force -c (dx/dt + Omega y, dy/dt - Omega x).

    It resists what moves against the shaft, and so drives a whirl that is slower than the shaft: beyond a
    speed the rotor is unstable.

    Parameters
    ----------
    x, y : Coordinate
        Displacements of the rotor; the shaft turns from x to y.
    c : float or Parameter
        c in N s/m.
    speed : float or Parameter
        Omega in rad/s.

    Raises
    ------
    ValueError
        For negative damping.

    References
    ----------
    Kimball, General Electric Review 27 (1924) 244-251; Genta, Dynamics of Rotating Systems, Springer 2005,
    section 2.4.
    """

    x: Coordinate
    y: Coordinate
    c: Value
    speed: Value = 1.0

    def __post_init__(self) -> None:
        apart("y", self.x, self.y)
        not_negative("internal damping c", self.c)

    def contribute(self, assembly: Assembly) -> None:
        """Add the forces."""
        c = assembly.parameter(self.c, "c_internal", "N s/m", NOT_NEGATIVE)
        omega = assembly.parameter(self.speed, "speed", "rad/s")
        x, y = assembly.motion(self.x), assembly.motion(self.y)
        x.force -= c * (assembly.speed_of(self.x) + omega * y.position.symbol)
        y.force -= c * (assembly.speed_of(self.y) - omega * x.position.symbol)
