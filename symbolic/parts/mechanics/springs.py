"""Springs and dampers on a coordinate q, to ground or to another coordinate."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, apart
from symbolic.parts.mechanics.ends import deflection, resist, speed


@dataclass(frozen=True)
class Spring(Part):
    """Linear spring: force -k (q - r).

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k : float or Parameter
        k in N/m.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.
    """

    q: Coordinate
    k: Value
    to: Coordinate | None = None

    def contribute(self, assembly: Assembly) -> None:
        """Add -k (q - r)."""
        k = assembly.parameter(self.k, "k", "N/m")
        resist(assembly, self.q, self.to, k * deflection(assembly, self.q, self.to))


@dataclass(frozen=True)
class CubicSpring(Part):
    """Cubic spring: force -k3 (q - r)^3.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k3 : float or Parameter
        k3 in N/m^3.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.
    """

    q: Coordinate
    k3: Value
    to: Coordinate | None = None

    def contribute(self, assembly: Assembly) -> None:
        """Add -k3 (q - r)^3."""
        k3 = assembly.parameter(self.k3, "k3", "N/m^3")
        resist(assembly, self.q, self.to, k3 * deflection(assembly, self.q, self.to) ** 3)


@dataclass(frozen=True)
class Damper(Part):
    """Viscous damper: force -c d(q - r)/dt.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    c : float or Parameter
        c in N s/m.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.
    """

    q: Coordinate
    c: Value
    to: Coordinate | None = None

    def contribute(self, assembly: Assembly) -> None:
        """Add -c d(q - r)/dt."""
        c = assembly.parameter(self.c, "c", "N s/m")
        resist(assembly, self.q, self.to, c * speed(assembly, self.q, self.to))


@dataclass(frozen=True)
class Coupling(Part):
    """Spring and damper between coordinates: force -(k (q - r) + c d(q - r)/dt)/n on q, its opposite on r.

    Parameters
    ----------
    q, r : Coordinate
        The coordinates.
    k : float or Parameter
        k in N/m.
    c : float or Parameter
        c in N s/m.
    in_series : int
        n couplings one after another share the deflection q - r: 2 where q and r are sums over two equal
        sides, each with a coupling of its own.
    """

    q: Coordinate
    r: Coordinate
    k: Value
    c: Value = 0.0
    in_series: int = 1

    def contribute(self, assembly: Assembly) -> None:
        """Add the force to both coordinates."""
        apart("r", self.q, self.r)
        q, r = assembly.motion(self.q), assembly.motion(self.r)
        k = assembly.parameter(self.k, "coupling_stiffness", "N/m")
        c = assembly.parameter(self.c, "coupling_damping", "N s/m")
        deflection = q.position.symbol - r.position.symbol
        rate = assembly.speed_of(self.q) - assembly.speed_of(self.r)
        force = (k * deflection + c * rate) / self.in_series
        q.force -= force
        r.force += force


@dataclass(frozen=True)
class Support(Part):
    """Spring and damper to ground: force -(k q + c dq/dt)/n.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k : float or Parameter
        k in N/m.
    c : float or Parameter
        c in N s/m.
    in_series : int
        n as in `Coupling`: 2 where q is the sum over two equal sides, each on a support of its own.
    """

    q: Coordinate
    k: Value
    c: Value = 0.0
    in_series: int = 1

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        motion = assembly.motion(self.q)
        k = assembly.parameter(self.k, "support_stiffness", "N/m")
        c = assembly.parameter(self.c, "support_damping", "N s/m")
        motion.force -= (k * motion.position.symbol + c * assembly.speed_of(self.q)) / self.in_series
