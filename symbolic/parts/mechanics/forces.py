"""Forces on a coordinate."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value


@dataclass(frozen=True)
class HarmonicForce(Part):
    """Excitation F cos(Omega t).

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    force : float or Parameter
        Amplitude F in N.
    frequency : float or Parameter
        Omega in rad/s; a bare number becomes the parameter Omega.
    """

    q: Coordinate
    force: Value
    frequency: Value = 1.0

    def contribute(self, assembly: Assembly) -> None:
        """Add F cos(tau) and set the frequency of the excitation."""
        amplitude = assembly.parameter(self.force, "F", "N")
        assembly.excite(assembly.parameter(self.frequency, "Omega", "rad/s"))
        assembly.motion(self.q).force += amplitude * assembly.cosine
