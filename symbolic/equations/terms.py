"""What an assembly keeps of states, unknowns and the motions of coordinates."""

from __future__ import annotations

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
    """A degree of freedom of a condensed structure: its motion, and the force on it as an unknown."""

    motion: Motion
    structure: Any
    freedom: int
    unknown: ca.SX
    unit_force: float
