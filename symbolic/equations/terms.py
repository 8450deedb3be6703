"""What an assembly keeps of states, unknowns and motions of coordinates, and what an impulse does to them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca


@dataclass(eq=False)
class State:
    """A differential state: its symbol (SI), the symbol of its tau-derivative, its scale and rest value."""

    name: str
    unit: str
    symbol: ca.SX
    derivative: ca.SX
    scale: float
    rest: ca.SX


@dataclass
class Unknown:
    """An algebraic unknown: it exists at collocation points only, and enters the equations unscaled.

    `moved` is where a Newton increment takes it, an expression in `symbol` and `increment`; their sum where
    the unknown has no better way. `scale` times it is a quantity in `unit`.
    """

    name: str
    symbol: ca.SX
    increment: ca.SX
    rest: ca.SX
    moved: ca.SX
    unit: str = ""
    scale: float = 1.0


@dataclass
class Motion:
    """What the parts have said of one coordinate: its mass and the sum of the forces on it."""

    position: State
    velocity: State
    mass: ca.SX
    force: ca.SX


@dataclass
class Place:
    """A degree of freedom of a condensed structure: its motion, and the force on it as an unknown.

    `coasting` is what its acceleration would be without forces at the places, known where friction may stick
    there; `mobility` is what forces (N) at the structure's places, in order, add to it in SI.
    """

    motion: Motion
    structure: Any
    freedom: int
    unknown: ca.SX
    unit_force: float
    coasting: State | None = None
    mobility: Sequence[float] = ()


@dataclass(frozen=True)
class Slider:
    """What an elastic slider of state z does where it is held or carried.

    row: index of its row, where the state decides, among those of differential states; held, slipping: the
    same row in the modes STUCK, and PLUS and MINUS. releases: indices of the switches (up, down) between
    which it is held. speeds: its guard, the rate at which it is strained, in PLUS and MINUS. place: how far
    it is from where it is HELD.
    """

    state: State
    row: int
    held: ca.SX
    slipping: tuple[ca.SX, ca.SX]
    releases: tuple[int, int]
    speeds: tuple[ca.SX, ca.SX]
    place: ca.SX


@dataclass(frozen=True)
class Relay:
    """A relay with hysteresis.

    symbol: 1 where it is on, -1 where it is off. over, under: u less the upper threshold, and less the lower
    one: it is off as long as the first is negative, on as long as the second is positive.
    """

    symbol: ca.SX
    over: ca.SX
    under: ca.SX


def struck(motions: Iterable[Motion], hit: Motion, after: ca.SX, omega: ca.SX) -> dict[State, ca.SX]:
    """Return the velocities after an impulse on one coordinate that gives it the velocity `after`.

    With M the mass matrix and e the coordinate, they change by M^-1 e (v+ - v-) / (e^T M^-1 e), in the
    coordinates that inertia couples to it.
    """
    every = list(motions)
    changed = mobility(every, hit, omega)
    place = next(i for i in changed if every[i] is hit)
    if len(changed) == 1:
        return {hit.velocity: after}
    size = (after - hit.velocity.symbol) / changed[place]
    return {
        every[i].velocity: after if i == place else every[i].velocity.symbol + change * size
        for i, change in changed.items()
    }


def mobility(motions: Sequence[Motion], hit: Motion, omega: ca.SX) -> dict[int, ca.SX]:
    """Return M^-1 e, e a coordinate's unit vector, by the indices of the coordinates that inertia couples.

    The mass matrix M is read from the forces: they have -(M_ij q_j'') of the other coordinates.
    """
    rates = ca.vertcat(*[m.velocity.derivative for m in motions])
    coupling = ca.jacobian(ca.vertcat(*[m.force for m in motions]), rates)
    own = ca.diag(ca.vertcat(*[m.mass for m in motions]))
    mass = own - ca.substitute(coupling, omega, ca.SX(1))  # forces have rates times omega^2
    place = next(i for i, m in enumerate(motions) if m is hit)
    joined = _joined(mass, place)
    unit = ca.SX([1.0 if i == place else 0.0 for i in joined])
    found = ca.solve(mass[joined, joined], unit)
    return {i: found[row] for row, i in enumerate(joined)}


def _joined(mass: ca.SX, place: int) -> list[int]:
    """The coordinates that a mass matrix joins to one, itself included, in order."""
    pattern = ca.DM(mass.sparsity(), 1).full() != 0
    pattern |= pattern.T
    found, new = {place}, {place}
    while new:
        new = {int(j) for i in new for j in pattern[i].nonzero()[0]} - found
        found |= new
    return sorted(found)
