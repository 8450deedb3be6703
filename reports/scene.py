"""Scenes by name or file: reading, overriding and validating them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from reports.errors import LONGEST, InputError, cut, listed, refused, shown
from reports.schema import KINDS, Scene

Override = tuple[str, str]
"""A key, dotted or its last component alone, and the text of its value; no text takes the key out."""


LARGEST = 32768
"""Bytes of a scene file; what is larger is none, and may take Python's reader of TOML for ever."""


BARE = re.compile(r"[A-Za-z0-9_-]{1,60}")
"""Keys that stand in a sentence without quotes."""


def scene_names() -> list[str]:
    """Return the names of the built-in scenes, smaller numbers first."""
    folder = resources.files("reports").joinpath("scenes")
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

    Raises InputError, in one sentence, for anything that is not as `reports.schema` allows.
    """
    tables = _parsed(source, _text(source))
    kind = tables.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        allowed = listed([shown(name) for name in KINDS])
        if kind is None:
            raise InputError("kind", "is missing", f"it must be {allowed}")
        raise refused("kind", kind, allowed)
    schema = KINDS[kind]
    for key, text in overrides:
        _override(tables, _path(schema, key), text)
    try:
        return schema.model_validate(tables)
    except ValidationError as error:
        raise _complaint(schema, error) from None


def _text(source: str) -> str:
    if source in scene_names():
        return resources.files("reports").joinpath("scenes", f"{source}.toml").read_text("utf-8")
    names = f"one of {', '.join(scene_names())} or the path of a TOML file"
    path = Path(source)
    try:
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
        found = f'file "{source}" is not TOML: {cut(str(error), 3 * LONGEST)}'
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


def _path(schema: type[BaseModel], key: str) -> list[str]:
    """Return the components of a key that may be given by its last component alone."""
    keys = list(_keys(schema))
    found = [k for k in keys if k == key] or [k for k in keys if k.rpartition(".")[2] == key]
    if len(found) != 1:
        choice = found or [k for k in keys if "." in k]
        raise refused("--set key", key, f"one of {', '.join(choice)}")
    return found[0].split(".")


def _override(tables: dict[str, Any], path: list[str], text: str) -> None:
    for name in path[:-1]:
        inner = tables.setdefault(name, {})
        if not isinstance(inner, dict):
            raise refused(name, inner, "a table")
        tables = inner
    if text:
        tables[path[-1]] = _value(text)
    else:
        tables.pop(path[-1], None)


def _value(text: str) -> int | float | str:
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
