"""From the tables of a scene to its model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from symbolic.equations.model import Model, Part, combine
from symbolic.equations.variables import Coordinate, Parameter
from symbolic.parts.structure import Structure
from symbolic.scenes.errors import InputError, refused
from symbolic.scenes.model.bench import Bench, unknown
from symbolic.scenes.model.catalogue import KIND, Entry, catalogue
from symbolic.scenes.model.readers import CoordinateName

NAME = "name"
"""The key of a part by which its numbers are called where several of a kind differ."""


def composed(
    coordinates: Sequence[Coordinate],
    parameters: Sequence[Parameter],
    parts: Sequence[dict[str, Any]],
    structures: Sequence[Structure] = (),
) -> Model:
    """Return the model of tables [[part]], with structures. Raises InputError."""
    bench = Bench(
        {q.name: q for q in coordinates}, {s.name: s for s in structures}, {p.name: p for p in parameters}
    )
    if len(bench.coordinates) < len(coordinates):
        names = [q.name for q in coordinates]
        raise refused("[[coordinate]] name", next(n for n in names if names.count(n) > 1), "one of its own")
    laid = [part for k, table in enumerate(parts) for part in _parts(bench, k, table)]
    return combine([*structures, *laid])


def entry_for(k: int, table: Mapping[str, Any]) -> Entry:
    """Return the entry of part k, counted from 0. Raises InputError."""
    kind, known = table.get(KIND), catalogue()
    allowed = "the name of a part (`orbitrace parts` lists them)"
    if kind is None:
        raise InputError(f"[[part]] {k + 1} {KIND}", "is missing", f"it must be {allowed}")
    if not isinstance(kind, str) or kind not in known:
        raise unknown(f"[[part]] {k + 1} {KIND}", kind, list(known), allowed)
    return known[kind]


def _parts(bench: Bench, k: int, table: Mapping[str, Any]) -> Iterator[Part]:
    """The part of a table; one for each coordinate where a key for one coordinate has a list of them."""
    entry = entry_for(k, table)
    where, name = f"[[part]] {k + 1} ({entry.name})", table.get(NAME)
    own = {key: value for key, value in table.items() if key != KIND}
    if NAME in table and not any(key.name == NAME for key in entry.keys):
        own.pop(NAME)
        if not isinstance(name, str) or not name.strip():
            raise refused(f"{where} {NAME}", name, "a text")
    else:
        name = None
    for each in _spread(where, entry, own):
        part = entry.made(bench, where, each)
        yield part.named(name) if name is not None else part


def _spread(where: str, entry: Entry, table: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Tables with one coordinate each, for lists under keys that take one."""
    lists = {
        key.name: table[key.name]
        for key in entry.keys
        if isinstance(table.get(key.name), list) and isinstance(key.reader, CoordinateName)
    }
    counts = {len(value) for value in lists.values()}
    if not lists:
        yield table
    elif len(counts) > 1 or not counts.isdisjoint({0}):
        raise InputError(
            f"{where} {' and '.join(lists)}",
            "differ in length",
            f"they must be as long, not {' and '.join(map(str, sorted(counts)))}",
        )
    else:
        for k in range(counts.pop()):
            yield {**table, **{name: value[k] for name, value in lists.items()}}
