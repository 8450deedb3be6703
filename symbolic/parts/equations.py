"""Differential equations of the first order written as a function, perhaps with algebraic ones."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any

import casadi as ca

from symbolic.checks import finite, mapping, numbers, positive, refusal, typed
from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.terms import State
from symbolic.equations.variables import Coordinate, Parameter, Value
from symbolic.parts.calls import Function, called, check_taken


class Names:
    """Symbols by name, as attributes or items; `kind` is what an error calls them."""

    def __init__(self, kind: str, symbols: Mapping[str, ca.SX]) -> None:
        self._kind, self._symbols = kind, dict(symbols)

    def __getitem__(self, name: str) -> ca.SX:
        if name not in self._symbols:
            raise ValueError(
                f"the equations use {self._kind}.{name}; {self._kind} has {_listed(self._symbols)}"
            )
        return self._symbols[name]

    def __getattr__(self, name: str) -> ca.SX:
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name]


@dataclass(frozen=True)
class Equations(Part):
    """dx/dt = f(x, p), and 0 = g(x, z, p) with unknowns z.

    Functions are called once, with symbols as attributes: x.NAME of states and unknowns, p.NAME of the
    parameters, and in an excited system wave.sin and wave.cos of tau = Omega t as a third argument, and
    wave.angle, tau itself: 0 where the system is not excited, for terms that repeat with tau. Of coordinates
    of other parts they see the position x.NAME (SI) and the speed x.NAME_dot.

    Parameters
    ----------
    function : callable
        Returns the rate (SI, per s) of each state by its name, under the name of each unknown what shall
        vanish, and perhaps a force under the name of a coordinate.
    states : mapping of str to float
        Values from which the search for a rest starts.
    parameters : mapping of str to float or Parameter
        Nominal values.
    unknowns : mapping of str to float
        Algebraic unknowns, as `states`.
    coordinates : sequence of Coordinate
        Coordinates of other parts.
    frequency : str, optional
        The parameter that is the angular frequency Omega (rad/s) of an excitation.
    scales : mapping of str to float
        Sizes (SI) of states taken as one inside.
    outputs : callable, optional
        Returns further outputs by name; each state is one.
    switches : callable, optional
        Returns by name functions of states, phase and parameters that vanish where the equations have a kink
        or a jump. Those that fmax, fmin, fabs, sign and if_else bring are found without it; a kink in an
        unknown cannot be one, and is left to the mesh and its error estimate.
    resets : callable, optional
        Returns by name pairs (s, {state: new value}): where s, positive between these events, falls to 0, the
        states named are given new values; {"wall": (p.d - x.x, {"v": -p.e * x.v})} is an impact. `x_dot` is
        the speed of a coordinate x.

    Raises
    ------
    ValueError
        In one sentence, for names or values that do not fit; some on compilation.
    """

    function: Function
    states: Mapping[str, float]
    parameters: Mapping[str, Value] = field(default_factory=dict)
    _: KW_ONLY
    unknowns: Mapping[str, float] = field(default_factory=dict)
    coordinates: Sequence[Coordinate] = ()
    frequency: str | None = None
    scales: Mapping[str, float] = field(default_factory=dict)
    outputs: Function | None = None
    switches: Function | None = None
    resets: Callable[..., Mapping[str, tuple[Any, Mapping[str, Any]]]] | None = None

    def __post_init__(self) -> None:
        self._check_types()
        groups = (self.states, self.unknowns, [c.name for c in self.coordinates], self.parameters)
        names = [name for group in groups for name in group]
        for name in names:
            if not isinstance(name, str) or not name.isidentifier() or name.startswith("_"):
                raise ValueError(f"name of a variable is {name!r}; it must be one that Python allows")
            if names.count(name) > 1:
                raise ValueError(f"{name!r} is the name of two variables; every one needs its own")
        _fitting("scales", self.scales, self.states, all_needed=False)
        if self.frequency is not None and self.frequency not in self.parameters:
            raise ValueError(
                f"frequency is {self.frequency!r}; it must be one of the parameters "
                f"{_listed(self.parameters)}"
            )
        if self.frequency is None and "omega" in self.parameters:
            raise ValueError(
                "parameter 'omega' is 2 pi / period of the orbits of equations without excitation; "
                "name yours otherwise"
            )

    def _check_types(self) -> None:
        optional = {"outputs": self.outputs, "switches": self.switches, "resets": self.resets}
        for name, function in {"function": self.function, **optional}.items():
            if not callable(function) and (function is not None or name not in optional):
                raise refusal(name, function, "a function of x and p")
        numbers("states", self.states, "rest value")
        numbers("unknowns", self.unknowns, "rest value")
        for name, scale in mapping("scales", self.scales).items():
            positive(f"scale of {name}", scale)
        for name, value in mapping("parameters", self.parameters).items():
            if not isinstance(value, Parameter):
                finite(f"parameter {name!r}", value)
        if isinstance(self.coordinates, Coordinate):
            raise refusal("coordinates", self.coordinates, "a sequence of Coordinates")
        for each in self.coordinates:
            typed("one of coordinates", each, Coordinate, "a Coordinate, as symbolic.coordinate returns it")

    def contribute(self, assembly: Assembly) -> None:
        """Add the states with their rows, the unknowns with theirs, forces on coordinates, and outputs."""
        p = {name: assembly.parameter(value, name) for name, value in self.parameters.items()}
        if self.frequency is not None:
            assembly.excite(p[self.frequency])
        states = {
            name: assembly.state(name, "", float(self.scales.get(name, 1.0)), ca.SX(float(rest)))
            for name, rest in self.states.items()
        }
        symbols = {name: state.symbol for name, state in states.items()}
        symbols |= {name: assembly.algebraic(name, ca.SX(float(z))) for name, z in self.unknowns.items()}
        for q in self.coordinates:
            symbols |= {q.name: assembly.motion(q).position.symbol, f"{q.name}_dot": assembly.speed_of(q)}
        arguments: list[object] = [Names("x", symbols), Names("p", p)]
        if self.frequency is not None:
            wave = {"sin": assembly.sine, "cos": assembly.cosine, "angle": assembly.phase}
            arguments.append(Names("wave", wave))

        found = called("function", self.function, arguments)
        wanted = [*states, *self.unknowns]
        _fitting("the function's result", found, wanted, [q.name for q in self.coordinates])
        for name, state in states.items():
            row = assembly.omega * state.derivative - found[name]
            assembly.differential_rows.append(row / state.scale)
            assembly.output(name, "", state.symbol)
        _determined({name: found[name] for name in self.unknowns}, [symbols[name] for name in self.unknowns])
        assembly.algebraic_rows.extend(found[name] for name in self.unknowns)
        for q in self.coordinates:
            assembly.motion(q).force += found.get(q.name, ca.SX(0))
        if self.outputs is not None:
            for name, expression in called("outputs", self.outputs, arguments).items():
                assembly.output(name, "", expression)
        if self.switches is not None:
            for name, expression in called("switches", self.switches, arguments).items():
                self._check_switch(name, expression, symbols)
                assembly.switch(name, expression, 0)
        if self.resets is not None:
            self._reset(assembly, states, arguments, symbols)

    def _reset(
        self,
        assembly: Assembly,
        states: Mapping[str, State],
        arguments: Sequence[object],
        symbols: Mapping[str, ca.SX],
    ) -> None:
        """Add the events at which states are given new values."""
        known = dict(states)
        for q in self.coordinates:
            motion = assembly.motion(q)
            known |= {q.name: motion.position, f"{q.name}_dot": motion.velocity}
        check_taken("resets", self.resets, len(arguments))
        flat = called("resets", lambda *given: _flat(self.resets, given), arguments)
        events = [name for name in flat if " of " not in name]
        for event in events:
            self._check_switch(event, flat[event], symbols)
            to: dict[State, ca.SX] = {}
            for key in (key for key in flat if key.endswith(f" of {event}")):
                name = key.removesuffix(f" of {event}")
                _fitting(f"resets[{event!r}]", [name], known, all_needed=False)
                self._check_switch(key, flat[key], symbols)
                speed = name.removesuffix("_dot") in [q.name for q in self.coordinates if q.name != name]
                to[known[name]] = flat[key] / assembly.omega if speed else flat[key]
            assembly.reset(event, flat[event], to)

    def _check_switch(self, name: str, expression: ca.SX, symbols: Mapping[str, ca.SX]) -> None:
        used = {symbol.element_hash() for symbol in ca.symvar(expression)}
        for unknown in self.unknowns:
            if symbols[unknown].element_hash() in used:
                raise ValueError(
                    f"switch {name!r} depends on the unknown {unknown}; "
                    f"it must be a function of states, phase and parameters"
                )


def _flat(resets: Callable[..., object] | None, arguments: Sequence[object]) -> dict[str, Any]:
    """What `resets` returns as one mapping: s under the name of an event, "v of wall" for a new value."""
    found = resets(*arguments) if resets is not None else {}
    allowed = "a mapping of names to pairs (s, {state: new value})"
    if not isinstance(found, Mapping):
        raise refusal("what resets returned", found, allowed)
    flat: dict[str, Any] = {}
    for event, pair in found.items():
        if " of " in str(event):
            raise refusal("name of a reset", event, "a name without ' of ' in it")
        if not (isinstance(pair, tuple) and len(pair) == 2 and isinstance(pair[1], Mapping) and pair[1]):
            raise refusal(f"resets[{event!r}]", pair, "a pair (s, {state: new value})")
        flat[str(event)] = pair[0]
        flat |= {f"{state} of {event}": value for state, value in pair[1].items()}
    return flat


def _determined(rows: dict[str, ca.SX], unknowns: list[ca.SX]) -> None:
    """Refuse rows that do not tell the unknowns, whatever their values: their index is above 1."""
    if not rows:
        return
    symbols, each = ca.vertcat(*unknowns), ca.vertcat(*rows.values())
    if ca.sprank(ca.jacobian(each, symbols)) == len(rows):
        return
    empty = [name for name, row in rows.items() if not ca.depends_on(row, symbols)]
    why = f"that of {empty[0]!r} contains none of them" if empty else "they contain too few of them"
    raise ValueError(
        f"unknowns has {', '.join(map(repr, rows))}, not determined by their equations: {why} "
        f"(index above 1); they must be differentiated in time until they determine them"
    )


def _fitting(
    kind: str,
    given: Iterable[str],
    wanted: Iterable[str],
    optional: Iterable[str] = (),
    *,
    all_needed: bool = True,
) -> None:
    """Raise ValueError for names that are not wanted, or wanted ones that are missing."""
    allowed = [*wanted, *optional]
    for name in given:
        if name not in allowed:
            raise ValueError(f"{kind} has {name!r}; it must be one of {_listed(allowed)}")
    missing = [name for name in wanted if name not in given] if all_needed else []
    if missing:
        raise ValueError(f"{kind} has no {_listed(missing)}; it must have {_listed(wanted)}")


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "none"
