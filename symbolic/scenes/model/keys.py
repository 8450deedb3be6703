"""The keys of a scene of the kind "model" that can be given another value: `part.NAME.KEY` and others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from symbolic.scenes.model.catalogue import KIND
from symbolic.scenes.model.composing import NAME, entry_for
from symbolic.scenes.model.structures import StructureTable
from symbolic.scenes.overrides import Steps

LATER = ("parameter", "from", "to", "axis")
PLACE = ("unit", "scale", "start", "count")


def model_keys(tables: Mapping[str, Any]) -> dict[str, Steps]:
    """Return where each dotted key stands. Raises InputError for parts that do not exist."""
    return {key: path for key, path in _keys(tables)}


def _keys(tables: Mapping[str, Any]) -> Iterator[tuple[str, Steps]]:
    yield "title", ["title"]
    for key in LATER:
        yield f"trace.{key}", ["trace", key]
    for group in ("parameters", "values"):
        for name, value in _table(tables.get(group)).items():
            yield f"{group}.{name}", [group, name, "value"] if isinstance(value, dict) else [group, name]
    for k, table in enumerate(_list(tables.get("coordinate"))):
        for key in PLACE:
            yield f"coordinate.{table.get(NAME)}.{key}", ["coordinate", k, key]
    for k, table in enumerate(_list(tables.get("structure"))):
        for key in StructureTable.model_fields:
            yield f"structure.{table.get(NAME)}.{key}", ["structure", k, key]
            for inner in _table(table.get(key)):
                yield f"structure.{table.get(NAME)}.{key}.{inner}", ["structure", k, key, inner]
    parts = _list(tables.get("part"))
    labels = [str(table.get(NAME, table.get(KIND))) for table in parts]
    for k, table in enumerate(parts):
        label = labels[k] if labels.count(labels[k]) == 1 else f"{k + 1}"
        for name in [key.name for key in entry_for(k, table).keys]:
            yield f"part.{label}.{name}", ["part", k, name]
            for inner in _table(table.get(name)):
                yield f"part.{label}.{name}.{inner}", ["part", k, name, inner]


def _table(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}


def _list(value: Any) -> list[dict[str, Any]]:
    return [_table(item) for item in value] if isinstance(value, list) else []
