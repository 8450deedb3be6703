"""A rigid stop on a coordinate: an impact of no duration, with a coefficient of restitution."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.checks import refusal, typed
from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Parameter, Value


@dataclass(frozen=True)
class RigidStop(Part):
    """Wall that a coordinate does not pass: q <= gap, and dq/dt becomes -e dq/dt where q arrives at the gap.

    Coordinates that inertia couples to q, as in a structure, get what the wall's impulse gives them: with the
    mass matrix M and the unit vector n of q the impulse is J = (1 + e) v / (n M^-1 n), v the speed before it,
    and all speeds change by -M^-1 n J. At a node of finite elements 1/(n M^-1 n) is the mass of about one
    element. It goes to zero as these get shorter: then it tells of the model, not of the beam.

    Pressed to the wall q bounces ever lower, without number in finite time, and then rests on it. Not where
    friction jumps on q, or on a coordinate that inertia couples to it: there the bounces go on without end.

    A structure in the model keeps all its states (`symbolic.compile`).

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    gap : float or Parameter
        Where the wall is, in the unit of q.
    restitution : float or Parameter
        e, greater than 0 and up to 1 (Newton's law of impact).
    below : bool
        Whether the wall is on the other side, q >= -gap.

    Raises
    ------
    ValueError
        For a restitution out of range; on compilation, for a wall behind which the search for a rest begins.
    """

    q: Coordinate
    gap: Value
    restitution: Value
    below: bool = False

    def __post_init__(self) -> None:
        given = self.restitution
        value = given.value if isinstance(given, Parameter) else given
        typed("below", self.below, bool, "True or False")
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value <= 1:
            raise refusal("restitution", value, "a number greater than 0 and up to 1")

    def contribute(self, assembly: Assembly) -> None:
        """Add the impact."""
        motion = assembly.motion(self.q)
        gap = assembly.parameter(self.gap, "gap", self.q.unit)
        e = assembly.parameter(self.restitution, "restitution")
        side, which = (-1, "-gap") if self.below else (1, "gap")
        free = (gap - side * motion.position.symbol) / motion.position.scale
        after = -e * motion.velocity.symbol
        assembly.impact(f"impact at {self.q.name} = {which}", free, motion, after)
        assembly.sketch.wall(self.q, gap, side)
        before = Before(self, gap)
        assembly.joints[before] = before


@dataclass(frozen=True, eq=False)
class Before:
    """The search for a rest begins before the wall."""

    stop: RigidStop
    gap: ca.SX

    def close(self, assembly: Assembly) -> None:
        """Check it. Raises ValueError."""
        q, side = self.stop.q, -1 if self.stop.below else 1
        rest = assembly.nominal(assembly.motion(q).position.rest)
        if side * rest >= assembly.nominal(self.gap):
            wall = side * assembly.nominal(self.gap)
            raise ValueError(
                f"the rigid stop at {q.name} = {wall:g} leaves no equilibrium: the search for one begins "
                f"behind it, at {q.name} = {rest:g}; move it, or give the coordinate a start before it"
            )
