"""A rotor that rubs on its stator."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE, POSITIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, above_zero, apart, not_negative
from symbolic.parts.rotors.radius import radius


@dataclass(frozen=True)
class Rub(Part):
    """Contact with a ring of radial clearance g: force -N (x - mu y, y + mu x)/r, N = k max(r - g, 0).

    r = sqrt(x^2 + y^2); friction acts against the turn of the shaft, from x to y, which is faster than its
    whirl. A kink in time lies where r = g.

    Parameters
    ----------
    x, y : Coordinate
        Displacements of the rotor from the centre of the stator.
    stiffness : float or Parameter
        k of the stator in N/m.
    clearance : float or Parameter
        g in m.
    friction : float or Parameter
        Coefficient mu.

    Raises
    ------
    ValueError
        For a stiffness or friction that is negative, and a clearance that is not positive.

    References
    ----------
    Jiang & Ulbrich, Nonlinear Dynamics 24 (2001) 269-283; Choy & Padovan, J. Sound Vib. 113 (1987) 529-545.
    """

    x: Coordinate
    y: Coordinate
    stiffness: Value
    clearance: Value
    friction: Value = 0.0

    def __post_init__(self) -> None:
        apart("y", self.x, self.y)
        not_negative("stiffness of the stator", self.stiffness)
        not_negative("friction of the stator", self.friction)
        above_zero("clearance of the stator", self.clearance)

    def contribute(self, assembly: Assembly) -> None:
        """Add the forces."""
        x, y = assembly.motion(self.x), assembly.motion(self.y)
        k = assembly.parameter(self.stiffness, "k_stator", "N/m", NOT_NEGATIVE)
        g = assembly.parameter(self.clearance, "clearance", self.x.unit, POSITIVE)
        mu = assembly.parameter(self.friction, "mu", "", NOT_NEGATIVE)
        a, b = x.position.symbol, y.position.symbol
        r = radius(a, b, g)
        pressure = k * ca.fmax(r - g, 0) / r
        x.force -= pressure * (a - mu * b)
        y.force -= pressure * (b + mu * a)
        assembly.sketch.rotor(self.x, self.y, g)
        assembly.output("rub", "N", pressure * r, shared=True)
        assembly.switch("r = clearance", (r - g) / g, 0)
