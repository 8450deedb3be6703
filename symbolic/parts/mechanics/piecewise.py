"""A spring whose stiffness changes at certain deflections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import casadi as ca

from symbolic.checks import refusal
from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Parameter, Value, several
from symbolic.parts.mechanics.ends import deflection, kink, resist


@dataclass(frozen=True)
class PiecewiseLinearSpring(Part):
    """Spring of stiffness k_1 up to u_1, k_2 up to u_2, ...: force -(G(u) - G(0)), u = q - r.

    G(u) = k_1 u + (k_2 - k_1) max(u - u_1, 0) + (k_3 - k_2) max(u - u_2, 0) + ...

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    stiffnesses : tuple of float or Parameter
        k_1, k_2, ... in N/m, one more than corners.
    corners : tuple of float or Parameter
        u_1 < u_2 < ... in the unit of q.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.

    Raises
    ------
    ValueError
        For corners that do not rise, or another number of stiffnesses.
    """

    EXAMPLE: ClassVar[Mapping[str, object]] = {"stiffnesses": [1.0, 2.0], "corners": [0.1]}
    q: Coordinate
    stiffnesses: tuple[Value, ...]
    corners: tuple[Value, ...]
    to: Coordinate | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "stiffnesses", several("stiffnesses", self.stiffnesses))
        object.__setattr__(self, "corners", several("corners", self.corners))
        at = [c.value if isinstance(c, Parameter) else c for c in self.corners]
        if not at or any(a >= b for a, b in zip(at, at[1:], strict=False)):
            raise refusal("corners of a PiecewiseLinearSpring", self.corners, "at least one number, rising")
        if len(self.stiffnesses) != len(at) + 1:
            allowed = f"{len(at) + 1} numbers, one more than corners"
            raise refusal("stiffnesses of a PiecewiseLinearSpring", self.stiffnesses, allowed)

    def contribute(self, assembly: Assembly) -> None:
        """Add the force, with a kink at each corner."""
        u, q = deflection(assembly, self.q, self.to), self.q
        k = [assembly.parameter(v, f"k_{i + 1}", "N/m") for i, v in enumerate(self.stiffnesses)]
        corners = [assembly.parameter(v, f"u_{i + 1}", q.unit) for i, v in enumerate(self.corners)]

        def elastic(deflection: ca.SX) -> ca.SX:
            bends = zip(k, k[1:], corners, strict=False)
            more = [(after - before) * ca.fmax(deflection - at, 0) for before, after, at in bends]
            return k[0] * deflection + sum(more, ca.SX(0))

        resist(assembly, q, self.to, elastic(u) - elastic(ca.SX(0)))
        for i, corner in enumerate(corners):
            kink(assembly, q, self.to, f"u_{i + 1}", u - corner)
