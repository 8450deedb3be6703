"""Names, units and values: the coordinates and parameters from which parts are built."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import casadi as ca

from symbolic.checks import finite, line, positive, refusal, text, typed, whole
from symbolic.equations.interval import ANY, NOT_NEGATIVE, POSITIVE, Interval

ANGULAR = {"rev/min": 2 * math.pi / 60, "Hz": 2 * math.pi, "rad/s": 1.0}
"""rad/s in one of each unit in which a parameter may be given where a part asks for rad/s."""


@dataclass(frozen=True)
class Variable:
    """A named quantity of a compiled system: a state, an algebraic unknown, an output or a parameter.

    Parameters
    ----------
    name, unit : str
        Name, and SI unit. The state x' of a coordinate x is dx/dtau, in the unit of x: dx/dt = omega x'.
    scale : float
        SI value of one internal unit; 1 of parameters and outputs, which are kept in SI.
    value : float
        Nominal value (parameters only).
    allowed : Interval
        Values that it may have (parameters only).
    """

    name: str
    unit: str = ""
    scale: float = 1.0
    value: float = math.nan
    allowed: Interval = ANY

    def __repr__(self) -> str:
        value = f" = {self.value:.12g}" if math.isfinite(self.value) else ""
        return f"Variable({self.name}{value}{' ' if self.unit else ''}{self.unit})"

    def check(self, value: float) -> None:
        """Refuse a value that the parameter may not have.

        Parameters
        ----------
        value : float
            In SI.

        Raises
        ------
        ValueError
            In one sentence.
        """
        self.allowed.check(f"parameter {self.name!r}", value)


@dataclass(frozen=True)
class SwitchInfo:
    """A function s(x, tau, p) that has a kink in time where it passes one of its `levels`.

    `direction` is -1 where only a falling crossing is a kink, +1 for a rising one, 0 for both. Levels fall:
    each marks the same kink more sharply than the one before, as long as s falls that far.
    """

    name: str
    direction: int
    levels: tuple[float, ...] = (0.0,)


@dataclass(frozen=True, eq=False)
class Parameter:
    """A number of the model that can be changed or continued in after compilation.

    Parameters
    ----------
    name : str
        Its name, one in a model.
    value : float
        Nominal value in SI.
    unit : str
        SI unit.

    Raises
    ------
    ValueError
        For a value that is not finite, and a name or unit that is no line of text.
    """

    name: str
    value: float
    unit: str = ""
    symbol: ca.SX = field(init=False, repr=False)

    def __post_init__(self) -> None:
        text("name of a parameter", self.name)
        line(f"unit of {self.name!r}", self.unit)
        object.__setattr__(self, "value", finite(f"parameter {self.name!r}", self.value))
        object.__setattr__(self, "symbol", ca.SX.sym(self.name))

    def __repr__(self) -> str:
        return f"Parameter({self.name!r}, {self.value!r})"

    def __reduce__(self) -> tuple[type[Parameter], tuple[str, float, str]]:
        return Parameter, (self.name, self.value, self.unit)  # its symbol is CasADi's and made anew


Value = float | Parameter


def not_negative(field: str, value: Value) -> None:
    """Refuse a negative number of a part; what is no number is refused on compilation. Raises ValueError."""
    _within(NOT_NEGATIVE, field, value)


def above_zero(field: str, value: Value) -> None:
    """Refuse a part's number that is not positive; compilation refuses what is none. Raises ValueError."""
    _within(POSITIVE, field, value)


def _within(allowed: Interval, field: str, value: Value) -> None:
    number = value.value if isinstance(value, Parameter) else value
    if isinstance(number, int | float) and math.isfinite(number):
        allowed.check(field, number)


def several(field: str, values: object) -> tuple[Value, ...]:
    """Return a part's numbers in order; what is no number is refused on compilation. Raises ValueError."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise refusal(field, values, "a sequence of numbers")
    return tuple(values)


@dataclass(frozen=True, eq=False)
class Coordinate:
    """A mechanical coordinate q; it brings the two states q and dq/dtau where it carries a mass.

    Parameters
    ----------
    name, unit : str
        Name, and SI unit.
    scale : float, optional
        Length (SI) that is 1 in the scaled equations; by default that of a contact on the coordinate, else 1.
    start : float
        Where the search for the equilibrium begins (SI); needed where that lies beyond a clearance.

    Raises
    ------
    ValueError
        For a scale that is not a positive number, a start that is not finite, a name or unit that is no line
        of text, and a name that is empty or has a '.
    """

    name: str
    unit: str = "m"
    scale: float | None = None
    start: float = 0.0

    def __post_init__(self) -> None:
        if "'" in text("name of a coordinate", self.name):
            raise refusal("name of a coordinate", self.name, "without ', which marks velocities")
        line(f"unit of {self.name!r}", self.unit)
        if self.scale is not None:
            positive(f"scale of coordinate {self.name!r}", self.scale)
        object.__setattr__(self, "start", finite(f"start of coordinate {self.name!r}", self.start))

    def __repr__(self) -> str:
        return f"Coordinate({self.name!r})"


parameter, coordinate = Parameter, Coordinate
"""What models are written with: parts are given any number of them."""


def apart(field: str, one: Coordinate, other: Coordinate | None) -> None:
    """Refuse one coordinate for both ends, or directions, of a part, and what is none. Raises ValueError."""
    if other is not None:
        typed(field, other, Coordinate, "a Coordinate, as symbolic.coordinate returns it")
    if one is other:
        raise ValueError(f"{field} is {one.name!r} too; it must be another coordinate")


def coordinates(
    name: str, count: int, unit: str = "m", scale: float | None = None, start: float = 0.0
) -> tuple[Coordinate, ...]:
    """Return a vector of coordinates, called by the name and a number from 1.

    Parameters
    ----------
    name : str
        As "x", for x1, x2, ...
    count : int
        How many.
    unit : str
        SI unit of each.
    scale, start : float, optional
        As of `coordinate`.

    Returns
    -------
    tuple of Coordinate
        For one part on each: ``sym.combine(sym.Mass(q, 1.0) for q in x)``.

    Raises
    ------
    ValueError
        For a count that is no positive whole number, and as `coordinate`.
    """
    return tuple(
        Coordinate(f"{text('name of coordinates', name)}{k + 1}", unit, scale, start)
        for k in range(whole("count of coordinates", count, 1))
    )
