"""What tables of a scene refer to: coordinates and shared parameters by name, objects of inline tables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import TypeVar

from symbolic.equations.variables import Coordinate, Parameter
from symbolic.parts.structure import Structure
from symbolic.scenes.errors import InputError, listed, shown

T = TypeVar("T")

MOST_NAMES = 12
"""Most names that an error message lists."""


@dataclass(frozen=True)
class Bench:
    """Coordinates, structures and parameters by name, and `places`: objects made from inline tables.

    Parts with equal inline tables share one object, such as the contact pair that they all act on.
    """

    coordinates: dict[str, Coordinate] = field(default_factory=dict)
    structures: dict[str, Structure] = field(default_factory=dict)
    parameters: dict[str, Parameter] = field(default_factory=dict)
    places: dict[str, object] = field(default_factory=dict)

    def coordinate(self, where: str, name: str) -> Coordinate:
        """Return a coordinate by name, or that of a structure by "STRUCTURE.PLACE". Raises InputError."""
        owner, dot, place = name.partition(".")
        if dot and owner in self.structures and name not in self.coordinates:
            return _freedom(self.structures[owner], where, owner, place)
        return _known(self.coordinates, where, name, "the name of a [[coordinate]]")

    def parameter(self, where: str, name: str) -> Parameter:
        """Return a shared parameter by name. Raises InputError."""
        return _known(self.parameters, where, name, "a number or the name of one in [parameters]")

    def place(self, table: object, make: Callable[[], object]) -> object:
        """Return the object that an inline table stands for: one for all tables that are equal."""
        key = repr(table)
        if key not in self.places:
            self.places[key] = make()
        return self.places[key]


def _freedom(structure: Structure, where: str, owner: str, place: str) -> Coordinate:
    """The coordinate of a place with one degree of freedom. Raises InputError."""
    if place not in structure.at:
        raise unknown(where, place, list(structure.at), f"a place of the structure {owner}")
    found = structure[place]
    if not isinstance(found, Coordinate):
        raise InputError(where, f"is {shown(place)}, of several coordinates", "it must be a place of one")
    return found


def nearest(name: str, names: list[str]) -> str:
    """Return the one of some names that a misspelt name is nearest to; "" where none is near."""
    small = {each.lower(): each for each in names}
    found = get_close_matches(name.lower(), list(small), n=1, cutoff=0.5)
    return small[found[0]] if found else ""


def unknown(where: str, name: object, names: list[str], allowed: str) -> InputError:
    """Return the error for a name that is none of `names`; it tells the nearest of these."""
    near = nearest(str(name), names)
    first = names if len(names) <= MOST_NAMES else [*names[:MOST_NAMES], "others"]
    known = f"nearest is {shown(near)}" if near else f"there is {listed(first, 'and') or 'none'}"
    return InputError(where, f"is {shown(name)}", f"it must be {allowed}; {known}")


def _known(known: dict[str, T], where: str, name: str, allowed: str) -> T:
    if name not in known:
        raise unknown(where, name, list(known), allowed)
    return known[name]
