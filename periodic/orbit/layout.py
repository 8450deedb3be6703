"""What the numbers of an orbit mean: names, units and scales of its states, unknowns and parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from periodic.checks import line
from periodic.orbit.scheme import Array
from periodic.system import System, VariableLike, frequency_factor_of, frequency_held_of, frequency_of

KINDS = {"states": "states", "algebraics": "unknowns", "parameters": "parameters"}
"""The groups that make an orbit's numbers, and what a sentence calls them."""


@dataclass(frozen=True)
class Quantity:
    """A state, unknown, output or parameter: SI value = scale * internal value.

    Parameters
    ----------
    name, unit : str
        Its name and its unit in SI.
    scale : float
        SI value of one internal unit.

    Raises
    ------
    ValueError
        For a name or a unit that is no line of text: both are printed, and written into files.
    """

    name: str
    unit: str = ""
    scale: float = 1.0

    def __post_init__(self) -> None:
        line("name of a quantity", self.name)
        line(f"unit of {self.name!r}", self.unit)


class Source(Enum):
    """Which of an orbit's arrays: its states, their dx/dtau, its unknowns."""

    STATE = "state"
    RATE = "rate"
    ALGEBRAIC = "algebraic"


@dataclass(frozen=True)
class Column:
    """Where a named signal is found among an orbit's arrays.

    Parameters
    ----------
    name, unit : str
        The signal's name and its unit in SI.
    index : int
        Column of the states, or of the unknowns.
    scale : float
        SI value of one internal unit.
    order : int
        How many derivatives in time it is away from a quantity of a unit of its own: each brings a factor
        Omega, d/dt = Omega d/dtau.
    source : Source
        The array.
    """

    name: str
    unit: str
    index: int
    scale: float
    order: int = 0
    source: Source = Source.STATE


@dataclass(frozen=True)
class Layout:
    """Names, units and scales of a system's quantities.

    The state `x'` of a coordinate `x` is dx/dtau, in the unit of `x`; velocities are made of it with Omega.

    Parameters
    ----------
    states, algebraics, outputs, parameters : tuple of Quantity
        In the system's order.
    frequency : tuple of str
        Names of the parameters whose product is Omega (rad/s), d/dt = Omega d/dtau; none where the system
        does not tell.
    factor : float
        What that product is multiplied by to be Omega.
    held : tuple of (str, float)
        Values of parameters (SI) at which alone that factor is right.
    """

    states: tuple[Quantity, ...]
    algebraics: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    parameters: tuple[Quantity, ...]
    frequency: tuple[str, ...] = ()
    factor: float = 1.0
    held: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        known = [q.name for q in self.parameters]
        for name in self.frequency:
            if name not in known:
                raise ValueError(f"frequency has {name!r}; it must name parameters: {', '.join(known)}")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of states and unknowns."""
        return tuple(q.name for q in (*self.states, *self.algebraics))

    def omega(self, parameter: Array) -> float:
        """Return the angular frequency Omega at an orbit's parameters.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            Scaled parameters.

        Returns
        -------
        float
            Omega in rad/s.

        Raises
        ------
        ValueError
            Where the system does not tell it, or it is not positive.
        """
        if not self.frequency:
            raise ValueError(
                "times in s are not known; the system must name the parameters that make its frequency"
            )
        values = {q.name: q.scale * float(v) for q, v in zip(self.parameters, parameter, strict=True)}
        for name, value in self.held:
            if not math.isclose(values[name], value, rel_tol=1e-12):
                raise ValueError(
                    f"times in s are not known for {name} = {values[name]:.9g}, only for {value:.9g}, its "
                    f"nominal value; compile the model with {name} = {values[name]:.9g}"
                )
        found = self.factor * math.prod(values[name] for name in self.frequency)
        if not 0 < found < math.inf:
            raise ValueError(f"frequency {' * '.join(self.frequency)} is {found}; it must be positive")
        return found

    def units(self, parameter: Array) -> dict[str, float]:
        """Return SI values of one internal unit of each state, by name: x' is dx/dtau inside, dx/dt outside.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            Scaled parameters.

        Returns
        -------
        dict of str to float
            In the states' order.

        Raises
        ------
        ValueError
            Where there are velocities, and the system does not tell Omega.
        """
        columns = [self.column(q.name) for q in self.states]
        omega = self.omega(parameter) if any(c.order for c in columns) else 1.0
        return {c.name: c.scale * omega**c.order for c in columns}

    def column(self, name: str) -> Column:
        """Return where a named signal is found.

        Parameters
        ----------
        name : str
            A state, its time derivative (a prime more), or an unknown.

        Returns
        -------
        Column
            Array, index and factor.

        Raises
        ------
        ValueError
            For another name; it says which there are.
        """
        states = {q.name: k for k, q in enumerate(self.states)}
        unknowns = {q.name: k for k, q in enumerate(self.algebraics)}
        if name in unknowns and name not in states:
            q = self.algebraics[unknowns[name]]
            return Column(name, q.unit, unknowns[name], q.scale, source=Source.ALGEBRAIC)
        held = name if name in states else str(name).removesuffix("'")
        if held not in states:
            raise ValueError(f"orbit has no {name!r}; it has {', '.join(self.names)}")
        origin = held
        while origin.endswith("'") and origin[:-1] in states:
            origin = origin[:-1]
        order, q = len(name) - len(origin), self.states[states[held]]
        unit = self.states[states[origin]].unit
        source = Source.STATE if held == name else Source.RATE
        return Column(name, _per_time(unit, order), states[held], q.scale, order, source)

    def fits(self, system: System) -> bool:
        """Return whether states, unknowns and parameters have the names, units and scales of a system's.

        Parameters
        ----------
        system : System
            The system.

        Returns
        -------
        bool
            Whether they have.
        """
        return all(
            len(own) == len(others)
            and all(
                (q.name, q.unit, q.scale) == (v.name, v.unit, v.scale)
                for q, v in zip(own, others, strict=True)
            )
            for own, others in (
                (self.states, system.states),
                (self.algebraics, system.algebraics),
                (self.parameters, system.parameters),
            )
        )

    def factors(self, other: Layout, whose: str = "orbit") -> tuple[list[float], list[float], list[float]]:
        """Return the factors that turn internal values into those of another layout.

        Parameters
        ----------
        other : Layout
            The layout to express them in.
        whose : str
            What has them: the subject of the refusal.

        Returns
        -------
        tuple of list of float
            One factor each for every state, unknown and parameter.

        Raises
        ------
        ValueError
            Where names or units differ.
        """
        pairs = [(getattr(self, kind), getattr(other, kind)) for kind in KINDS]
        for (own, others), kind in zip(pairs, KINDS.values(), strict=True):
            if [(q.name, q.unit) for q in own] != [(q.name, q.unit) for q in others]:
                found, wanted = _listed(own), _listed(others)
                raise ValueError(f"{whose} has the {kind} {found}; it must have the system's, {wanted}")
        states, unknowns, parameters = (
            [a.scale / b.scale for a, b in zip(*pair, strict=True)] for pair in pairs
        )
        return states, unknowns, parameters


def _per_time(unit: str, order: int) -> str:
    return unit if order == 0 else f"{unit or '1'}/s" + (f"^{order}" if order > 1 else "")


def _listed(quantities: Sequence[Quantity]) -> str:
    return ", ".join(f"{q.name} ({q.unit})" if q.unit else q.name for q in quantities) or "none"


def layout_of(system: System) -> Layout:
    """Return names, units and scales of a system's quantities.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    Layout
        What its arrays mean.
    """

    def quantities(variables: Sequence[VariableLike]) -> tuple[Quantity, ...]:
        return tuple(Quantity(v.name, v.unit, float(v.scale)) for v in variables)

    return Layout(
        quantities(system.states),
        quantities(system.algebraics),
        quantities(system.outputs),
        quantities(system.parameters),
        frequency_of(system),
        frequency_factor_of(system),
        tuple(frequency_held_of(system).items()),
    )
