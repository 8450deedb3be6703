"""The condition that holds an orbit at a grazing: curves of grazing orbits in two parameters."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from periodic.conditions.twoparameter.augmented import of_orbits
from periodic.correction.condition import Condition, Given, SideCondition
from periodic.events.sideconditions import Clearance
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import AT_LEVEL
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System


@dataclass(frozen=True)
class GrazingCondition(Condition):
    """A switch grazes its level (GR): an extremum of s(x, tau, p) over the period lies on it.

    The orbit has no event node at the grazing, as the GR point of a branch that it is traced from.

    Parameters
    ----------
    switch : str
        Name of the switch.
    """

    switch: str

    def check(self, system: System, parameter: Array) -> None:
        """Refuse a switch that the system does not have."""
        index_of_switch(system, self.switch)

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition near an orbit. Raises ValueError for an equilibrium."""
        of_orbits(self, origin)
        return _Grazing(self.switch)


def index_of_switch(system: System, name: str) -> int:
    """Return the index of a switch. Raises ValueError for a name that is none."""
    names = [switch.name for switch in system.switches]
    if name not in names:
        known = ", ".join(names) or "none, as the system has no switches"
        raise ValueError(f"switch is {name!r}; it must be one of {known}")
    return names.index(name)


@dataclass
class _Grazing:
    """The extremum that is nearest its level at the first orbit, then followed."""

    switch: str
    held: Clearance | None = field(default=None)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return the clearance, less what is left of it, and its gradient."""
        k = index_of_switch(system, self.switch)
        dense = SwitchPolynomials(system, orbit)
        if self.held is None:
            both = [(side, e) for side in (-1, 1) for e in dense.minima(k, side)]
            if not both:
                raise FloatingPointError(f"{self.switch} has no extremum in this motion")
            side, extremum = min(both, key=lambda pair: abs(pair[1].value))
            self.held = Clearance(k, side, extremum.phase)
        row = self.held.linearise(system, orbit, free)
        left = AT_LEVEL * float(np.abs(dense.knots[:, :, k]).max())
        return Row(row.value - left, row.nodes, row.outer, row.stages)
