"""Which parameters a map is over: keys of a scene or names of parameters, with their values, as text."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from symbolic import CompiledSystem
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError, refused
from symbolic.scenes.reading import Override, load

FORM = "KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,..., as in preload=100:2000:40"

MOST_VALUES = 100_000
"""Values of one parameter."""

SHORT = {"waviness": "waviness.amplitude"}
"""Tables of a scene that stand for their first number."""


def axes(
    source: str, overrides: Sequence[Override], over: Sequence[str]
) -> tuple[dict[str, list[float]], dict[str, str]]:
    """Return values (SI) by the names of the system's parameters, and the keys that these were given as.

    Raises InputError.
    """
    system = build(load(source, overrides))
    found: dict[str, list[float]] = {}
    keys: dict[str, str] = {}
    for text in over:
        key, values = _read(text)
        name = _parameter(system, source, overrides, key, values)
        if name in found:
            raise InputError("--over", f'has "{key}" twice', "it must name each parameter once")
        found[name], keys[name] = values, key
    return found, keys


def _read(text: str) -> tuple[str, list[float]]:
    """Key and values of one option."""
    key, equals, given = text.partition("=")
    if not (equals and key.strip()):
        raise refused("--over", text, FORM)
    try:
        if ":" in given:
            first, last, count = given.split(":")
            number = int(count)
            if not 1 <= number <= MOST_VALUES:
                raise ValueError
            with np.errstate(all="ignore"):  # what is not finite is refused below
                values = np.linspace(float(first), float(last), number).tolist()
        else:
            values = [float(value) for value in given.split(",")]
    except ValueError:
        raise refused("--over", text, FORM) from None
    if not all(map(math.isfinite, values)) or len(set(values)) < len(values):
        raise refused("--over", text, f"{FORM}, of finite values that differ")
    return key.strip(), values


def _parameter(
    system: CompiledSystem, source: str, overrides: Sequence[Override], key: str, values: Sequence[float]
) -> str:
    """The parameter of that name, or the one that the scene's key sets, at both ends of its range."""
    nominal = {p.name: p.value for p in system.parameters}
    if key in nominal:
        return key
    other = [value for value in (min(values), max(values))]
    changed = [_changed(nominal, source, overrides, key, value) for value in other]
    names = {name for names in changed for name in names}
    if len(names) != 1:
        allowed = (
            f"one of the parameters {', '.join(nominal)}, or a key of the scene that sets one of them alone"
        )
        raise refused("--over", key, allowed)
    return names.pop()


def _changed(
    nominal: Mapping[str, float], source: str, overrides: Sequence[Override], key: str, value: float
) -> list[str]:
    """Names of the parameters that have another value in the scene with this one."""
    whole = int(value) if value == int(value) else value
    try:
        scene = load(source, (*overrides, (SHORT.get(key, key), whole)))
    except InputError as error:
        parameters = f"one of the parameters {', '.join(sorted(nominal))}, or of the keys"
        both = {"--set key": "--over"} | ({"one of": parameters} if error.field == "--set key" else {})
        raise error.renamed(both) from None
    now = {p.name: p.value for p in build(scene).parameters}
    return [name for name, before in nominal.items() if now.get(name) != before]
