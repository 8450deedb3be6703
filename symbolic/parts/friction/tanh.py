"""Friction smoothed in the speed."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE, POSITIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, above_zero, not_negative
from symbolic.parts.mechanics.ends import resist, speed


@dataclass(frozen=True)
class TanhFriction(Part):
    """Friction smoothed about rest: force -F tanh(v/v0), v = du/dt the speed of sliding.

    It creeps where Coulomb's law sticks: at F/v0 it is a damper of small speeds.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    force : float or Parameter
        F in N: coefficient of friction times normal force.
    speed : float or Parameter
        v0 in m/s, small against the speeds of sliding.
    to : Coordinate, optional
        The coordinate on which q slides, u = q - r; the ground where there is none.

    Raises
    ------
    ValueError
        For a negative force, and a speed that is not positive.

    References
    ----------
    Krack & Gross, Harmonic Balance for Nonlinear Vibration Problems, Springer 2019, section 2.2.
    """

    q: Coordinate
    force: Value
    speed: Value
    to: Coordinate | None = None

    def __post_init__(self) -> None:
        not_negative("friction force", self.force)
        above_zero("speed v0", self.speed)

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        limit = assembly.parameter(self.force, "F_f", "N", NOT_NEGATIVE)
        v0 = assembly.parameter(self.speed, "v0", "m/s", POSITIVE)
        resist(assembly, self.q, self.to, limit * ca.tanh(speed(assembly, self.q, self.to) / v0))
