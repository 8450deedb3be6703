"""The public interface as text: calls with defaults, classes with fields and members, tables of scenes."""

from __future__ import annotations

import dataclasses
import enum
import importlib
import inspect
import re
from collections.abc import Callable, Iterator
from functools import cached_property
from types import ModuleType
from typing import Any, get_args

from pydantic import BaseModel

from symbolic.scenes.model.scene import ModelScene
from symbolic.scenes.schema import HertzDiscScene, LineDiscScene, OscillatorScene

PACKAGES = ("symbolic", "periodic")
KINDS = {
    property: "property",
    cached_property: "cached property",
    classmethod: "classmethod",
    staticmethod: "static",
}
BOUNDS = ("ge", "gt", "le", "lt", "min_length", "max_length", "pattern")
PLACE = re.compile(r" at 0x[0-9a-f]+|<(?:function|class) '?([\w.]+)'?[^>]*>")


SCENES = (HertzDiscScene, LineDiscScene, OscillatorScene, ModelScene)


def told(value: Any) -> str:
    """A default, without where it stands in memory."""
    return PLACE.sub(_named, repr(value))


def _named(found: re.Match[str]) -> str:
    return found[1] or ""


def signature(call: Callable[..., Any]) -> str:
    """The parameters, with defaults, without annotations."""
    given = inspect.signature(call)
    bare = [p.replace(annotation=p.empty) for p in given.parameters.values()]
    return PLACE.sub(_named, str(given.replace(parameters=bare, return_annotation=given.empty)))


def field(own: dataclasses.Field[Any]) -> str:
    """A field: its default, and how it differs from others."""
    given = own.default if own.default_factory is dataclasses.MISSING else own.default_factory
    default = "" if given is dataclasses.MISSING else f" = {told(given)}"
    usual = {"init": True, "repr": True, "compare": True, "kw_only": False}
    flags = [f"{name}={getattr(own, name)}" for name, value in usual.items() if getattr(own, name) != value]
    return " ".join([f"    {own.name}{default}", *flags])


def member(name: str, value: Any) -> str:
    """A method or property that a class defines."""
    called = getattr(value, "__func__", value)
    sign = signature(called) if inspect.isfunction(called) else ""
    abstract = "abstract" if getattr(value, "__isabstractmethod__", False) else ""
    return " ".join(filter(None, [f"    .{name}{sign}", KINDS.get(type(value), ""), abstract]))


def shape(path: str, made: type) -> Iterator[str]:
    """A class: whether it is frozen, its fields, its members."""
    if issubclass(made, enum.Enum):
        yield f"{path}: {', '.join(f'{each.name} = {each.value!r}' for each in made)}"
        return
    known = getattr(made, "__dataclass_params__", None)
    yield path + ("" if known is None else f" frozen={known.frozen} eq={known.eq}")
    fields = dataclasses.fields(made) if known else ()
    yield from map(field, fields)
    yield from (
        member(name, value)
        for name, value in vars(made).items()
        if name[0] != "_" and name not in {f.name for f in fields}
        if inspect.isfunction(value) or isinstance(value, tuple(KINDS))
    )


def public(module: str) -> Iterator[str]:
    """What a module exports that is of our making."""
    exported = importlib.import_module(module)
    for name in sorted(exported.__all__):
        value, path = getattr(exported, name), f"{module}.{name}"
        if isinstance(value, ModuleType):
            yield from public(value.__name__)
        elif inspect.isclass(value) and value.__module__.startswith(PACKAGES):
            yield from shape(path, value)
        elif inspect.isfunction(value):
            yield path + signature(value)


def tables(table: type[BaseModel], seen: set[type]) -> Iterator[str]:
    """The keys of a table of scenes and of the tables in it: defaults and bounds."""
    if table in seen:
        return
    seen.add(table)
    yield f"[{table.__name__}]"
    inner: list[type[BaseModel]] = []
    for name, own in table.model_fields.items():
        limits = ((key, getattr(each, key, None)) for each in own.metadata for key in BOUNDS)
        bounds = " ".join(f"{key}={limit}" for key, limit in limits if limit is not None)
        default = "" if own.is_required() else f" = {told(own.get_default(call_default_factory=True))}"
        yield f"    {name}{default} {bounds}".rstrip()
        inner += within(own.annotation)
    for part in inner:
        yield from tables(part, seen)


def within(annotation: Any) -> Iterator[type[BaseModel]]:
    """The tables that an annotation names."""
    if inspect.isclass(annotation) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from within(part)


def interface(package: str) -> str:
    """The interface of a package as text."""
    lines = [*public(package)]
    if package == "symbolic":
        seen = set[type]()
        lines += [line for scene in SCENES for line in tables(scene, seen)]
    return "\n".join(lines) + "\n"
