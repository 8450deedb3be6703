"""A stop on a coordinate: the law of a contact used as a spring that acts on one side only."""

from __future__ import annotations

from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value
from symbolic.parts.contact.law import ContactLaw, lawful


@dataclass(frozen=True)
class Stop(Part):
    """Elastic stop beyond a clearance: force -F(q - gap), with a kink in time where q = gap.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    law : ContactLaw
        F.
    gap : float or Parameter
        Clearance in the unit of q; negative where the stop is pressed at q = 0.
    """

    q: Coordinate
    law: ContactLaw
    gap: Value = 0.0

    def __post_init__(self) -> None:
        lawful(self.law)

    def contribute(self, assembly: Assembly) -> None:
        """Subtract the load of the stop."""
        motion = assembly.motion(self.q)
        gap = assembly.parameter(self.gap, "gap", self.q.unit)
        deflection = motion.position.symbol - gap
        assembly.sketch.wall(self.q, gap, 1)
        motion.force -= self.law.load(assembly, deflection)
        assembly.switch(f"{self.q.name} = gap", deflection / motion.position.scale, 0)
