"""What the parts of a model lay down together before it is compiled: see `symbolic.equations.workbench`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Protocol

import casadi as ca

from symbolic.checks import text
from symbolic.equations.terms import Motion, Place, Relay, Slider, State, struck
from symbolic.equations.variables import Parameter, SwitchInfo
from symbolic.equations.workbench import Workbench
from symbolic.meter import counted
from symbolic.mistakes import explained
from symbolic.relays import kept_by


class Contributor(Protocol):
    """What lays terms on the workbench: every part."""

    @property
    def owner(self) -> str:
        """What its bare numbers belong to: names of coordinates or of a contact, or a name of its own."""

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


class Body(Protocol):
    """A linear structure of many degrees of freedom, at some of which other parts act."""

    def check_whole(self) -> None:
        """Refuse a structure that cannot have all its states in a model with impacts. Raises ValueError."""

    def expand(self, assembly: Assembly) -> None:
        """Add all its degrees of freedom, each with two states.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model, all its parts laid.
        """

    def condense(self, assembly: Assembly) -> None:
        """Leave two states at each place where other parts act, and add the force there as an unknown.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model, all its parts laid.
        """


SAME_GRAPH = 20
"""How deep the graphs of two expressions are compared."""


@dataclass
class Assembly(Workbench):
    """Collects what the parts contribute; `symbolic.compile` turns it into a System.

    It is the workbench on which they lay their terms, with the switches that mark kinks in time.

    Parameters
    ----------
    excitation : Excitation
        Its angle, harmonics and frequency.
    numbers : Numbers
        What becomes the parameters of the model.
    sketch : Sketch
        How it looks.
    omega : casadi.SX
        Placeholder of the angular frequency of the phase, so that dq/dt = omega dq/dtau.
    """

    switches: list[tuple[SwitchInfo, ca.SX]] = field(default_factory=list, init=False)
    smooth: list[ca.SX] = field(default_factory=list, init=False)
    resets: dict[int, dict[State, ca.SX]] = field(default_factory=dict, init=False)
    impacts: dict[int, tuple[Motion, ca.SX]] = field(default_factory=dict, init=False)
    sliders: dict[int, Slider] = field(default_factory=dict, init=False)
    relays: dict[int, Relay] = field(default_factory=dict, init=False)
    places_held: dict[int, tuple[str, ca.SX]] = field(default_factory=dict, init=False)
    joints: dict[object, Joint] = field(default_factory=dict, init=False)
    structures: list[Body] = field(default_factory=list, init=False)
    places: list[Place] = field(default_factory=list, init=False)

    def lay(self, parts: Iterable[Contributor]) -> None:
        """Let parts add their terms.

        Parameters
        ----------
        parts : iterable of Part
            In any order.
        """
        listed = list(parts)
        for k in counted(len(listed), "compiling", "parts"):
            part = listed[k]
            with kept_by(self), self.owned(part.owner), explained(type(part).__name__):
                part.contribute(self)

    def close(self, condense: bool = True) -> None:
        """Let what several parts have built together add its terms, structures last of all.

        Parameters
        ----------
        condense : bool
            Whether structures keep two states at their places alone, where nothing resets states: an impulse
            moves all of a structure at once.
        """
        for place, joint in self.joints.items():
            with kept_by(self), self.owned(str(getattr(place, "name", ""))):
                joint.close(self)
        jolted = bool(self.impacts or self.resets)
        for structure in self.structures:
            if condense and jolted:
                structure.check_whole()
            (structure.condense if condense and not jolted else structure.expand)(self)
        for k, (motion, after) in self.impacts.items():
            self.resets[k] = struck(self.motions.values(), motion, after, self.omega)

    def switch(
        self, name: str, expression: ca.SX, direction: int, levels: tuple[float, ...] = (0.0,)
    ) -> None:
        """Add a switch: a function s(x, tau, p) that marks kinks in time.

        Parameters
        ----------
        name : str
            Its name; where another switch has it, this one's is followed by the part's coordinates or name.
        expression : casadi.SX
            s.
        direction : int
            -1 where only a falling crossing is a kink, +1 for a rising one, 0 for both.
        levels : tuple of float
            Falling values; each marks the same kink more sharply than the one before.

        Raises
        ------
        ValueError
            For a name that is no line of text.
        """
        text("name of a switch", name)
        taken = [info.name for info, _ in self.switches]
        owned = f"{name} of {self.owner}"
        numbered = (f"{owned} ({count})" for count in range(2, len(taken) + 3))
        own = next(each for each in (name, owned, *numbered) if each not in taken)
        self.switches.append((SwitchInfo(own, direction, levels), expression))

    def reset(self, name: str, expression: ca.SX, to: dict[State, ca.SX]) -> None:
        """Add a switch at whose fall through 0 states are given new values: an impact.

        Parameters
        ----------
        name : str
            Its name.
        expression : casadi.SX
            s(x, tau, p), positive but at the event itself.
        to : dict
            New values (SI) of the states that change, expressions in what they are before.
        """
        self.resets[len(self.switches)] = to
        self.switch(name, expression, -1)

    def impact(self, name: str, expression: ca.SX, motion: Motion, after: ca.SX) -> None:
        """Add a switch at whose fall through 0 an impulse on a coordinate gives it a new velocity.

        Parameters
        ----------
        name : str
            Its name.
        expression : casadi.SX
            s(x, tau, p), positive but at the event itself.
        motion : Motion
            That of the coordinate.
        after : casadi.SX
            Its new velocity; those that inertia couples to it change along.
        """
        self.impacts[len(self.switches)] = motion, after
        self.switch(name, expression, -1)

    def holds(self, name: str, deflection: ca.SX, scale: float, unit: str) -> ca.SX:
        """Say where the joint at the next switch may be held all along; return how far it is from there.

        Parameters
        ----------
        name : str
            What is held.
        deflection : casadi.SX
            How far it is deflected: the switch is its rate, but for a factor.
        scale, unit : float, str
            Of the deflection.

        Returns
        -------
        casadi.SX
            The deflection less the parameter that says where it is held, scaled.
        """
        known = [each for each, _ in self.places_held.values()]
        again = sum(each.startswith(f"place of {name}") for each in known)
        called = f"place of {name}" + (f" ({again + 1})" if again else "")
        place = self.parameter(Parameter(called, 0.0, unit), called, unit)
        found = (deflection - place) / scale
        self.places_held[len(self.switches)] = called, found
        return found

    def slider(self, name: str, state: State, row: ca.SX, elongation: ca.SX, limit: ca.SX) -> None:
        """Add an elastic slider: z is held while -l < e - z < l, and carried along where e - z = l or -l.

        Parameters
        ----------
        name : str
            Its name.
        state : State
            z.
        row : casadi.SX
            The row of z where the state decides, as that of one who creeps.
        elongation, limit : casadi.SX
            e and l, functions of coordinates and the phase; all in the unit of z.
        """
        index, scale, rates = len(self.switches), state.scale, (self.rate(elongation), self.rate(limit))
        speeds = tuple((rates[0] - way * rates[1]) / scale for way in (1, -1))
        slipping = tuple(state.derivative / scale - speed for speed in speeds)
        place = self.holds(state.name, state.symbol, scale, state.unit)
        self.sliders[index] = Slider(
            state=state,
            row=len(self.differential_rows),
            held=state.derivative / scale,
            slipping=(slipping[0], slipping[1]),
            releases=(index + 1, index + 2),
            speeds=(speeds[0], speeds[1]),
            place=place,
        )
        self.differential_rows.append(row)
        self.switch(f"{name}: strained", rates[0] / scale, 0)
        self.switch(f"{name}: slips up", (elongation - state.symbol - limit) / scale, 1)
        self.switch(f"{name}: slips down", (elongation - state.symbol + limit) / scale, -1)

    def relay(self, u: ca.SX, on: ca.SX, off: ca.SX) -> ca.SX:
        """Add a relay with hysteresis: on where u has risen through `on`, off where it fell through `off`.

        Parameters
        ----------
        u, on, off : casadi.SX
            What is compared, and the thresholds: functions of states, phase and parameters.

        Returns
        -------
        casadi.SX
            Its symbol, 1 where it is on and -1 where it is off; that of the same relay if there is one.
        """
        over, under = u - on, u - off
        for known in self.relays.values():
            if ca.is_equal(known.over, over, SAME_GRAPH) and ca.is_equal(known.under, under, SAME_GRAPH):
                return known.symbol
        index = len(self.switches)
        symbol = ca.SX.sym(f"relay_{len(self.relays) + 1}")
        self.relays[index] = Relay(symbol, over, under)
        self.switch(f"relay {len(self.relays)}", over, 0)
        return symbol

    def smooth_at(self, expression: ca.SX) -> None:
        """Say that the equations have no kink where an expression vanishes, though branches meet there.

        Parameters
        ----------
        expression : casadi.SX
            The switching argument of an fmax, fmin or if_else that only guards against overflow.
        """
        self.smooth.append(expression)
