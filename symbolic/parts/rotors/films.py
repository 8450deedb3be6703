"""Oil films about a shaft: the journal bearing, and the squeeze-film damper about a ring at rest."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import POSITIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, above_zero, apart
from symbolic.parts.rotors.shortfilm import resultant


@dataclass(frozen=True)
class JournalBearing(Part):
    """Short journal bearing, its film cavitated (half-Sommerfeld): force of Ocvirk's pressure where positive.

    Its force per clearance is mu R L^3 Omega/(2 c^2) times a function of displacement over clearance and of
    velocity over c Omega; the film drags a light shaft round at nearly half its speed.

    Parameters
    ----------
    x, y : Coordinate
        Displacements of the journal from the centre of the bearing; the shaft turns from x to y.
    viscosity : float or Parameter
        mu in Pa s.
    radius, length : float or Parameter
        R and L in m.
    clearance : float or Parameter
        c in m, radial.
    speed : float or Parameter
        Omega in rad/s.

    Raises
    ------
    ValueError
        For a number that is not positive.

    References
    ----------
    Ocvirk, NACA TN 2808 (1952); Adiletta, Guido & Rossi, Nonlinear Dynamics 10 (1996) 251-269.
    """

    x: Coordinate
    y: Coordinate
    viscosity: Value
    radius: Value
    length: Value
    clearance: Value
    speed: Value = 1.0

    def __post_init__(self) -> None:
        _positive(self)

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        omega = assembly.parameter(self.speed, "speed", "rad/s")
        _film(assembly, self, omega, omega)


@dataclass(frozen=True)
class SqueezeFilmDamper(Part):
    """Squeeze-film damper: a short cavitated film about a ring that moves but does not turn.

    Parameters
    ----------
    x, y : Coordinate
        Displacements of the ring from the centre of its housing.
    viscosity : float or Parameter
        mu in Pa s.
    radius, length : float or Parameter
        R and L in m.
    clearance : float or Parameter
        c in m, radial.

    Raises
    ------
    ValueError
        For a number that is not positive.

    References
    ----------
    Della Pietra & Adiletta, Shock and Vibration Digest 34 (2002) 3-26 and 97-126.
    """

    x: Coordinate
    y: Coordinate
    viscosity: Value
    radius: Value
    length: Value
    clearance: Value

    def __post_init__(self) -> None:
        _positive(self)

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        _film(assembly, self, ca.SX(0), assembly.omega)


def _positive(part: JournalBearing | SqueezeFilmDamper) -> None:
    apart("y", part.x, part.y)
    for name in ("viscosity", "radius", "length", "clearance"):
        above_zero(name, getattr(part, name))


def _film(assembly: Assembly, part: JournalBearing | SqueezeFilmDamper, turn: ca.SX, pace: ca.SX) -> None:
    mu = assembly.parameter(part.viscosity, "viscosity", "Pa s", POSITIVE)
    radius = assembly.parameter(part.radius, "radius", "m", POSITIVE)
    length = assembly.parameter(part.length, "length", "m", POSITIVE)
    c = assembly.parameter(part.clearance, "clearance", "m", POSITIVE)
    x, y = assembly.motion(part.x), assembly.motion(part.y)
    places = (x.position.symbol / c, y.position.symbol / c)
    rates = (assembly.speed_of(part.x) / c, assembly.speed_of(part.y) / c)
    force = resultant(*places, *rates, turn, pace)
    size = mu * radius * length**3 / (2 * c**2)
    x.force += size * force[0]
    y.force += size * force[1]
    assembly.sketch.rotor(part.x, part.y, c)
    eccentricity = ca.sqrt(places[0] ** 2 + places[1] ** 2 + 1e-30)
    assembly.output("eccentricity", "", eccentricity, shared=True)
