"""Scenes by name or file: reading, overriding and validating them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from symbolic.scenes.errors import LONGEST, InputError, cut, listed, refused, shown
from symbolic.scenes.schema import Scene, schema_of

Override = tuple[str, str | float | None]
"""A key, dotted or its last component alone, and its value, perhaps as text; none takes the key out."""


LARGEST = 32768
"""Bytes of a scene file; what is larger is none, and may take Python's reader of TOML for ever."""


BARE = re.compile(r"[A-Za-z0-9_-]{1,60}")
"""Keys that stand in a sentence without quotes."""


def scene_names() -> list[str]:
    """Return the names of the built-in scenes, smaller numbers first."""
    folder = resources.files("symbolic.scenes").joinpath("data")
    names = [file.name.removesuffix(".toml") for file in folder.iterdir() if file.name.endswith(".toml")]
    return sorted(names, key=lambda name: re.sub(r"\d+", lambda digits: digits[0].zfill(8), name))


def short_name(source: str) -> str:
    """Return what to call a scene: its name, or that of its file without folder and ending."""
    return source if source in scene_names() else Path(source).stem


def ends(scene: Scene) -> list[str]:
    """Return the keys of the two ends of a scene's range."""
    return [f"trace.{key}" for key in type(scene.trace).model_fields]


def load(source: str, overrides: Sequence[Override] = ()) -> Scene:
    """Return the scene of a name or a TOML file, with overrides applied in order.

    Raises InputError, in one sentence, for anything that is not as `symbolic.scenes.schema` allows.
    """
    tables = _parsed(source, _text(source))
    schema = schema_of(tables)
    for key, value in overrides:
        _override(tables, _path(schema, key, tables), value)
        schema = schema_of(tables)
    try:
        return schema.model_validate(tables)
    except ValidationError as error:
        raise _complaint(schema, error) from None


def _text(source: str) -> str:
    if source in scene_names():
        return resources.files("symbolic.scenes").joinpath("data", f"{source}.toml").read_text("utf-8")
    names = f"one of {', '.join(scene_names())} or the path of a TOML file"
    path = Path(source)
    if not source.strip():
        raise refused("scene", source, names)
    try:
        if path.exists() and not (path.is_file() or path.is_dir()):  # a pipe may never come to an end
            raise InputError("scene", f'file "{source}" is no regular file', f"it must be {names}")
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
        if len(content) > LARGEST:
            found = f'file "{source}" is larger than {LARGEST} bytes'
            raise InputError("scene", found, "it must be a TOML file like those built in")
        return content.decode("utf-8-sig")
    except (FileNotFoundError, ValueError) as error:
        if path.is_file():
            found = f'file "{source}" is not text in UTF-8'
            raise InputError("scene", found, "it must be a TOML file") from error
        raise refused("scene", source, names) from None
    except OSError as error:
        found = f'file "{source}" cannot be read ({error.strerror})'
        raise InputError("scene", found, f"it must be {names}") from error


def _parsed(source: str, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        why = "its tables are too deep" if isinstance(error, RecursionError) else str(error)
        found = f'file "{source}" is not TOML: {cut(why, 3 * LONGEST)}'
        raise InputError("scene", found, "it must hold lines like preload = 810") from error


def _keys(schema: type[BaseModel], prefix: str = "") -> Iterator[str]:
    """Yield the dotted keys of a scene, tables and values."""
    for name, table in schema.model_fields.items():
        if name == "kind":
            continue
        yield prefix + name
        if inner := _table(table.annotation):
            yield from _keys(inner, f"{prefix}{name}.")


def _table(annotation: Any) -> type[BaseModel] | None:
    """Return the model of a field that is a table, or None."""
    for candidate in (annotation, *getattr(annotation, "__args__", ())):
        if isinstance(candidate, type) and issubclass(candidate, BaseModel):
            return candidate
    return None


def _path(schema: type[BaseModel], key: str, tables: Mapping[str, Any]) -> list[str]:
    """Return the components of a key that may be given by its last component alone.

    Where several end so it is the one that the scene has.
    """
    keys = list(_keys(schema))
    found = [k for k in keys if k == key] or [k for k in keys if k.rpartition(".")[2] == key]
    if len(found) > 1:
        found = [k for k in found if _has(tables, k.split("."))] or found
    if len(found) != 1:
        choice = found or [k for k in keys if "." in k]
        raise refused("--set key", key, f"one of {', '.join(choice)}")
    return found[0].split(".")


def _has(tables: Any, path: Sequence[str]) -> bool:
    if not path:
        return True
    return isinstance(tables, Mapping) and path[0] in tables and _has(tables[path[0]], path[1:])


def _override(tables: dict[str, Any], path: list[str], value: str | float | None) -> None:
    for name in path[:-1]:
        inner = tables.setdefault(name, {})
        if not isinstance(inner, dict):
            raise refused(name, inner, "a table")
        tables = inner
    if value is None or value == "":
        tables.pop(path[-1], None)
    else:
        tables[path[-1]] = _value(value) if isinstance(value, str) else value


def _value(text: str) -> bool | int | float | str:
    if text in ("true", "false"):
        return text == "true"
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            continue
    return text


def _complaint(schema: type[BaseModel], error: ValidationError) -> InputError:
    """Return the first of pydantic's errors as a sentence; a mistyped key before what it leaves missing."""
    first = min(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
    path = [str(part) for part in first["loc"]]
    key = ".".join(part if BARE.fullmatch(part) else shown(part) for part in path)
    table: type[BaseModel] = schema
    for name in path[:-1]:
        table = _table(table.model_fields[name].annotation) or table
    if first["type"] == "extra_forbidden":
        place = f"[{'.'.join(path[:-1])}]" if path[1:] else "the scene"
        known = listed(list(table.model_fields), "and")
        return InputError(key, "is not a key of the scene", f"{place} may have {known}")
    field = table.model_fields[path[-1]]
    inner = _table(field.annotation)
    allowed = f"a table with {listed(list(inner.model_fields), 'and')}" if inner else str(field.description)
    if first["type"] == "missing":
        return InputError(key, "is missing", f"it must be {allowed}")
    return refused(key, first["input"], allowed)
