"""What presses the bodies of a contact together, resists their approach and damps it."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Value
from symbolic.parts.contact.law import ContactLaw, HertzLaw
from symbolic.parts.contact.pair import ContactPair, junction_of


@dataclass(frozen=True)
class Preload(Part):
    """Constant force Q that presses the bodies of the pair together.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    force : float or Parameter
        Q in N.
    """

    pair: ContactPair
    force: Value

    def contribute(self, assembly: Assembly) -> None:
        """Set Q."""
        junction_of(assembly, self.pair).preload = assembly.parameter(self.force, "preload", "N")


@dataclass(frozen=True)
class ElasticContact(Part):
    """Elastic contact of any law, W = F(delta).

    Parameters
    ----------
    pair : ContactPair
        The contact.
    law : ContactLaw
        F.
    """

    pair: ContactPair
    law: ContactLaw

    def contribute(self, assembly: Assembly) -> None:
        """Set the law."""
        # For the place of its parameters: among those of the other parts.
        self.law.load(assembly, ca.SX.sym("deflection"))
        junction_of(assembly, self.pair).law = self.law


@dataclass(frozen=True)
class Hertz(Part):
    """Elastic contact W = K delta^n; see `HertzLaw`.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    stiffness : float or Parameter
        K in N/m^n.
    exponent : float or Parameter
        n, 3/2 by Hertz.
    """

    pair: ContactPair
    stiffness: Value
    exponent: Value = 1.5

    def contribute(self, assembly: Assembly) -> None:
        """Set the law."""
        ElasticContact(self.pair, HertzLaw(self.stiffness, self.exponent)).contribute(assembly)


@dataclass(frozen=True)
class ContactDamping(Part):
    """Viscous damping of the contact's approach, always acting: force 2 zeta omega0 mu dX/dt.

    omega0 is the linear frequency of the dry contact under the preload, mu the bodies' reduced mass; per
    unit mu this is the damper 2 zeta omega0 dX/dt of the impacting-Hertz literature.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    ratio : float or Parameter
        zeta.
    """

    pair: ContactPair
    ratio: Value

    def contribute(self, assembly: Assembly) -> None:
        """Set zeta."""
        junction_of(assembly, self.pair).damping_ratio = assembly.parameter(self.ratio, "damping_ratio")
