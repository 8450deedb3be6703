"""Inertia, springs, dampers and forces on a coordinate q, and springs and dampers between two."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.assembly import Assembly
from symbolic.model import Part
from symbolic.variables import Coordinate, Value


@dataclass(frozen=True)
class Mass(Part):
    """Inertia: m d2q/dt2 on the left of the equation of motion. m in kg."""

    q: Coordinate
    m: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add m to the coordinate's mass."""
        assembly.motion(self.q).mass += assembly.parameter(self.m, "m", "kg")


@dataclass(frozen=True)
class ReducedMass(Part):
    """Inertia of the relative motion of two free bodies: m1 m2 / (m1 + m2), in kg."""

    q: Coordinate
    m1: Value
    m2: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add the reduced mass to the coordinate's mass."""
        m1 = assembly.parameter(self.m1, "m1", "kg")
        m2 = assembly.parameter(self.m2, "m2", "kg")
        assembly.motion(self.q).mass += m1 * m2 / (m1 + m2)


@dataclass(frozen=True)
class Spring(Part):
    """Linear spring to ground: force -k q. k in N/m."""

    q: Coordinate
    k: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add -k q."""
        motion = assembly.motion(self.q)
        motion.force -= assembly.parameter(self.k, "k", "N/m") * motion.position.symbol


@dataclass(frozen=True)
class CubicSpring(Part):
    """Cubic spring to ground: force -k3 q^3. k3 in N/m^3."""

    q: Coordinate
    k3: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add -k3 q^3."""
        motion = assembly.motion(self.q)
        motion.force -= assembly.parameter(self.k3, "k3", "N/m^3") * motion.position.symbol**3


@dataclass(frozen=True)
class Damper(Part):
    """Viscous damper to ground: force -c dq/dt. c in N s/m."""

    q: Coordinate
    c: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add -c dq/dt."""
        damping = assembly.parameter(self.c, "c", "N s/m")
        assembly.motion(self.q).force -= damping * assembly.speed_of(self.q)


@dataclass(frozen=True)
class Coupling(Part):
    """Spring and damper between coordinates: force -(k (q - r) + c d(q - r)/dt)/n on q, its opposite on r.

    k in N/m, c in N s/m. `in_series` = n such couplings one after another share the deflection q - r: n = 2
    where q and r are sums over two equal sides, each with a coupling of its own.
    """

    q: Coordinate
    r: Coordinate
    k: Value
    c: Value = 0.0
    in_series: int = 1

    def contribute(self, assembly: Assembly) -> None:
        """Add the force to both coordinates."""
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
    """Spring and damper to ground: force -(k q + c dq/dt)/n. k in N/m, c in N s/m.

    `in_series` = n as in `Coupling`: 2 where q is the sum over two equal sides, each on a support of its own.
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


@dataclass(frozen=True)
class HarmonicForce(Part):
    """Excitation F cos(Omega t). F in N, Omega in rad/s (a parameter named Omega unless one is given)."""

    q: Coordinate
    force: Value
    frequency: Value = 1.0

    def contribute(self, assembly: Assembly) -> None:
        """Add F cos(tau) and set the frequency of the excitation."""
        amplitude = assembly.parameter(self.force, "F", "N")
        assembly.excite(assembly.parameter(self.frequency, "Omega", "rad/s"))
        assembly.motion(self.q).force += amplitude * assembly.cosine
