"""Springs that act beyond a clearance only; u = q - r is their deflection, r = 0 on the ground."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import casadi as ca

from symbolic.checks import finite, refusal, typed
from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Parameter, Value, not_negative
from symbolic.parts.mechanics.ends import deflection, kink, resist
from symbolic.parts.mechanics.profiles import Profile, excited_by


@dataclass(frozen=True)
class OneSidedSpring(Part):
    """Spring that pushes beyond a gap: force -k max(u - gap, 0), or k max(-u - gap, 0) from below.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k : float or Parameter
        k in N/m.
    gap : float or Parameter
        In the unit of q; negative where the spring is pressed at u = 0.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.
    below : bool
        Whether the spring is on the side of negative u.

    Raises
    ------
    ValueError
        For a negative stiffness.
    """

    q: Coordinate
    k: Value
    gap: Value = 0.0
    to: Coordinate | None = None
    below: bool = False

    def __post_init__(self) -> None:
        not_negative("stiffness k", self.k)
        typed("below", self.below, bool, "True or False")

    def contribute(self, assembly: Assembly) -> None:
        """Add the force, with a kink where u passes the gap."""
        k = assembly.parameter(self.k, "k_s", "N/m", NOT_NEGATIVE)
        gap = assembly.parameter(self.gap, "gap", self.q.unit)
        side = -1 if self.below else 1
        if self.to is None:
            assembly.sketch.wall(self.q, gap, side)
        past = side * deflection(assembly, self.q, self.to) - gap
        resist(assembly, self.q, self.to, side * k * ca.fmax(past, 0))
        kink(assembly, self.q, self.to, "-gap" if self.below else "gap", past)


@dataclass(frozen=True)
class Gap(Part):
    """Play between two stops: force -k (max(u - upper, 0) + min(u - lower, 0)).

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k : float or Parameter
        k in N/m.
    lower, upper : float or Parameter
        Where the stops are, in the unit of q.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.

    Raises
    ------
    ValueError
        For a negative stiffness, and for stops that overlap.
    """

    EXAMPLE: ClassVar[Mapping[str, object]] = {"lower": -0.1, "upper": 0.1}
    q: Coordinate
    k: Value
    lower: Value
    upper: Value
    to: Coordinate | None = None

    def __post_init__(self) -> None:
        not_negative("stiffness k", self.k)
        stops = (("lower", self.lower), ("upper", self.upper))
        lower, upper = (finite(f"{n} stop", v.value if isinstance(v, Parameter) else v) for n, v in stops)
        if not lower < upper:
            raise refusal("upper stop of a Gap", upper, f"above the lower stop {lower:g}, or the two overlap")

    def contribute(self, assembly: Assembly) -> None:
        """Add the force, with a kink at each stop."""
        k = assembly.parameter(self.k, "k_g", "N/m", NOT_NEGATIVE)
        lower = assembly.parameter(self.lower, "lower", self.q.unit)
        upper = assembly.parameter(self.upper, "upper", self.q.unit)
        u = deflection(assembly, self.q, self.to)
        resist(assembly, self.q, self.to, k * (ca.fmax(u - upper, 0) + ca.fmin(u - lower, 0)))
        kink(assembly, self.q, self.to, "upper", u - upper)
        kink(assembly, self.q, self.to, "lower", u - lower)


@dataclass(frozen=True)
class Backlash(Part):
    """Spring with backlash: force -k (1 + s(theta)) (max(u - b, 0) + min(u + b, 0)), theta = Omega t.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k : float or Parameter
        k in N/m, the mean of a stiffness that varies.
    b : float or Parameter
        Half the backlash, in the unit of q.
    to : Coordinate, optional
        The coordinate r at the other end; the ground, r = 0, where there is none.
    variation : Profile, optional
        s, of mean 0; none where the stiffness is constant.
    frequency : float or Parameter
        Omega in rad/s, where there is a variation.

    Raises
    ------
    ValueError
        For a negative stiffness or backlash.

    References
    ----------
    Kahraman & Singh, Journal of Sound and Vibration 146 (1991), 135-156.
    """

    q: Coordinate
    k: Value
    b: Value
    to: Coordinate | None = None
    variation: Profile | None = None
    frequency: Value = 1.0

    def __post_init__(self) -> None:
        not_negative("stiffness k", self.k)
        not_negative("half backlash b", self.b)

    def contribute(self, assembly: Assembly) -> None:
        """Add the force, with a kink at each end of the backlash."""
        k = assembly.parameter(self.k, "k_b", "N/m", NOT_NEGATIVE)
        b = assembly.parameter(self.b, "b", self.q.unit, NOT_NEGATIVE)
        if self.variation is not None:
            k *= 1 + excited_by(assembly, self.variation, self.frequency).value
        if self.to is None:
            assembly.sketch.wall(self.q, b, 1)
            assembly.sketch.wall(self.q, b, -1)
        u = deflection(assembly, self.q, self.to)
        resist(assembly, self.q, self.to, k * (ca.fmax(u - b, 0) + ca.fmin(u + b, 0)))
        kink(assembly, self.q, self.to, "b", u - b)
        kink(assembly, self.q, self.to, "-b", u + b)
