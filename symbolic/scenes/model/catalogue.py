"""The parts that scenes can name, with their keys: what their classes' fields and docstrings say.

Parts are those of `symbolic.parts`, those that a program registers, and those of installed packages under the
entry point "orbitrace.parts". Nothing is ever taken from a scene file.
"""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
import typing
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from functools import cache
from importlib.metadata import entry_points
from types import ModuleType
from typing import Any, cast

import symbolic.parts
from symbolic import films
from symbolic.equations.model import Part
from symbolic.scenes.errors import InputError, listed, shown
from symbolic.scenes.laws import contact_laws
from symbolic.scenes.model.bench import Bench, nearest, unknown
from symbolic.scenes.model.described import Described, described
from symbolic.scenes.model.readers import CoordinateName, Reader, UnreadableError, reader_of

ENTRY_POINT = "orbitrace.parts"
"""Entry point group under which installed packages name their modules with parts."""

KIND = "kind"
"""The key that says which class a table stands for."""

_registered: dict[str, type[Part]] = {}
_own: list[ModuleType] = []


@dataclass(frozen=True)
class Key:
    """A key of a table: name, text and default of its field (MISSING where it must be given), its reader."""

    name: str
    text: str
    default: Any
    reader: Reader

    @property
    def needed(self) -> bool:
        """Whether the key must be given."""
        return self.default is MISSING


@dataclass(frozen=True)
class Entry:
    """A class that a table can stand for, or a function by whose arguments an object is built."""

    owner: Callable[..., Any]
    text: Described
    keys: tuple[Key, ...]

    @property
    def name(self) -> str:
        """What scenes call it: the name of the class."""
        return self.owner.__name__

    def made(self, bench: Bench, where: str, table: Mapping[str, Any]) -> Any:
        """Return the object that a table, without its kind, stands for. Raises InputError."""
        known = {key.name: key for key in self.keys}
        for name in table:
            if name not in known:
                near = nearest(name, list(known))
                may = f"nearest is {near}; " if near else ""
                what = f"{where} {shown(name)}"
                raise InputError(what, "is not a key", f"{may}it may have {listed(list(known), 'and')}")
        for key in self.keys:
            if key.needed and key.name not in table:
                raise InputError(f"{where} {key.name}", "is missing", f"it must be {key.reader.allowed}")
        given = {
            name: known[name].reader.read(bench, f"{where} {name}", value) for name, value in table.items()
        }
        try:
            return self.owner(**given)
        except ValueError as error:
            raise InputError.said(f"{where}: {error}") from None

    @property
    def example(self) -> dict[str, Any]:
        """A table with what must be given."""
        own, names = dict(getattr(self.owner, "EXAMPLE", {})), iter("xyzuvw")
        found = {}
        for key in self.keys:
            if key.needed or key.name in own:
                usual = next(names) if isinstance(key.reader, CoordinateName) else key.reader.example
                found[key.name] = own.get(key.name, usual)
        return found


@dataclass(frozen=True)
class Inline:
    """A table for an object that a part holds: a law, a profile; `kind` chooses where there are several."""

    entries: tuple[Entry, ...]

    @property
    def allowed(self) -> str:
        """The kinds, or the keys of the only one."""
        if len(self.entries) == 1:
            return f"a table with {listed([key.name for key in self.entries[0].keys], 'and')}"
        return f"a table of the kind {listed([entry.name for entry in self.entries])}"

    @property
    def example(self) -> dict[str, Any]:
        """That of the first kind."""
        kind = {KIND: self.entries[0].name} if len(self.entries) > 1 else {}
        return kind | self.entries[0].example

    def read(self, bench: Bench, where: str, value: Any) -> Any:
        """Return the object; equal tables give the same one."""
        if not isinstance(value, dict):
            raise InputError(where, "is no table", f"it must be {self.allowed}")
        names = {entry.name: entry for entry in self.entries}
        known = listed(list(names))
        kind = value.get(KIND, self.entries[0].name if len(self.entries) == 1 else None)
        if kind is None:
            raise InputError(f"{where} {KIND}", "is missing", f"it must be {known}")
        if not isinstance(kind, str) or kind not in names:
            raise unknown(f"{where} {KIND}", kind, list(names), known)
        table = {name: item for name, item in value.items() if name != KIND}
        return bench.place((kind, table), lambda: names[kind].made(bench, where, table))


def register_part(part: type[Part]) -> None:
    """Let scenes of the kind "model" name a part: `kind = "CLASS"` in a table [[part]].

    Parameters
    ----------
    part : type of Part
        A dataclass; its fields are the keys, its docstring describes them.

    Raises
    ------
    ValueError
        For what is no dataclass, and for a name that another part has.
    """
    if not _is_part(part):
        raise ValueError(
            f"part is {part!r}; it must be a class that inherits from symbolic.Part, a dataclass"
        )
    known = _built_in().get(part.__name__, part)
    if known is not part:
        raise ValueError(f"part {part.__name__!r} is one of symbolic's own already; give yours another name")
    _registered[part.__name__] = part
    catalogue.cache_clear()


def register_module(name: str) -> None:
    """Import a module and register all parts that it holds. Raises InputError."""
    try:
        module = importlib.import_module(name)
    except Exception as error:  # whatever a user's own module raises
        why = f"{type(error).__name__}: {error}"
        raise InputError(
            "--parts", f'is "{name}" ({why})', "it must be a module that can be imported"
        ) from error
    found = list(_parts_in(module))
    if not found:
        raise InputError(
            "--parts", f'is "{name}", which has no part', "it must hold classes of symbolic.Part"
        )
    _own.append(module)
    for part in found:
        try:
            register_part(part)
        except ValueError as error:
            raise InputError.said(str(error)) from None


@cache
def catalogue() -> dict[str, Entry]:
    """Return all parts that a scene file can describe, by name in alphabetical order. Raises InputError."""
    for point in entry_points(group=ENTRY_POINT):
        try:
            given = list(_parts_in(point.load()))
        except Exception as error:  # whatever another package raises
            what = f"{point.name} cannot be loaded ({type(error).__name__}: {error})"
            raise InputError("entry point", what, "its package must be mended or removed") from error
        for part in given:
            _registered.setdefault(part.__name__, part)
    found = {**_built_in(), **_registered}
    entries = {name: entry for name in sorted(found) if (entry := entry_of(found[name])) is not None}
    return dict(entries)


def entry_of(owner: Callable[..., Any]) -> Entry | None:
    """Return the entry of a class or function; None where a scene file cannot give a required argument."""
    return _entry(owner, ())


def _entry(owner: Callable[..., Any], within: tuple[Any, ...]) -> Entry | None:
    """The same for a class nested in the classes `within`, which it may not hold in turn."""
    text, hints = described(owner), typing.get_type_hints(owner)
    keys = []
    for name, default in _arguments(owner):
        try:
            reader = _reader(hints[name], (*within, owner))
            keys.append(Key(name, text.parameters.get(name, ""), default, reader))
        except UnreadableError:
            if default is MISSING:
                return None
    return Entry(owner, text, tuple(keys))


def _arguments(owner: Callable[..., Any]) -> Iterator[tuple[str, Any]]:
    """The arguments of a dataclass or function with their defaults, MISSING where there is none."""
    if not dataclasses.is_dataclass(owner):
        for name, parameter in inspect.signature(owner).parameters.items():
            yield name, MISSING if parameter.default is parameter.empty else parameter.default
        return
    for field in fields(owner):
        if field.init:
            made = field.default_factory
            yield field.name, field.default if made is MISSING else made()


def _reader(annotation: Any, within: tuple[Any, ...]) -> Reader:
    return reader_of(annotation, lambda kind: _inline(kind, within))


def _inline(kind: type, within: tuple[Any, ...]) -> Reader | None:
    """The tables for a class, or for all classes that follow a protocol."""
    if getattr(kind, "_is_protocol", False):
        wanted = {n: v for n, v in vars(kind).items() if inspect.isfunction(v) and n[0] != "_"}
        owners = [owner for owner in _objects() if all(_takes(owner, n, v) for n, v in wanted.items())]
    else:
        owners = [owner for owner in _objects() if issubclass(owner, kind)]
    found = [_entry(owner, within) for owner in owners if owner not in within]
    entries = [entry for entry in found if entry is not None]
    return Inline(tuple(entries)) if entries else None


def _takes(owner: type, name: str, wanted: Callable[..., Any]) -> bool:
    """Whether a class has the method of a protocol, for as many arguments."""
    method = getattr(owner, name, None)
    if not callable(method):
        return False
    try:
        inspect.signature(method).bind(*inspect.signature(wanted).parameters)
    except TypeError:
        return False
    return True


@cache
def _built_in() -> dict[str, type[Part]]:
    return {part.__name__: part for module in _modules() for part in _parts_in(module)}


def _objects() -> tuple[type, ...]:
    """Dataclasses that parts may hold: public ones, contact laws, those of user modules; no parts."""
    public = importlib.import_module("symbolic")
    given = [getattr(namespace, name) for namespace in (public, films) for name in namespace.__all__]
    given += contact_laws().values()
    given += [value for module in _own for value in vars(module).values()]
    chosen = {v.__name__: v for v in given if dataclasses.is_dataclass(v) and inspect.isclass(v)}
    return tuple(v for _, v in sorted(chosen.items()) if not issubclass(v, Part))


@cache
def _modules() -> tuple[ModuleType, ...]:
    names = [found.name for found in pkgutil.walk_packages(symbolic.parts.__path__, "symbolic.parts.")]
    return tuple(importlib.import_module(name) for name in names)


def _is_part(value: Any) -> bool:
    known = inspect.isclass(value) and issubclass(value, Part) and dataclasses.is_dataclass(value)
    return known and not inspect.isabstract(value)


def _parts_in(module: Any) -> Iterator[type[Part]]:
    """The public parts that a module defines; given a part class, that class alone."""
    if _is_part(module):
        yield cast(type[Part], module)
        return
    for name, value in vars(module).items():
        if _is_part(value) and value.__module__ == module.__name__ and name[0] != "_":
            yield cast(type[Part], value)
