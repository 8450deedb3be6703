"""The parts of the catalogue in words, as a terminal shows them."""

from __future__ import annotations

from typing import Any

from symbolic.scenes.model.bench import unknown
from symbolic.scenes.model.catalogue import KIND, Entry, Key, catalogue
from symbolic.scenes.model.composing import NAME


def every() -> str:
    """Return one line for each part: its name and the formula."""
    found = catalogue()
    width = max(map(len, found))
    return "\n".join(f"{name:{width}}  {entry.text.summary}" for name, entry in found.items())


def one(name: str) -> str:
    """Return what there is to say of a part. Raises InputError for one that there is not."""
    found = catalogue()
    if name not in found:
        raise unknown("part", name, list(found), "the name of a part (`orbitrace parts` lists them)")
    entry = found[name]
    text = [f"{name}: {entry.text.summary}", entry.text.more, "keys:\n" + _keys(entry)]
    text += [
        f"source: {entry.text.references}" if entry.text.references else "",
        "example:\n" + example(entry),
    ]
    return "\n\n".join(filter(None, text))


def _keys(entry: Entry) -> str:
    width = max(len(key.name) for key in entry.keys)
    lines = [f"  {key.name:{width}}  {said(key)}" for key in entry.keys]
    if all(key.name != NAME for key in entry.keys):
        lines.append(f"  {NAME:{width}}  what its numbers are called by where several parts of a kind differ")
    return "\n".join(lines)


def said(key: Key) -> str:
    """Return what a key is: its text, what it takes, its default."""
    default = "" if key.needed or key.default is None else f", default {toml(key.default)}"
    must = "" if key.needed else "optional; "
    return f"{key.text} ({must}{key.reader.allowed}{default})"


def example(entry: Entry) -> str:
    """Return a table [[part]] with what must be given."""
    lines = [f"  {name} = {toml(value)}" for name, value in {KIND: entry.name, **entry.example}.items()]
    return "\n".join(["  [[part]]", *lines])


def toml(value: Any) -> str:
    """Return a value as TOML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name} = {toml(item)}" for name, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else f"{value}"
