"""Dry friction that sticks: the force jumps with the sign of the speed."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value
from symbolic.parts.friction.load import NormalLoad, check_limit, limit_of
from symbolic.parts.mechanics.ends import deflection, resist, speed


@dataclass(frozen=True)
class CoulombFriction(Part):
    """Friction of Coulomb between a coordinate and the ground, or another coordinate: -F sign(du/dt).

    Where u = q - r comes to rest and less than F holds it, it sticks until the force needed exceeds F; both
    are events of the motion, and multipliers are right through them.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    force : float, Parameter or NormalLoad
        F in N: coefficient of friction times normal force.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.

    Raises
    ------
    ValueError
        For a negative force.
    """

    q: Coordinate
    force: Value | NormalLoad
    to: Coordinate | None = None

    def __post_init__(self) -> None:
        check_limit("friction force", self.force)

    def contribute(self, assembly: Assembly) -> None:
        """Add the force, with a jump where the speed passes zero."""
        force = limit_of(assembly, self.force, "F_f")
        rate = speed(assembly, self.q, self.to)
        resist(assembly, self.q, self.to, force * ca.sign(rate))
        size = assembly.motion(self.q).position.scale
        scale = assembly.omega * size
        between = self.q.name if self.to is None else f"({self.q.name} - {self.to.name})"
        if f"d{between}/dt = 0" not in [info.name for info, _ in assembly.switches]:
            held = deflection(assembly, self.q, self.to)
            assembly.holds(between.strip("()"), held, size, self.q.unit)
            assembly.switch(f"d{between}/dt = 0", rate / scale, 0)
