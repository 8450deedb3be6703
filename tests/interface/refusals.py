"""What settings and parts take in each of their fields, and the sentences with which they refuse the rest."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from enum import Enum
from functools import cache
from typing import Any

import periodic as per
import symbolic as sym
from interface.text import told
from symbolic.equations.assembly import Assembly
from symbolic.scenes.model.bench import Bench
from symbolic.scenes.model.catalogue import catalogue

TRIED: tuple[Any, ...] = (-1, -0.5, 0, 0.5, 1, 1.5, 3, 1e300, math.nan, math.inf, True, "a", None, ())
"""Values that are put into each field in turn."""

PLAIN = (int, float, str, tuple, Enum, type(None))
"""What a field must hold for them to be put into it: no coordinate, structure or function."""

NAMES = "xyzuvw"


@cache
def settings() -> dict[str, Any]:
    """Every dataclass of `periodic` that is made without arguments, by name."""
    found = {}
    for namespace in (per, per.extend, per.maps):
        for name in sorted(namespace.__all__):
            made = getattr(namespace, name)
            if isinstance(made, type) and dataclasses.is_dataclass(made):
                needed = (f for f in dataclasses.fields(made) if f.init and f.default is f.default_factory)
                found |= {} if any(needed) else {name: made()}
    return found


@cache
def parts() -> dict[str, Any]:
    """Every part that a scene can name, as its example, by name."""
    bench = Bench({each: sym.coordinate(each) for each in NAMES})
    return {name: entry.made(bench, name, entry.example) for name, entry in catalogue().items()}


def refusal(given: Any, field: str, value: Any) -> str:
    """The sentence with which a value is refused, as an object is made or a part laid; "" if it is not."""
    try:
        made = dataclasses.replace(given, **{field: value})
        if isinstance(made, sym.Part):
            assembly = Assembly()
            assembly.lay([made])
            assembly.close()
    except ValueError as error:
        return str(error).replace(f" is {value!r}", " is ...")
    except Exception as error:  # what is no sentence is told by its kind
        return type(error).__name__
    return ""


def refusals(name: str, given: Any) -> Iterator[str]:
    """Of each field what is taken, and the sentences for the rest."""
    for field in dataclasses.fields(given):
        if field.init and isinstance(getattr(given, field.name), PLAIN):
            found: dict[str, list[str]] = {}
            for value in TRIED:
                found.setdefault(refusal(given, field.name, value), []).append(told(value))
            yield f"{name}.{field.name} takes {', '.join(found.pop('', [])) or 'none of them'}"
            yield from (f"    {', '.join(values)}: {said}" for said, values in found.items())
