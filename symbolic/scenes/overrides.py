"""Keys of a scene: how they are found, given a value, and told where they are wrong."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from symbolic.scenes.errors import InputError, listed, refused, shown

BARE = re.compile(r"[A-Za-z0-9_-]{1,60}")
"""Keys that stand in a sentence without quotes."""

Value = str | float | None
"""A value, perhaps as text; none takes the key out."""

Steps = list[str | int]
"""Keys of tables and places in lists, one inside another."""


def fields_of(table: type[BaseModel]) -> dict[str, FieldInfo]:
    """Return the fields of a table by the names that they have in a file."""
    return {field.alias or name: field for name, field in table.model_fields.items()}


def keys_of(schema: type[BaseModel], prefix: str = "") -> Iterator[str]:
    """Yield the dotted keys of a scene, tables and values."""
    for name, field in fields_of(schema).items():
        if name == "kind":
            continue
        yield prefix + name
        if inner := _table(field.annotation):
            yield from keys_of(inner, f"{prefix}{name}.")


def _table(annotation: Any) -> type[BaseModel] | None:
    """Return the model of a field that is a table or a list of them, or None."""
    for candidate in (annotation, *getattr(annotation, "__args__", ())):
        if isinstance(candidate, type) and issubclass(candidate, BaseModel):
            return candidate
    return None


def address(keys: Mapping[str, Steps], key: str, tables: Mapping[str, Any]) -> Steps:
    """Return where a key stands that may be given by its last component alone.

    Where several end so it is the one that the scene has.
    """
    found = [k for k in keys if k == key] or [k for k in keys if k.rpartition(".")[2] == key]
    if len(found) > 1:
        found = [k for k in found if _has(tables, keys[k])] or found
    if len(found) != 1:
        choice = found or [k for k in keys if "." in k]
        raise refused("--set key", key, f"one of {', '.join(choice)}")
    return keys[found[0]]


def _has(tables: Any, path: Sequence[str | int]) -> bool:
    if not path:
        return True
    step = path[0]
    if isinstance(tables, list):
        return isinstance(step, int) and step < len(tables) and _has(tables[step], path[1:])
    return isinstance(tables, Mapping) and step in tables and _has(tables[step], path[1:])


def set_value(tables: dict[str, Any], path: Steps, value: Value) -> None:
    """Give the key at a path a value, making tables on the way. Raises InputError."""
    inner: Any = tables
    for k, name in enumerate(path[:-1]):
        inner = inner[name] if isinstance(name, int) else inner.setdefault(name, {})
        if not isinstance(inner, dict | list):
            raise refused(".".join(map(str, path[: k + 1])), inner, "a table")
    if value is None or value == "":
        inner.pop(path[-1], None)
    else:
        inner[path[-1]] = _value(value) if isinstance(value, str) else value


def _value(text: str) -> Any:
    """A text of the command line as TOML has it: numbers, lists, tables; anything else is a text."""
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            continue
    if text[:1] in ("[", "{") or text in ("true", "false"):
        try:
            return tomllib.loads(f"value = {text}")["value"]
        except (ValueError, RecursionError):
            return text
    return text


def complaint(schema: type[BaseModel], error: ValidationError) -> InputError:
    """Return the first of pydantic's errors as a sentence; a mistyped key before what it leaves missing."""
    first = min(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
    table, field, steps = _place(schema, first["loc"])
    key = ".".join(step if BARE.fullmatch(step) else shown(step) for step in steps)
    if first["type"] == "extra_forbidden":
        place = f"[{'.'.join(steps[:-1])}]" if steps[1:] else "the scene"
        known = listed(list(fields_of(table)), "and")
        return InputError(key, "is not a key of the scene", f"{place} may have {known}")
    allowed = _allowed(field)
    if first["type"] == "missing":
        return InputError(key, "is missing", f"it must be {allowed}")
    return refused(key, first["input"], allowed)


def _allowed(field: FieldInfo | None) -> str:
    """What a field may be, in words."""
    inner = _table(field.annotation) if field is not None else None
    if field is None or field.description or inner is None:
        return str(field and field.description)
    return f"a table with {listed(list(fields_of(inner)), 'and')}"


def _place(
    schema: type[BaseModel], loc: tuple[str | int, ...]
) -> tuple[type[BaseModel], FieldInfo | None, list[str]]:
    """The innermost table and field that an error is about, and the keys to it, places counted from 1."""
    table, field, steps = schema, None, []
    for k, step in enumerate(loc):
        known = fields_of(table)
        steps.append(str(step + 1) if isinstance(step, int) else step)
        if step not in known:
            continue
        field = known[str(step)]
        inner = _table(field.annotation)
        if inner is not None and k < len(loc) - 1:
            table = inner
    return table, field, steps
