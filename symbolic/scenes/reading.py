"""Reading of scene files: found by name or path, entries overridden, validated."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from symbolic.guarded import content
from symbolic.scenes.errors import InputError, refused
from symbolic.scenes.model.bench import nearest
from symbolic.scenes.model.keys import model_keys
from symbolic.scenes.model.scene import ModelScene
from symbolic.scenes.names import built_in, scene_names
from symbolic.scenes.overrides import Steps, Value, address, complaint, keys_of, set_value
from symbolic.scenes.schema import Scene, schema_of

Override = tuple[str, Value]
"""A key (dotted, or its last component alone) and its value (perhaps as text); None removes the key."""


PLACE = re.compile(r"\(at (line \d+, column \d+|end of document)\)$")
"""Where Python's reader of TOML says that a file is wrong."""

QUOTING = re.compile(r"\(['\"]|(haracter|key) ['\"]")
"""How it quotes keys and signs: a file that is none of ours is not told."""

LARGEST_FILE = 32768
"""Most bytes of a scene file: Python's reader of TOML may take very long with larger ones."""


def ends(scene: Scene) -> list[str]:
    """Return the keys of the two ends of a scene's range."""
    return [f"trace.{key}" for key in scene.trace.written]


def load(source: str, overrides: Sequence[Override] = ()) -> Scene:
    """Return the scene of a name or a TOML file, with overrides applied in order.

    Raises InputError, in one sentence, for anything that is not as `symbolic.scenes.schema` allows.
    """
    tables = _parsed(source, _text(source))
    schema, folder = schema_of(tables), Path() if source in scene_names() else Path(source).parent
    for key, value in overrides:
        set_value(tables, _address(schema, key, tables, folder), value)
        schema = schema_of(tables)
    return _validated(schema, tables, folder)


def keys_of_scene(source: str) -> list[str]:
    """Return the keys that the overrides of a scene may name. Raises InputError."""
    tables = _parsed(source, _text(source))
    schema = schema_of(tables)
    return list(model_keys(tables)) if issubclass(schema, ModelScene) else list(keys_of(schema))


def _address(schema: type[Scene], key: str, tables: dict[str, Any], folder: Path) -> Steps:
    """The place of a key; the name of a parameter of a model stands for its entry in [values]."""
    if not issubclass(schema, ModelScene):
        return address({k: list(k.split(".")) for k in keys_of(schema)}, key, tables)
    keys = model_keys(tables)
    if key not in keys:
        scene = _validated(schema, tables, folder)
        assert isinstance(scene, ModelScene)
        if key in [p.name for p in scene.compiled.parameters]:
            return ["values", key]
    return address(keys, key, tables)


def _validated(schema: type[Scene], tables: Mapping[str, Any], folder: Path) -> Scene:
    """The scene of tables; the files that it names lie in a folder. Raises InputError."""
    try:
        return schema.model_validate(tables, context={"folder": folder})
    except ValidationError as error:
        raise complaint(schema, error) from None


def _text(source: str) -> str:
    if source in scene_names():
        return built_in(source)
    near = nearest(source, scene_names())
    names = f"one of {', '.join(scene_names())} or the path of a TOML file"
    path = Path(source)
    if not source.strip():
        raise refused("scene", source, names)
    try:
        return content(path, LARGEST_FILE).decode("utf-8-sig")
    except UnicodeDecodeError:
        found = f'file "{source}" is not text in UTF-8'
        raise InputError("scene", found, "it must be a TOML file") from None
    except FileNotFoundError:
        if path.suffix == ".toml":
            found = f'is "{source}", and there is no such file'
            raise InputError("scene", found, f"`orbitrace new model {path.name}` writes one") from None
        raise refused("scene", source, f"{names}; nearest is {near}" if near else names) from None
    except OSError as error:
        found = f'file "{source}" cannot be read ({error.strerror})'
        raise InputError("scene", found, f"it must be {names}") from error


def _parsed(source: str, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except RecursionError:
        why = "its tables are too deep"
    except ValueError as error:
        place = PLACE.search(str(error))
        why = str(error) if place else "it has a number of too many digits"
        if place and QUOTING.search(why):
            why = f"it is wrong at {place[1]}"
    found = f'file "{source}" is not TOML: {why}'
    raise InputError("scene", found, "it must hold lines like preload = 810")
