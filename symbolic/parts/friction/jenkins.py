"""The elastic slider, and several of them side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import casadi as ca

from symbolic.checks import refusal
from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import POSITIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, above_zero, apart, several
from symbolic.parts.friction.load import NormalLoad, check_limit, limit_of
from symbolic.parts.mechanics.ends import deflection, resist

CREEP = 1e-2
"""Angle (rad of the phase) in the row of an exact slider where no mode is given, as in a guess at rest."""

LEAK = 1e-4
"""Part of its force by which a stuck slider yields, per rad of the phase: else its place is anything."""


@dataclass(frozen=True)
class Jenkins(Part):
    """Elastic slider: force -f, f = k (u - z), a spring in series with a slider that gives way at F.

        dz/dtau = 0 while it is held, -F < f < F;  f = F or -F while it is carried, until du/dtau turns

    One state z, the place of the slider, and two events in each slip, where it begins and where it ends. A
    slider that never slips may stick anywhere: a parameter "place of z" says where.

    With creep it is smooth but for kinks, and may be followed where modes are not, as by harmonic balance:

        k dz/dtau = (max(f - F, 0) + min(f + F, 0))/creep + LEAK f

    It then comes to slip within the angle `creep` of the phase: f exceeds F by creep k du/dtau, at any
    frequency (its loops do not depend on the rate, as Coulomb's do not). That is an error of the model, which
    no estimate of the orbit sees: 1e-2 takes 2.4 % of the peak of a resonance that sliders damp. The leak of
    1e-4 per rad lets a stuck slider settle where its mean force is 0.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    stiffness : float or Parameter
        k in N/m.
    limit : float, Parameter or NormalLoad
        F in N: coefficient of friction times normal force.
    to : Coordinate, optional
        The coordinate r at the other end, u = q - r; the ground where there is none.
    creep : float or Parameter, optional
        In rad of the phase; the exact slider where there is none.

    Raises
    ------
    ValueError
        For a limit that is negative, a stiffness or creep that is not positive.

    References
    ----------
    Jenkin, Engineering 114 (1922) 603; Iwan, J. Appl. Mech. 33 (1966) 893-900.
    """

    q: Coordinate
    stiffness: Value
    limit: Value | NormalLoad
    to: Coordinate | None = None
    creep: Value | None = None

    def __post_init__(self) -> None:
        above_zero("stiffness of a slider", self.stiffness)
        check_limit("limit of a slider", self.limit)
        _creeping("creep of a slider", self.creep)

    def contribute(self, assembly: Assembly) -> None:
        """Add the slider."""
        k = assembly.parameter(self.stiffness, "k_slider", "N/m", POSITIVE)
        slide(assembly, self, k, limit_of(assembly, self.limit, "F_slider"), "z")


@dataclass(frozen=True)
class Iwan(Part):
    """Elastic sliders side by side, the i-th of limit F_i: a joint that slips by degrees.

    Sliders of equal F_i/k_i slip together: as exact sliders they are one, of the sums of both.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    stiffness : float, Parameter or sequence of either
        k in N/m, of all together while they stick, each with the same part of it; or that of each.
    limits : sequence of float, Parameter or NormalLoad
        F_1, ..., F_n in N.
    to : Coordinate, optional
        The coordinate r at the other end, u = q - r; the ground where there is none.
    creep : float or Parameter, optional
        As in `Jenkins`.

    Raises
    ------
    ValueError
        For no limit at all, one that is negative, a stiffness or creep that is not positive, and for other
        than one stiffness for each limit.

    References
    ----------
    Iwan, J. Appl. Mech. 33 (1966) 893-900.
    """

    q: Coordinate
    stiffness: Value | Sequence[Value]
    limits: Sequence[Value | NormalLoad]
    to: Coordinate | None = None
    creep: Value | None = None

    def __post_init__(self) -> None:
        if isinstance(self.stiffness, list | tuple):
            object.__setattr__(self, "stiffness", several("stiffness", self.stiffness))
        for stiffness in self.stiffness if isinstance(self.stiffness, tuple) else (self.stiffness,):
            above_zero("stiffness of the sliders", cast(Value, stiffness))
        _creeping("creep of the sliders", self.creep)
        object.__setattr__(self, "limits", several("limits", self.limits))
        if not self.limits:
            raise refusal("limits", self.limits, "a sequence of at least one force in N")
        for limit in self.limits:
            check_limit("limit of a slider", limit)
        if isinstance(self.stiffness, tuple) and len(self.stiffness) != len(self.limits):
            raise refusal("stiffness", self.stiffness, f"one for each of the {len(self.limits)} limits")

    def contribute(self, assembly: Assembly) -> None:
        """Add the sliders."""
        for count, same in enumerate(self._together(), 1):
            k = self._stiffness(assembly, same, count)
            limit = self.limits[same[0]]
            if len(same) > 1:
                limit = sum(cast(float, self.limits[i]) for i in same)
            slide(assembly, self, k, limit_of(assembly, limit, f"F_slider_{count}"), f"z{count}")

    def _together(self) -> list[list[int]]:
        """The sliders that are one: of equal numbers F_i/k_i, without creep."""
        found = dict[object, list[int]]()
        share = self.stiffness if isinstance(self.stiffness, tuple) else (1.0,) * len(self.limits)
        for i, (k, limit) in enumerate(zip(share, self.limits, strict=True)):
            plain = self.creep is None and isinstance(k, int | float) and isinstance(limit, int | float)
            found.setdefault(cast(float, limit) / cast(float, k) if plain else (i,), []).append(i)
        return list(found.values())

    def _stiffness(self, assembly: Assembly, same: Sequence[int], count: int) -> ca.SX:
        """The stiffness of sliders that are one."""
        if isinstance(self.stiffness, tuple):
            own = self.stiffness[same[0]]
            if len(same) > 1:
                own = sum(cast(float, self.stiffness[i]) for i in same)
            return assembly.parameter(own, f"k_slider_{count}", "N/m", POSITIVE)
        together = assembly.parameter(cast(Value, self.stiffness), "k_sliders", "N/m", POSITIVE)
        return together * len(same) / len(self.limits)


def slide(assembly: Assembly, part: Jenkins | Iwan, k: ca.SX, limit: ca.SX, name: str) -> None:
    """Add one slider: its force, its state and the row of it."""
    q, to = part.q, part.to
    apart("to", q, to)
    name = _unused(assembly, name, q.name if to is None else f"{q.name} - {to.name}", part.owner)
    scale = assembly.motion(q).position.scale
    creep = ca.SX(CREEP)
    if part.creep is not None:
        creep = assembly.parameter(part.creep, "creep", "rad", POSITIVE)
    z, elongation = assembly.state(name, q.unit, scale, ca.SX(0)), deflection(assembly, q, to)
    force = k * (elongation - z.symbol)
    over = ca.fmax(force - limit, 0) + ca.fmin(force + limit, 0)
    resist(assembly, q, to, force)
    assembly.output(f"force of {name}", "N", force)
    row = (creep * (z.derivative - LEAK * force / k) - over / k) / scale
    if part.creep is None:
        assembly.slider(name, z, row, elongation, limit / k)
        return
    assembly.differential_rows.append(row)
    assembly.switch(f"{name}: f = F", (force - limit) / (k * scale), 0)
    assembly.switch(f"{name}: f = -F", (force + limit) / (k * scale), 0)


def _unused(assembly: Assembly, name: str, between: str, owner: str) -> str:
    """The name of a slider between two places; where another has it, by the part's own name or a number."""
    taken = {state.name for state in assembly.states}
    places = [between, *([assembly.owner] if assembly.owner != owner else [])]
    numbered = (f"{name} of {between} ({count})" for count in range(2, len(taken) + 3))
    found = (*(f"{name} of {place}" for place in places), *numbered)
    return next(each for each in found if each not in taken)


def _creeping(field: str, creep: Value | None) -> None:
    """Refuse a creep that is not positive. Raises ValueError."""
    if creep is not None:
        above_zero(field, creep)
