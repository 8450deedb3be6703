"""The workbench on which parts lay their terms before a model is compiled.

Parts write excitation with `sine` and `cosine`, which are sin tau and cos tau in the compiled system and zero
in the unexcited one.

Independent variable: the phase tau = omega t of the excitation. A coordinate q brings the states q and
q' = dq/dtau, so that dq/dt = omega q' and the equation of motion reads m omega^2 q'' = sum of forces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import casadi as ca

from symbolic.variables import Coordinate, Parameter, SwitchInfo, Value, Variable


@dataclass
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
    """An algebraic unknown: it exists at collocation points only and has no scale of its own.

    `moved` is where a Newton increment takes it, an expression in `symbol` and `increment`; their sum where
    the unknown has no better way.
    """

    name: str
    symbol: ca.SX
    increment: ca.SX
    rest: ca.SX
    moved: ca.SX


@dataclass
class Motion:
    """What the parts have said of one coordinate: its mass and the sum of the forces on it."""

    position: State
    velocity: State
    mass: ca.SX
    force: ca.SX


@dataclass
class Assembly:
    """Collects what the parts contribute; `symbolic.compile` turns it into a System."""

    phase: ca.SX = field(default_factory=lambda: ca.SX.sym("tau"))
    sine: ca.SX = field(default_factory=lambda: ca.SX.sym("sin_tau"))
    cosine: ca.SX = field(default_factory=lambda: ca.SX.sym("cos_tau"))
    omega: ca.SX = field(default_factory=lambda: ca.SX.sym("omega"))
    frequency: ca.SX | None = None
    parameters: dict[str, Parameter] = field(default_factory=dict)
    owners: dict[str, Parameter] = field(default_factory=dict)
    motions: dict[Coordinate, Motion] = field(default_factory=dict)
    states: list[State] = field(default_factory=list)
    unknowns: list[Unknown] = field(default_factory=list)
    differential_rows: list[ca.SX] = field(default_factory=list)
    algebraic_rows: list[ca.SX] = field(default_factory=list)
    outputs: list[tuple[Variable, ca.SX]] = field(default_factory=list)
    switches: list[tuple[SwitchInfo, ca.SX]] = field(default_factory=list)
    junctions: dict[object, object] = field(default_factory=dict)

    def parameter(self, value: Value, name: str, unit: str = "") -> ca.SX:
        """Register a part's number and return its symbol; a bare number gets the part's own `name`.

        Bare numbers of one name and value are one parameter.
        """
        item = value if isinstance(value, Parameter) else Parameter(name, float(value), unit)
        known = self.parameters.setdefault(item.name, item)
        bare = item is not value
        same = known.value == item.value and (bare or self.owners.setdefault(item.name, item) is item)
        if not same:
            raise ValueError(
                f"parameter {item.name!r} is defined twice ({known.value} and {item.value}); "
                f"share one symbolic.parameter, or give the second a name of its own"
            )
        return known.symbol

    def excite(self, frequency: ca.SX) -> None:
        """Set omega, the angular frequency of the excitation; all parts of a model share one."""
        if self.frequency is not None and not ca.is_equal(self.frequency, frequency, 10):
            raise ValueError("two parts excite the model at different frequencies; all must share one")
        self.frequency = frequency

    def nominal(self, expression: ca.SX) -> float:
        """Return the value of an expression in the parameters at their nominal values."""
        expression = self.with_frequency(expression)
        items = list(self.parameters.values())
        symbols = ca.vertcat(*[item.symbol for item in items])
        values = [item.value for item in items]
        return float(ca.Function("nominal", [symbols], [expression])(values))

    def with_frequency(self, expression: ca.SX) -> ca.SX:
        """Replace the placeholder omega by the frequency of the excitation.

        A model without excitation keeps omega = 2 pi / period as a parameter of its own.
        """
        if self.frequency is None:
            self.frequency = self.parameter(Parameter("omega", 1.0, "rad/s"), "omega")
        return ca.substitute(expression, self.omega, self.frequency)

    def state(self, name: str, unit: str, scale: float, rest: ca.SX) -> State:
        """Add a differential state (SI) and return it."""
        if any(name == other.name for other in self.states):
            raise ValueError(f"state {name!r} is defined twice; every state needs a name of its own")
        new = State(name, unit, ca.SX.sym(name), ca.SX.sym(f"{name}'"), scale, rest)
        self.states.append(new)
        return new

    def algebraic(
        self, name: str, rest: ca.SX, move: Callable[[ca.SX, ca.SX], ca.SX] = lambda z, dz: z + dz
    ) -> ca.SX:
        """Add an algebraic unknown and return its symbol; `move` says where a Newton increment takes it."""
        symbol, increment = ca.SX.sym(name), ca.SX.sym(f"d{name}")
        self.unknowns.append(Unknown(name, symbol, increment, rest, move(symbol, increment)))
        return symbol

    def motion(self, coordinate: Coordinate) -> Motion:
        """Return the motion of a coordinate, making its two states at the first call."""
        if coordinate not in self.motions:
            length = coordinate.scale or 1.0
            zero = ca.SX(0)
            position = self.state(coordinate.name, coordinate.unit, length, zero)
            velocity = self.state(f"{coordinate.name}'", coordinate.unit, length, zero)
            self.motions[coordinate] = Motion(position, velocity, ca.SX(0), ca.SX(0))
        return self.motions[coordinate]

    def suggest_scale(self, coordinate: Coordinate, length: float) -> None:
        """Set the scale of a coordinate for which the user has set none."""
        if coordinate.scale is None:
            motion = self.motion(coordinate)
            motion.position.scale = motion.velocity.scale = length

    def speed_of(self, coordinate: Coordinate) -> ca.SX:
        """Return dq/dt in SI units."""
        return self.omega * self.motion(coordinate).velocity.symbol

    def output(self, name: str, unit: str, expression: ca.SX) -> None:
        """Add an output: any function of derivatives, states, unknowns, phase and parameters."""
        if any(name == variable.name for variable, _ in self.outputs):
            raise ValueError(f"output {name!r} is defined twice; give contact pairs names of their own")
        self.outputs.append((Variable(name, unit), expression))

    def switch(
        self, name: str, expression: ca.SX, direction: int, levels: tuple[float, ...] = (0.0,)
    ) -> None:
        """Add a switch s(x, tau, p); see `SwitchInfo` for direction and levels."""
        self.switches.append((SwitchInfo(name, direction, levels), expression))
