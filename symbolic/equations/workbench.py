"""The workbench on which parts lay their terms: parameters, states, unknowns, excitation, outputs.

Parts write excitation with `sine` and `cosine`, which are sin theta and cos theta, theta = Omega t, in the
compiled system and zero in the unexcited one, and with `harmonic` of any rational order.

Independent variable: the phase tau = omega t, 2 pi of which are one period of all that the parts ask for:
tau = theta and omega = Omega unless a part uses another order than 1. A coordinate q brings the states q and
q' = dq/dtau, so that dq/dt = omega q' and the equation of motion reads m omega^2 q'' = sum of forces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import casadi as ca

from symbolic.checks import refusal, text, typed
from symbolic.equations.excitation import Excitation, Order
from symbolic.equations.interval import ANY, Interval
from symbolic.equations.numbers import Numbers
from symbolic.equations.terms import Motion, State, Unknown
from symbolic.equations.variables import ANGULAR, Coordinate, Parameter, Value, Variable
from symbolic.sketch import Sketch


def _angular(value: Value, symbol: ca.SX) -> ca.SX:
    """An angular frequency in rad/s, from the unit of the user's parameter."""
    given = value.unit if isinstance(value, Parameter) else ""
    if given not in ("", *ANGULAR):
        raise refusal(
            f"unit of {symbol.name()!r}", given, f"that of an angular frequency, {', '.join(ANGULAR)}"
        )
    factor = ANGULAR.get(given, 1.0)
    return symbol if factor == 1 else factor * symbol


def _added(symbol: ca.SX, increment: ca.SX) -> ca.SX:
    return symbol + increment


@dataclass
class Workbench:
    """What equations of motion are written with; for its fields see `Assembly`."""

    excitation: Excitation = field(default_factory=Excitation)
    numbers: Numbers = field(default_factory=Numbers)
    sketch: Sketch = field(default_factory=Sketch)
    omega: ca.SX = field(default_factory=lambda: ca.SX.sym("omega"))
    owner: str = field(default="", init=False)
    motions: dict[Coordinate, Motion] = field(default_factory=dict, init=False)
    states: list[State] = field(default_factory=list, init=False)
    unknowns: list[Unknown] = field(default_factory=list, init=False)
    differential_rows: list[ca.SX] = field(default_factory=list, init=False)
    algebraic_rows: list[ca.SX] = field(default_factory=list, init=False)
    outputs: list[tuple[Variable, ca.SX]] = field(default_factory=list, init=False)
    shared: dict[int, str] = field(default_factory=dict, init=False)

    @contextmanager
    def owned(self, owner: str) -> Iterator[None]:
        """Let bare numbers inside the block belong to an owner, by whose name they may be called.

        Parameters
        ----------
        owner : str
            Its name.

        Yields
        ------
        None
            Nothing.
        """
        before, self.owner = self.owner, owner
        try:
            yield
        finally:
            self.owner = before

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The parameters of the model by name, as the numbers so far come to."""
        return {name: parameter for name, (parameter, _) in self.numbers.named().items()}

    @property
    def sine(self) -> ca.SX:
        """sin theta in the compiled system, zero in the unexcited one."""
        return self.excitation.wave()[0]

    @property
    def cosine(self) -> ca.SX:
        """cos theta in the compiled system, zero in the unexcited one."""
        return self.excitation.wave()[1]

    @property
    def phase(self) -> ca.SX:
        """theta = Omega t, for terms of period 2 pi in it; zero in the unexcited system."""
        return self.excitation.theta()

    def angle(self, order: Order = 1) -> ca.SX:
        """Return theta = Omega t itself, for terms that repeat as cos(order theta) does.

        Balls of a bearing at theta/n + 2 pi i/n with theta the angle of ball passage make a term of order 1.

        Parameters
        ----------
        order : int, float, str or Fraction
            A positive rational number.

        Returns
        -------
        casadi.SX
            theta in rad; zero in the unexcited system.
        """
        return self.excitation.theta(order)

    def harmonic(self, order: Order = 1, phase: ca.SX | float = 0.0) -> ca.SX:
        """Return cos(order theta + phase), theta = Omega t.

        Parameters
        ----------
        order : int, float, str or Fraction
            A positive rational number; text as "1/2".
        phase : casadi.SX or float
            In rad.

        Returns
        -------
        casadi.SX
            The harmonic; zero in the unexcited system.

        Raises
        ------
        ValueError
            For an order that is not positive, or not rational with a denominator up to 1000.
        """
        sine, cosine = self.excitation.wave(order)
        return cosine * ca.cos(phase) - sine * ca.sin(phase)

    @property
    def described(self) -> list[tuple[Variable, ca.SX]]:
        """All outputs: the coordinates, then those that parts have added."""
        positions = [motion.position for motion in self.motions.values()]
        names = told_apart([variable.name for variable, _ in self.outputs], self.shared)
        added = [
            (Variable(name, variable.unit), expression)
            for name, (variable, expression) in zip(names, self.outputs, strict=True)
        ]
        return [(Variable(x.name, x.unit), x.symbol) for x in positions] + added

    @property
    def variables(self) -> tuple[Variable, ...]:
        """The parameters of the model with the values that they may have."""
        found = self.numbers.named().items()
        return tuple(
            Variable(name, own.unit, 1.0, own.value, self.numbers.interval(symbols))
            for name, (own, symbols) in found
        )

    def parameter(self, value: Value, name: str, unit: str = "", allowed: Interval = ANY) -> ca.SX:
        """Register a part's number and return its symbol.

        Parameters
        ----------
        value : float or Parameter
            Bare numbers of one name and value are one parameter; where values differ they are named by
            their owner, the coordinates of the part, as m_x and m_y.
        name : str
            What a bare number is called.
        unit : str
            Its SI unit.
        allowed : Interval
            Values that it may have, now and in traces and maps.

        Returns
        -------
        casadi.SX
            The parameter's symbol; times 2 pi (or 2 pi/60) where rad/s is asked for and a parameter in Hz (or
            rev/min) is given.

        Raises
        ------
        ValueError
            For a value that is no finite number, or not allowed, and for an angular frequency in a unit of
            something else.
        """
        symbol = self.numbers.symbol(value, name, unit, self.owner, allowed)
        return _angular(value, symbol) if unit == "rad/s" else symbol

    def excite(self, frequency: ca.SX) -> None:
        """Set Omega, the angular frequency of the excitation: theta = Omega t.

        Parameters
        ----------
        frequency : casadi.SX
            Expression in parameters, in rad/s.

        Raises
        ------
        ValueError
            Where another part excites the model at another frequency.
        """
        frequency, known = self.numbers.canonical(frequency), self.excitation.frequency
        if known is not None and not ca.is_equal(known, frequency, 10):
            first, second = (f"{name} = {self.nominal(name):g} rad/s" for name in (known, frequency))
            raise ValueError(
                f"parts excite the model at two frequencies, {first} and {second} ({self.owner}); "
                f"all must share one, a symbolic.parameter, to which `order` may be given"
            )
        self.excitation.frequency = frequency

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
        if ca.depends_on(expression, self.omega):
            expression = self.with_frequency(expression)
        symbols = ca.symvar(expression)  # few: a model may have thousands of parameters
        if not symbols:
            return float(ca.DM(expression))
        values = [self.numbers.value_of(symbol) for symbol in symbols]
        return float(ca.Function("nominal", [ca.vertcat(*symbols)], [expression])(values))

    def with_frequency(self, expression: ca.SX) -> ca.SX:
        """Replace the placeholder omega by the frequency of the phase: Omega times the common order.

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
        if self.excitation.frequency is None:
            self.excitation.frequency = self.parameter(Parameter("omega", 1.0, "rad/s"), "omega")
        common = self.excitation.fundamental
        frequency = self.excitation.frequency if common == 1 else float(common) * self.excitation.frequency
        return ca.substitute(expression, self.omega, frequency)

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

    def algebraic(
        self,
        name: str,
        rest: ca.SX,
        move: Callable[[ca.SX, ca.SX], ca.SX] = _added,
        unit: str = "",
        scale: float = 1.0,
    ) -> ca.SX:
        """Add an algebraic unknown.

        Parameters
        ----------
        name : str
            Its name.
        rest : casadi.SX
            Where the search for a rest begins.
        move : callable
            (unknown, Newton increment) to where the increment takes it.
        unit : str
            SI unit of `scale` times the unknown.
        scale : float
            SI value of one internal unit.

        Returns
        -------
        casadi.SX
            Its symbol.
        """
        symbol, increment = ca.SX.sym(name), ca.SX.sym(f"d{name}")
        self.unknowns.append(Unknown(name, symbol, increment, rest, move(symbol, increment), unit, scale))
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
            For what is no coordinate, and for another coordinate of the same name.
        """
        typed("coordinate", coordinate, Coordinate, "a Coordinate, as symbolic.coordinate returns it")
        if coordinate not in self.motions:
            if any(coordinate.name == other.name for other in self.motions):
                raise ValueError(
                    f"two coordinates are called {coordinate.name!r}; each needs a name of its own "
                    f"(places of a structure have theirs from at={{name: index}})"
                )
            length = coordinate.scale or 1.0
            position = self.state(coordinate.name, coordinate.unit, length, ca.SX(coordinate.start))
            velocity = self.state(f"{coordinate.name}'", coordinate.unit, length, ca.SX(0))
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

    def rate(self, expression: ca.SX) -> ca.SX:
        """Return the derivative in tau of an expression in states and the excitation.

        Parameters
        ----------
        expression : casadi.SX
            Any function of the states so far, of the angle and of harmonics.

        Returns
        -------
        casadi.SX
            In velocities for coordinates, and in derivatives of other states.
        """
        known = {id(motion.position): motion.velocity.symbol for motion in self.motions.values()}
        symbols = [state.symbol for state in self.states]
        rates = [known.get(id(state), state.derivative) for state in self.states]
        return self.excitation.along(expression, ca.vertcat(*symbols), ca.vertcat(*rates))

    def output(self, name: str, unit: str, expression: ca.SX, shared: bool = False) -> None:
        """Add an output.

        Parameters
        ----------
        name, unit : str
            Its name, and its SI unit.
        expression : casadi.SX
            Any function of derivatives, states, unknowns, phase and parameters (SI).
        shared : bool
            Whether several parts of the model may have one of this name: where they do, each is called by its
            part's coordinates or name as well, as "eccentricity of left".

        Raises
        ------
        ValueError
            For a name that another output has, and one that is no line of text.
        """
        text("name of an output", name)
        own = [k for k, (variable, _) in enumerate(self.outputs) if variable.name == name]
        if shared and all(k in self.shared for k in own):
            self.shared[len(self.outputs)] = self.owner
        elif own:
            raise ValueError(f"output {name!r} is defined twice; give contact pairs names of their own")
        self.outputs.append((Variable(name, unit), expression))


def told_apart(names: Sequence[str], owners: Mapping[int, str]) -> list[str]:
    """Return names, those that several items share with the owner of each, and a number where that is shared.

    Parameters
    ----------
    names : sequence of str
        What the items are called.
    owners : mapping of int to str
        The owner of each item that may share its name, by its index.

    Returns
    -------
    list of str
        A name for each.
    """
    full = [f"{name} of {owners[k]}" if names.count(name) > 1 else name for k, name in enumerate(names)]
    return [_numbered(full, k) for k in range(len(full))]


def _numbered(names: Sequence[str], k: int) -> str:
    before = names[:k].count(names[k])
    return f"{names[k]} ({before + 1})" if before else names[k]
