"""The numbers of a model and their names: bare numbers are named by the field that they are given for, and by
its owner where that name is not unique.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import casadi as ca

from symbolic.equations.interval import ANY, Interval
from symbolic.equations.variables import Parameter, Value


@dataclass(frozen=True, eq=False)
class Number:
    """A number of a part: a user's parameter, or a bare number of an owner ("" for the model itself)."""

    parameter: Parameter
    owner: str
    bare: bool

    @property
    def kept(self) -> bool:
        """Whether its own name is the only one that it may have."""
        return not (self.bare and self.owner)


@dataclass(frozen=True)
class Numbers:
    """All numbers of a model, each under a symbol of its own.

    Numbers of one name and one value are one parameter. Where values differ, bare numbers take the name of
    their owner behind their own, as m_x and m_y; where one owner has several, they are counted in the order
    of the parts, as k_x_1 and k_x_2.
    """

    taken: list[Number] = field(default_factory=list)
    allowed: dict[Parameter, Interval] = field(default_factory=dict)
    _values: dict[int, float] = field(default_factory=dict, init=False)
    _groups: dict[tuple[str, str, float], list[Number]] = field(default_factory=dict, init=False)

    def symbol(self, value: Value, name: str, unit: str, owner: str, allowed: Interval = ANY) -> ca.SX:
        """Return the symbol of a part's number, one for all numbers of one owner, name and value."""
        bare = not isinstance(value, Parameter)
        wanted = value if isinstance(value, Parameter) else Parameter(name, value, unit)
        allowed.check(f"{name} of {owner}" if owner else name, wanted.value)
        own = self._taken(wanted, owner, bare)
        self.allowed[own] = allowed.within(self.allowed.get(own, ANY))
        return own.symbol

    def _taken(self, wanted: Parameter, owner: str, bare: bool) -> Parameter:
        """The equal number that exists already, or the new one."""
        among = self._groups.setdefault((owner, wanted.name, wanted.value), [])
        for known in among:
            if (known.bare and bare and _fits(known.parameter, wanted)) or known.parameter is wanted:
                return known.parameter
        if wanted.symbol.element_hash() in self._values:  # a user's parameter, of another part's already
            return wanted
        among.append(Number(wanted, owner, bare))
        self.taken.append(among[-1])
        self._values[wanted.symbol.element_hash()] = wanted.value
        return wanted

    def interval(self, symbols: list[ca.SX]) -> Interval:
        """Return the values that all numbers of one name may have, by their symbols."""
        found, wanted = ANY, {id(symbol) for symbol in symbols}
        for number, allowed in self.allowed.items():
            if id(number.symbol) in wanted:
                found = found.within(allowed)
        return found

    def value_of(self, symbol: ca.SX) -> float:
        """Return the nominal value of the parameter that a symbol stands for."""
        return self._values[symbol.element_hash()]

    def name_of(self, symbol: ca.SX) -> str:
        """Return the name of the parameter that a symbol stands for."""
        found = self.named().items()
        return next(name for name, (_, symbols) in found if any(own is symbol for own in symbols))

    def named(self) -> dict[str, tuple[Parameter, list[ca.SX]]]:
        """Return the parameters by name, in the order of the parts, with the symbols that stand for each.

        Raises ValueError where two of them get one name.
        """
        found: dict[str, tuple[Parameter, list[ca.SX]]] = {}
        groups: dict[str, list[Number]] = {}
        for number in self.taken:
            groups.setdefault(number.parameter.name, []).append(number)
        equal = {name for name, group in groups.items() if _all_fit([n.parameter for n in group])}
        for number in self.taken:
            own = number.parameter
            name = own.name if own.name in equal else _name(number, groups[own.name])
            if name not in found:
                found[name] = (own if own.name == name else Parameter(name, own.value, own.unit), [])
            first, symbols = found[name]
            if not _fits(first, own) or (not number.bare and self._rival(number)):
                raise ValueError(
                    f"parameter {name!r} is defined twice ({first.value} and {own.value}); "
                    f"share one symbolic.parameter, or give the second a name of its own"
                )
            symbols.append(own.symbol)
        return found

    def canonical(self, expression: ca.SX) -> ca.SX:
        """Return an expression with one symbol for all numbers of one name and value."""
        for k, number in enumerate(self.taken):
            first = next(n for n in self.taken[: k + 1] if _alike(n.parameter, number.parameter))
            expression = ca.substitute(expression, number.parameter.symbol, first.parameter.symbol)
        return expression

    def _rival(self, number: Number) -> bool:
        """Whether an earlier parameter of the user's has the same name."""
        same = [n for n in self.taken if not n.bare and n.parameter.name == number.parameter.name]
        return same[0] is not number


def _name(number: Number, group: list[Number]) -> str:
    """The name of one of several numbers that were given one name."""
    own = number.parameter
    if number.kept or all(_fits(n.parameter, own) for n in group):
        return own.name
    if any(n.kept and _fits(n.parameter, own) for n in group):
        return own.name
    mine = [n for n in group if not n.kept and n.owner == number.owner]
    behind = f"_{mine.index(number) + 1}" if len(mine) > 1 else ""
    return f"{own.name}_{number.owner}{behind}"


def _all_fit(group: list[Parameter]) -> bool:
    """Whether numbers of one name are one parameter, in whatever order they are looked at."""
    return len({p.value for p in group}) == 1 and len({p.unit for p in group} - {""}) <= 1


def _alike(a: Parameter, b: Parameter) -> bool:
    return a.name == b.name and _fits(a, b)


def _fits(a: Parameter, b: Parameter) -> bool:
    """Whether two numbers of one name may be one parameter: equal values, and no two units."""
    return a.value == b.value and (a.unit == b.unit or "" in (a.unit, b.unit))
