"""A stop that takes energy from what strikes it, more the deeper it is pressed."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value
from symbolic.parts.contact.law import ContactLaw, lawful


@dataclass(frozen=True)
class HuntCrossleyStop(Part):
    """Stop with the damping of Hunt and Crossley: force -F(q - gap) (1 + chi dq/dt) beyond the gap.

    Load and damping begin and end together, so that the force does not jump at the touch. At an approach v
    the coefficient of restitution is about 1 - (2/3) chi v. The stop would pull at dq/dt < -1/chi; a body
    that rebounds does not get there.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    law : ContactLaw
        F.
    gap : float or Parameter
        Clearance in the unit of q; negative where the stop is pressed at q = 0.
    dissipation : float or Parameter
        chi in s/m.

    References
    ----------
    .. [1] K. H. Hunt, F. R. E. Crossley, Trans. ASME J. Appl. Mech. 42 (1975) 440-445.
    """

    q: Coordinate
    law: ContactLaw
    gap: Value = 0.0
    dissipation: Value = 0.0

    def __post_init__(self) -> None:
        lawful(self.law)

    def contribute(self, assembly: Assembly) -> None:
        """Subtract the force of the stop."""
        motion = assembly.motion(self.q)
        deflection = motion.position.symbol - assembly.parameter(self.gap, "gap", self.q.unit)
        chi = assembly.parameter(self.dissipation, "dissipation", "s/m")
        motion.force -= self.law.load(assembly, deflection) * (1 + chi * assembly.speed_of(self.q))
        assembly.switch(f"{self.q.name} = gap", deflection / motion.position.scale, 0)
