"""Unbalance: a mass off the axis, which turns with the rotor."""

from __future__ import annotations

import math
from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, apart
from symbolic.sketch import at


@dataclass(frozen=True)
class Unbalance(Part):
    """Unbalance: force m e Omega^2 (cos(Omega t + phi), sin(Omega t + phi)).

    Parameters
    ----------
    x, y : Coordinate
        Displacements of the rotor.
    m : float or Parameter
        Mass of the rotor in kg.
    eccentricity : float or Parameter
        e in m.
    speed : float or Parameter
        Omega in rad/s.
    angle : float or Parameter
        phi in rad, of the heavy side at t = 0.

    Raises
    ------
    ValueError
        For one coordinate in both directions.
    """

    x: Coordinate
    y: Coordinate
    m: Value
    eccentricity: Value
    speed: Value = 1.0
    angle: Value = 0.0

    def __post_init__(self) -> None:
        apart("y", self.x, self.y)

    def contribute(self, assembly: Assembly) -> None:
        """Add the forces and set the frequency of the excitation."""
        m = assembly.parameter(self.m, "m", "kg", NOT_NEGATIVE)
        e = assembly.parameter(self.eccentricity, "e", self.x.unit)
        omega = assembly.parameter(self.speed, "speed", "rad/s")
        phi = assembly.parameter(self.angle, "unbalance_angle", "rad")
        assembly.excite(omega)
        assembly.sketch.rotor(self.x, self.y)
        centre = {"x": at(0, self.x), "y": at(0, self.y)}
        start, of = assembly.nominal(phi), (self.x, self.y)
        assembly.sketch.draw(
            "disc", of, **centre, size=at(0.08), arm=0.42, start=start, turn=1.0, look="mark"
        )
        size = m * e * omega**2
        assembly.motion(self.x).force += size * assembly.harmonic(1, phi)
        assembly.motion(self.y).force += size * assembly.harmonic(1, phi - math.pi / 2)
