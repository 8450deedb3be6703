"""The elastic contact of a cylinder along a line."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.contact.law import ContactLaw
from symbolic.parts.contact.preloaded import PowerLaw, Preloaded

STEEL = 8.06e10
"""N/m^2: load/(length^(8/9) deflection^(10/9)) of steel on steel."""

EXPONENT = 10 / 9


@dataclass(frozen=True)
class PalmgrenLaw(ContactLaw):
    """Palmgren's law for steel cylinders, W = 8.06e10 N/m^2 l^(8/9) max(delta, 0)^(10/9).

    Lundberg and Palmgren fitted 10/9 to the contact of rollers, for which Hertz' theory of lines gives no
    deflection of its own.

    Parameters
    ----------
    length : float or Parameter
        Length l of the line in m.

    References
    ----------
    .. [1] T. A. Harris, Rolling Bearing Analysis, 4th ed., Wiley 2001, sec. 6.7.
    """

    length: Value

    def load(self, assembly: Assembly, deflection: ca.SX) -> ca.SX:
        """Return W in N."""
        return self._stiffness(assembly) * ca.fmax(deflection, 1e-300) ** EXPONENT

    def preloaded(self, assembly: Assembly, preload: ca.SX) -> Preloaded:
        """Return (delta/delta0)^(10/9), delta0 = (Q/K)^(9/10)."""
        return PowerLaw((preload / self._stiffness(assembly)) ** (1 / EXPONENT), ca.SX(EXPONENT))

    def _stiffness(self, assembly: Assembly) -> ca.SX:
        return STEEL * assembly.parameter(self.length, "length", "m") ** (8 / 9)
