"""The law of a contact: its load as a function of how far the bodies have approached each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import casadi as ca

from symbolic.checks import refusal
from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import POSITIVE
from symbolic.equations.variables import Value, above_zero
from symbolic.parts.contact.preloaded import PowerLaw, Preloaded, solved


class ContactLaw(Protocol):
    """Load W = F(delta) of a contact: all that parts, films and scenes ask of a law.

    A law is a frozen dataclass of numbers that inherits from this protocol and defines `load`. F is positive
    and rises for delta > 0, where ln F is a smooth function of ln delta; bodies that part (delta <= 0) carry
    what F says, mostly 0. A law with closed forms about the preload may define `preloaded` too.
    """

    def load(self, assembly: Assembly, deflection: ca.SX) -> ca.SX:
        """Return the load.

        Parameters
        ----------
        assembly : Assembly
            Its `parameter` makes the law's numbers parameters of the model.
        deflection : casadi.SX
            Approach delta of the bodies in m, of either sign.

        Returns
        -------
        casadi.SX
            W in N.
        """
        ...

    def preloaded(self, assembly: Assembly, preload: ca.SX) -> Preloaded:
        """Return the law about its preload, as films take it.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        preload : casadi.SX
            Q in N.

        Returns
        -------
        Preloaded
            W/Q as a function of delta/delta0, and its inverse; by default from `load`.
        """
        return solved(lambda deflection: self.load(assembly, deflection), assembly, preload)


@dataclass(frozen=True)
class HertzLaw(ContactLaw):
    """Law of Hertz, W = K max(delta, 0)^n.

    Parameters
    ----------
    stiffness : float or Parameter
        K in N/m^n.
    exponent : float or Parameter
        n: 3/2 for elliptic contacts.

    Raises
    ------
    ValueError
        For numbers that are not positive.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), section 3.
    """

    stiffness: Value
    exponent: Value = 1.5

    def __post_init__(self) -> None:
        above_zero("stiffness of a HertzLaw", self.stiffness)
        above_zero("exponent of a HertzLaw", self.exponent)

    def load(self, assembly: Assembly, deflection: ca.SX) -> ca.SX:
        """Return K max(delta, 0)^n."""
        stiffness, exponent = self._numbers(assembly)
        return stiffness * ca.fmax(deflection, 1e-300) ** exponent

    def preloaded(self, assembly: Assembly, preload: ca.SX) -> Preloaded:
        """Return (delta/delta0)^n, delta0 = (Q/K)^(1/n)."""
        stiffness, exponent = self._numbers(assembly)
        return PowerLaw((preload / stiffness) ** (1 / exponent), exponent)

    def _numbers(self, assembly: Assembly) -> tuple[ca.SX, ca.SX]:
        stiffness = assembly.parameter(self.stiffness, "stiffness", "N/m^n", POSITIVE)
        return stiffness, assembly.parameter(self.exponent, "exponent", "", POSITIVE)


def lawful(law: object) -> None:
    """Refuse what is no law of contact. Raises ValueError."""
    if not callable(getattr(law, "load", None)):
        allowed = "a ContactLaw, as HertzLaw(1e9) is; a spring beyond a gap is a OneSidedSpring"
        raise refusal("law", law, allowed)


def deflection_under(law: ContactLaw, preload: float) -> float:
    """Return the deflection (m) of a law under a preload (N), its numbers nominal; NaN where it has none."""
    assembly = Assembly()
    return assembly.nominal(law.preloaded(assembly, ca.SX(preload)).delta0)
