"""Parts that follow a periodic profile of theta = Omega t: forces, moving bases, varying springs."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value
from symbolic.parts.mechanics.ends import deflection, resist
from symbolic.parts.mechanics.profiles import Profile, excited_by


@dataclass(frozen=True)
class PeriodicForce(Part):
    """Force that follows a profile: F(theta), theta = Omega t.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    profile : Profile
        F in N: a Fourier series, or samples as measured.
    frequency : float or Parameter
        Omega in rad/s; a bare number becomes the parameter Omega.
    """

    q: Coordinate
    profile: Profile
    frequency: Value = 1.0

    def contribute(self, assembly: Assembly) -> None:
        """Add F(theta)."""
        assembly.motion(self.q).force += excited_by(assembly, self.profile, self.frequency).value


@dataclass(frozen=True)
class BaseMotion(Part):
    """Spring and damper to a moving base: force -k (q - r) - c d(q - r)/dt, r = r(theta), theta = Omega t.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    motion : Profile
        r, in the unit of q.
    k : float or Parameter
        k in N/m.
    c : float or Parameter
        c in N s/m.
    frequency : float or Parameter
        Omega in rad/s; a bare number becomes the parameter Omega.
    """

    q: Coordinate
    motion: Profile
    k: Value
    c: Value = 0.0
    frequency: Value = 1.0

    def contribute(self, assembly: Assembly) -> None:
        """Add the force; dr/dt = Omega dr/dtheta."""
        k = assembly.parameter(self.k, "base_stiffness", "N/m")
        c = assembly.parameter(self.c, "base_damping", "N s/m")
        base = excited_by(assembly, self.motion, self.frequency)
        rate = assembly.parameter(self.frequency, "Omega", "rad/s") * base.slope
        motion = assembly.motion(self.q)
        motion.force -= k * (motion.position.symbol - base.value) + c * (assembly.speed_of(self.q) - rate)


@dataclass(frozen=True)
class VaryingSpring(Part):
    """Spring of periodic stiffness: force -k (1 + s(theta)) (q - r), theta = Omega t.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k : float or Parameter
        k in N/m, the mean stiffness, which a system without excitation keeps.
    variation : Profile
        s, of mean 0.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.
    frequency : float or Parameter
        Omega in rad/s; a bare number becomes the parameter Omega.
    """

    q: Coordinate
    k: Value
    variation: Profile
    to: Coordinate | None = None
    frequency: Value = 1.0

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        k = assembly.parameter(self.k, "k_v", "N/m")
        varied = 1 + excited_by(assembly, self.variation, self.frequency).value
        resist(assembly, self.q, self.to, k * varied * deflection(assembly, self.q, self.to))
