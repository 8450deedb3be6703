"""Names, units and values: the coordinates and parameters from which parts are built."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import casadi as ca


@dataclass(frozen=True)
class Variable:
    """A named quantity of a compiled system: a state, an algebraic unknown, an output or a parameter.

    `scale` is the SI value of one internal unit: SI value = scale * internal value. Parameters and
    outputs are kept in SI (scale 1). `value` is the nominal value (parameters only).
    """

    name: str
    unit: str = ""
    scale: float = 1.0
    value: float = math.nan


@dataclass(frozen=True)
class SwitchInfo:
    """A function s(x, tau, p) that has a kink in time where it passes one of its `levels`.

    `direction` is -1 where only a falling passage is a kink, +1 for a rising one, 0 for both. Levels fall:
    each marks the same kink more sharply than the one before, as long as s goes that far below it.
    """

    name: str
    direction: int
    levels: tuple[float, ...] = (0.0,)


@dataclass(frozen=True, eq=False)
class Parameter:
    """A number of the model that can be changed or continued in after compilation (SI value)."""

    name: str
    value: float
    unit: str = ""
    symbol: ca.SX = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise ValueError(f"parameter {self.name!r} is {self.value}; it must be a finite number")
        object.__setattr__(self, "symbol", ca.SX.sym(self.name))


Value = float | Parameter


@dataclass(frozen=True, eq=False)
class Coordinate:
    """A mechanical coordinate q; it brings the two states q and dq/dtau where it carries a mass.

    `scale` (SI) is the length taken as one inside; None takes it from a contact on the coordinate, else 1.
    """

    name: str
    unit: str = "m"
    scale: float | None = None

    def __post_init__(self) -> None:
        if self.scale is not None and not (math.isfinite(self.scale) and self.scale > 0):
            raise ValueError(
                f"scale of coordinate {self.name!r} is {self.scale}; it must be a positive number"
            )


def parameter(name: str, value: float, unit: str = "") -> Parameter:
    """Return a named parameter with its nominal value in SI units."""
    return Parameter(name, float(value), unit)


def coordinate(name: str, unit: str = "m", scale: float | None = None) -> Coordinate:
    """Return a mechanical coordinate. Raises ValueError for a scale that is not positive."""
    return Coordinate(name, unit, scale)
