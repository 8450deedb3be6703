"""How a value of a scene is read as the type that a part's field has: one reader for each kind of type."""

from __future__ import annotations

import collections.abc
import enum
import inspect
import types
import typing
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from symbolic.equations.variables import Coordinate, Parameter
from symbolic.parts.contact.pair import ContactPair
from symbolic.scenes.errors import InputError, listed, refused, shown
from symbolic.scenes.model.bench import Bench

NUMBERS = (int, float)

LARGEST_NUMBER = 1e300
"""Numbers that are larger are none of physics."""

ORDER = {int, float, str, Fraction}
"""The types of `symbolic.equations.excitation.Order`."""


class UnreadableError(TypeError):
    """A type that text cannot give: a function, or a model."""


class Reader(Protocol):
    """Reads a value of a scene file."""

    @property
    def allowed(self) -> str:
        """What a value must be, in words."""

    def read(self, bench: Bench, where: str, value: Any) -> Any:
        """Return what a value stands for. Raises InputError, calling it `where`."""

    @property
    def example(self) -> Any:
        """A value as in a file."""


@dataclass(frozen=True)
class Plain:
    """A value of TOML's own types."""

    kinds: tuple[type, ...]
    allowed: str
    example: Any

    def read(self, bench: Bench, where: str, value: Any) -> Any:
        """Return the value, numbers finite."""
        wrong = not isinstance(value, self.kinds) or (bool not in self.kinds and isinstance(value, bool))
        if wrong or (_is_number(value) and not -LARGEST_NUMBER < value < LARGEST_NUMBER):
            raise refused(where, value, self.allowed)
        return float(value) if self.kinds == NUMBERS else value


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


@dataclass(frozen=True)
class Number:
    """A number that becomes a parameter of the model, or the name of a shared one."""

    allowed: str = "a number or the name of one in [parameters]"
    example: float = 1.0

    def read(self, bench: Bench, where: str, value: Any) -> float | Parameter:
        """Return the number or parameter."""
        if isinstance(value, str):
            return bench.parameter(where, value)
        return float(Plain(NUMBERS, self.allowed, self.example).read(bench, where, value))


@dataclass(frozen=True)
class CoordinateName:
    """A coordinate by its name."""

    allowed: str = "the name of a [[coordinate]]"
    example: str = "x"

    def read(self, bench: Bench, where: str, value: Any) -> Coordinate:
        """Return the coordinate."""
        if not isinstance(value, str):
            raise refused(where, value, self.allowed)
        return bench.coordinate(where, value)


@dataclass(frozen=True)
class PairOfCoordinates:
    """A contact pair: its coordinates, or a table with `coordinates` and `name`; the same is one pair."""

    allowed: str = 'a list of coordinates, or a table as {coordinates = ["x"], name = "upper"}'
    example: str = "x"

    def read(self, bench: Bench, where: str, value: Any) -> object:
        """Return the pair."""
        table = value if isinstance(value, dict) else {"coordinates": value}
        names, extra = table.get("coordinates"), table.keys() - {"coordinates", "name"}
        names = [names] if isinstance(names, str) else names
        if extra or not isinstance(names, list) or not names or not isinstance(table.get("name", ""), str):
            raise refused(where, value, self.allowed)
        coordinates = [CoordinateName().read(bench, where, name) for name in names]
        named = {"name": table["name"]} if "name" in table else {}
        return bench.place(("pair", names, named), lambda: ContactPair(*coordinates, **named))


@dataclass(frozen=True)
class Choice:
    """A member of an enumeration, by its name in small letters."""

    kind: type[enum.Enum]

    @property
    def _names(self) -> list[str]:
        return [member.name.lower().replace("_", "-") for member in self.kind]

    @property
    def allowed(self) -> str:
        """The names."""
        return listed([shown(name) for name in self._names])

    @property
    def example(self) -> str:
        """The first."""
        return self._names[0]

    def read(self, bench: Bench, where: str, value: Any) -> enum.Enum:
        """Return the member."""
        if value not in self._names:
            raise refused(where, value, self.allowed)
        return list(self.kind)[self._names.index(value)]


@dataclass(frozen=True)
class OneOf:
    """One of several texts."""

    names: tuple[str, ...]

    @property
    def allowed(self) -> str:
        """The texts."""
        return listed([shown(name) for name in self.names])

    @property
    def example(self) -> str:
        """The first."""
        return self.names[0]

    def read(self, bench: Bench, where: str, value: Any) -> str:
        """Return the text."""
        if not isinstance(value, str) or value not in self.names:
            raise refused(where, value, self.allowed)
        return value


@dataclass(frozen=True)
class Several:
    """A list, each item read in the same way."""

    item: Reader
    count: int | None = None

    @property
    def allowed(self) -> str:
        """As of the items."""
        return f"a list{f' of {self.count}' if self.count else ''}, each {self.item.allowed}"

    @property
    def example(self) -> list[Any]:
        """One or two items."""
        return [self.item.example] * (self.count or 1)

    def read(self, bench: Bench, where: str, value: Any) -> tuple[Any, ...]:
        """Return the items."""
        if not isinstance(value, list) or (self.count is not None and len(value) != self.count):
            raise refused(where, value, self.allowed)
        return tuple(self.item.read(bench, f"{where}[{k + 1}]", item) for k, item in enumerate(value))


@dataclass(frozen=True)
class Either:
    """The first of several ways that a value can be read."""

    readers: tuple[Reader, ...]

    @property
    def allowed(self) -> str:
        """Any of them."""
        return " or ".join(dict.fromkeys(reader.allowed for reader in self.readers))

    @property
    def example(self) -> Any:
        """That of the first."""
        return self.readers[0].example

    def read(self, bench: Bench, where: str, value: Any) -> Any:
        """Return what the first reader that takes the value makes of it."""
        errors = []
        for reader in self.readers:
            try:
                return reader.read(bench, where, value)
            except InputError as error:
                errors.append(error)
        raise errors[0] if len(errors) == 1 else refused(where, value, self.allowed)


def reader_of(annotation: Any, inner: typing.Callable[[type], Reader | None]) -> Reader:
    """Return how values of a type are read; `inner` knows the classes that inline tables stand for.

    Raises UnreadableError for a type that text cannot give.
    """
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin in (typing.Union, types.UnionType):
        return _union({a for a in arguments if a is not type(None)}, arguments, inner)
    if origin is typing.Literal and all(isinstance(a, str) for a in arguments):
        return OneOf(arguments)
    if origin in (tuple, list, collections.abc.Sequence):
        items = [a for a in arguments if a is not Ellipsis]
        fixed = origin is tuple and Ellipsis not in arguments
        if items and len(set(items)) == 1:
            return Several(reader_of(items[0], inner), len(items) if fixed else None)
    if annotation in PLAIN:
        return PLAIN[annotation]
    if inspect.isclass(annotation):
        if issubclass(annotation, enum.Enum):
            return Choice(annotation)
        if (found := inner(annotation)) is not None:
            return found
    raise UnreadableError(f"{annotation}")


def _union(
    kinds: set[Any], arguments: tuple[Any, ...], inner: typing.Callable[[type], Reader | None]
) -> Reader:
    if kinds >= ORDER:
        return PLAIN[Fraction]
    readers: list[Reader] = []
    if Parameter in kinds:
        readers.append(Number())
        kinds = kinds - {Parameter, float, int}
    for each in arguments:
        if each in kinds:
            try:
                readers.append(reader_of(each, inner))
            except UnreadableError:
                continue
    if not readers:
        raise UnreadableError(f"{arguments}")
    return readers[0] if len(readers) == 1 else Either(tuple(readers))


PLAIN: dict[Any, Reader] = {
    float: Plain(NUMBERS, "a number", 1.0),
    int: Plain((int,), "a whole number", 1),
    bool: Plain((bool,), "true or false", True),
    str: Plain((str,), "a text", "a"),
    Parameter: Number(),
    Coordinate: CoordinateName(),
    ContactPair: PairOfCoordinates(),
    Fraction: Plain((int, float, str), 'a positive rational number, or text as "1/2"', 1),
}
