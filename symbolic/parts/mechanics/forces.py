"""Forces on a coordinate."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.excitation import Order
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value


@dataclass(frozen=True)
class HarmonicForce(Part):
    """Excitation F cos(r Omega t + phi).

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    force : float or Parameter
        Amplitude F in N.
    frequency : float or Parameter
        Omega in rad/s; a bare number becomes the parameter Omega.
    order : int, float, str or Fraction
        r, a positive rational number; text as "1/2".
    phase : float or Parameter
        phi in rad.
    """

    q: Coordinate
    force: Value
    frequency: Value = 1.0
    order: Order = 1
    phase: Value = 0.0

    def contribute(self, assembly: Assembly) -> None:
        """Add F cos(r theta + phi) and set the frequency of the excitation."""
        amplitude = assembly.parameter(self.force, "F", "N")
        assembly.excite(assembly.parameter(self.frequency, "Omega", "rad/s"))
        turned = self.phase != 0.0
        phase = assembly.parameter(self.phase, "phi", "rad") if turned else ca.SX(0)
        assembly.motion(self.q).force += amplitude * assembly.harmonic(self.order, phase)


@dataclass(frozen=True)
class ConstantForce(Part):
    """Static load F_m.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    force : float or Parameter
        F_m in N.
    """

    q: Coordinate
    force: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add F_m."""
        assembly.motion(self.q).force += assembly.parameter(self.force, "F_m", "N")
