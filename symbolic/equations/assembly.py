"""The workbench on which parts lay their terms before a model is compiled.

Parts write excitation with `sine` and `cosine`, which are sin tau and cos tau in the compiled system and zero
in the unexcited one.

Independent variable: the phase tau = omega t of the excitation. A coordinate q brings the states q and
q' = dq/dtau, so that dq/dt = omega q' and the equation of motion reads m omega^2 q'' = sum of forces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

import casadi as ca

from symbolic.checks import typed
from symbolic.equations.terms import Motion, State, Unknown
from symbolic.equations.variables import Coordinate, Parameter, SwitchInfo, Value, Variable


class Contributor(Protocol):
    """What lays terms on the workbench: every part."""

    def contribute(self, assembly: Assembly) -> None:
        """Add forces, states, unknowns, rows, outputs and switches.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        """


class Joint(Protocol):
    """Something to which several parts contribute: what it comes to is known when all have spoken."""

    def close(self, assembly: Assembly) -> None:
        """Add what the parts have said together.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model, all its parts laid.
        """


def _added(symbol: ca.SX, increment: ca.SX) -> ca.SX:
    return symbol + increment


@dataclass
class Assembly:
    """Collects what the parts contribute; `symbolic.compile` turns it into a System.

    Parameters
    ----------
    phase : casadi.SX
        tau.
    sine, cosine : casadi.SX
        Excitation: sin tau and cos tau in the compiled system, zero in the unexcited one.
    omega : casadi.SX
        Placeholder of the angular frequency, so that dq/dt = omega dq/dtau.
    """

    phase: ca.SX = field(default_factory=lambda: ca.SX.sym("tau"))
    sine: ca.SX = field(default_factory=lambda: ca.SX.sym("sin_tau"))
    cosine: ca.SX = field(default_factory=lambda: ca.SX.sym("cos_tau"))
    omega: ca.SX = field(default_factory=lambda: ca.SX.sym("omega"))
    frequency: ca.SX | None = field(default=None, init=False)
    parameters: dict[str, Parameter] = field(default_factory=dict, init=False)
    owners: dict[str, Parameter] = field(default_factory=dict, init=False)
    motions: dict[Coordinate, Motion] = field(default_factory=dict, init=False)
    states: list[State] = field(default_factory=list, init=False)
    unknowns: list[Unknown] = field(default_factory=list, init=False)
    differential_rows: list[ca.SX] = field(default_factory=list, init=False)
    algebraic_rows: list[ca.SX] = field(default_factory=list, init=False)
    outputs: list[tuple[Variable, ca.SX]] = field(default_factory=list, init=False)
    switches: list[tuple[SwitchInfo, ca.SX]] = field(default_factory=list, init=False)
    joints: dict[object, Joint] = field(default_factory=dict, init=False)

    def lay(self, parts: Iterable[Contributor]) -> None:
        """Let parts add their terms.

        Parameters
        ----------
        parts : iterable of Part
            In any order.
        """
        for part in parts:
            part.contribute(self)

    def close(self) -> None:
        """Let what several parts have built together add its terms."""
        for joint in self.joints.values():
            joint.close(self)

    @property
    def described(self) -> list[tuple[Variable, ca.SX]]:
        """All outputs: the coordinates, then those that parts have added."""
        positions = [motion.position for motion in self.motions.values()]
        return [(Variable(x.name, x.unit), x.symbol) for x in positions] + self.outputs

    def parameter(self, value: Value, name: str, unit: str = "") -> ca.SX:
        """Register a part's number and return its symbol.

        Parameters
        ----------
        value : float or Parameter
            Bare numbers of one name and value are one parameter.
        name : str
            What a bare number is called.
        unit : str
            Its SI unit.

        Returns
        -------
        casadi.SX
            The parameter's symbol.

        Raises
        ------
        ValueError
            Where the name is another parameter's already, or the value no finite number.
        """
        item = value if isinstance(value, Parameter) else Parameter(name, value, unit)
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
        """Set omega, the angular frequency of the excitation.

        Parameters
        ----------
        frequency : casadi.SX
            Expression in parameters, in rad/s.

        Raises
        ------
        ValueError
            Where another part excites the model at another frequency.
        """
        if self.frequency is not None and not ca.is_equal(self.frequency, frequency, 10):
            raise ValueError("two parts excite the model at different frequencies; all must share one")
        self.frequency = frequency

    def nominal(self, expression: ca.SX) -> float:
        """Return the value of an expression at the parameters' nominal values.

        Parameters
        ----------
        expression : casadi.SX
            Expression in parameters and omega.

        Returns
        -------
        float
            Its value (SI).
        """
        expression = self.with_frequency(expression)
        items = list(self.parameters.values())
        symbols = ca.vertcat(*[item.symbol for item in items])
        values = [item.value for item in items]
        return float(ca.Function("nominal", [symbols], [expression])(values))

    def with_frequency(self, expression: ca.SX) -> ca.SX:
        """Replace the placeholder omega by the frequency of the excitation.

        A model without excitation keeps omega = 2 pi / period as a parameter of its own.

        Parameters
        ----------
        expression : casadi.SX
            Any expression of the model.

        Returns
        -------
        casadi.SX
            The expression without the placeholder.
        """
        if self.frequency is None:
            self.frequency = self.parameter(Parameter("omega", 1.0, "rad/s"), "omega")
        return ca.substitute(expression, self.omega, self.frequency)

    def state(self, name: str, unit: str, scale: float, rest: ca.SX) -> State:
        """Add a differential state.

        Parameters
        ----------
        name, unit : str
            Its name, and its SI unit.
        scale : float
            SI value of one internal unit.
        rest : casadi.SX
            Where the search for a rest begins, SI.

        Returns
        -------
        State
            Its symbols, in SI.

        Raises
        ------
        ValueError
            For a name that another state has.
        """
        if any(name == other.name for other in self.states):
            raise ValueError(f"state {name!r} is defined twice; every state needs a name of its own")
        new = State(name, unit, ca.SX.sym(name), ca.SX.sym(f"{name}'"), scale, rest)
        self.states.append(new)
        return new

    def algebraic(self, name: str, rest: ca.SX, move: Callable[[ca.SX, ca.SX], ca.SX] = _added) -> ca.SX:
        """Add an algebraic unknown.

        Parameters
        ----------
        name : str
            Its name.
        rest : casadi.SX
            Where the search for a rest begins.
        move : callable
            (unknown, Newton increment) to where the increment takes it.

        Returns
        -------
        casadi.SX
            Its symbol.
        """
        symbol, increment = ca.SX.sym(name), ca.SX.sym(f"d{name}")
        self.unknowns.append(Unknown(name, symbol, increment, rest, move(symbol, increment)))
        return symbol

    def motion(self, coordinate: Coordinate) -> Motion:
        """Return what is known of a coordinate, making its two states at the first call.

        Parameters
        ----------
        coordinate : Coordinate
            The coordinate q.

        Returns
        -------
        Motion
            Its states, and the mass and force on it to which parts add (SI).

        Raises
        ------
        ValueError
            For what is no coordinate.
        """
        typed("coordinate", coordinate, Coordinate, "a Coordinate, as symbolic.coordinate returns it")
        if coordinate not in self.motions:
            length = coordinate.scale or 1.0
            zero = ca.SX(0)
            position = self.state(coordinate.name, coordinate.unit, length, zero)
            velocity = self.state(f"{coordinate.name}'", coordinate.unit, length, zero)
            self.motions[coordinate] = Motion(position, velocity, ca.SX(0), ca.SX(0))
        return self.motions[coordinate]

    def suggest_scale(self, coordinate: Coordinate, length: float) -> None:
        """Set the scale of a coordinate for which the user has set none.

        Parameters
        ----------
        coordinate : Coordinate
            The coordinate.
        length : float
            SI value of one internal unit.
        """
        if coordinate.scale is None:
            motion = self.motion(coordinate)
            motion.position.scale = motion.velocity.scale = length

    def speed_of(self, coordinate: Coordinate) -> ca.SX:
        """Return dq/dt = omega dq/dtau.

        Parameters
        ----------
        coordinate : Coordinate
            The coordinate q.

        Returns
        -------
        casadi.SX
            Its speed in SI.
        """
        return self.omega * self.motion(coordinate).velocity.symbol

    def output(self, name: str, unit: str, expression: ca.SX) -> None:
        """Add an output.

        Parameters
        ----------
        name, unit : str
            Its name, and its SI unit.
        expression : casadi.SX
            Any function of derivatives, states, unknowns, phase and parameters (SI).

        Raises
        ------
        ValueError
            For a name that another output has.
        """
        if any(name == variable.name for variable, _ in self.outputs):
            raise ValueError(f"output {name!r} is defined twice; give contact pairs names of their own")
        self.outputs.append((Variable(name, unit), expression))

    def switch(
        self, name: str, expression: ca.SX, direction: int, levels: tuple[float, ...] = (0.0,)
    ) -> None:
        """Add a switch: a function s(x, tau, p) that marks kinks in time.

        Parameters
        ----------
        name : str
            Its name.
        expression : casadi.SX
            s.
        direction : int
            -1 where only a falling passage is a kink, +1 for a rising one, 0 for both.
        levels : tuple of float
            Falling values; each marks the same kink more sharply than the one before.
        """
        self.switches.append((SwitchInfo(name, direction, levels), expression))
