"""Damping that grows with the cube of the speed."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value
from symbolic.parts.mechanics.ends import resist, speed


@dataclass(frozen=True)
class CubicDamper(Part):
    """Cubic damper: force -d3 (dq/dt - dr/dt)^3.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    d3 : float or Parameter
        d3 in N s^3/m^3.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.
    """

    q: Coordinate
    d3: Value
    to: Coordinate | None = None

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        d3 = assembly.parameter(self.d3, "d3", "N s^3/m^3")
        resist(assembly, self.q, self.to, d3 * speed(assembly, self.q, self.to) ** 3)
