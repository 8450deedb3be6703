"""The gyroscopic moment of a disc that tilts while it turns."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, apart


@dataclass(frozen=True)
class GyroscopicMoment(Part):
    """Gyroscopic moment: (-J Omega dphi_y/dt, J Omega dphi_x/dt) on the tilts about x and y.

    Parameters
    ----------
    x, y : Coordinate
        Tilts phi_x and phi_y of the disc about two axes across the shaft, in rad.
    inertia : float or Parameter
        Polar moment of inertia J in kg m^2.
    speed : float or Parameter
        Omega in rad/s.

    Raises
    ------
    ValueError
        For one coordinate in both directions.

    References
    ----------
    Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines, Cambridge 2010, section 3.3.
    """

    x: Coordinate
    y: Coordinate
    inertia: Value
    speed: Value = 1.0

    def __post_init__(self) -> None:
        apart("y", self.x, self.y)

    def contribute(self, assembly: Assembly) -> None:
        """Add the moments."""
        spin = assembly.parameter(self.inertia, "J", "kg m^2")
        spin *= assembly.parameter(self.speed, "speed", "rad/s")
        assembly.motion(self.x).force -= spin * assembly.speed_of(self.y)
        assembly.motion(self.y).force += spin * assembly.speed_of(self.x)
