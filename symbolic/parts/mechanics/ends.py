"""The two ends of a spring or damper: a coordinate q, and another coordinate or the ground."""

from __future__ import annotations

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Coordinate, apart


def deflection(assembly: Assembly, q: Coordinate, to: Coordinate | None) -> ca.SX:
    """Return u = q - r, or q where there is no r. Raises ValueError where both are one."""
    apart("to", q, to)
    own = assembly.motion(q).position.symbol
    return own if to is None else own - assembly.motion(to).position.symbol


def speed(assembly: Assembly, q: Coordinate, to: Coordinate | None) -> ca.SX:
    """Return du/dt. Raises ValueError where both ends are one."""
    apart("to", q, to)
    own = assembly.speed_of(q)
    return own if to is None else own - assembly.speed_of(to)


def resist(assembly: Assembly, q: Coordinate, to: Coordinate | None, force: ca.SX) -> None:
    """Let a force act against u: -force on q, +force on r."""
    assembly.motion(q).force -= force
    if to is not None:
        assembly.motion(to).force += force


def kink(assembly: Assembly, q: Coordinate, to: Coordinate | None, what: str, past: ca.SX) -> None:
    """Declare that the force has a kink where `past` passes zero."""
    between = q.name if to is None else f"{q.name} - {to.name}"
    assembly.switch(f"{between} = {what}", past / assembly.motion(q).position.scale, 0)
