"""What each scene that comes with the package is: its quantities, switches and drawing, as text."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import symbolic as sym

ROUNDED = 1e-9
"""Values of a rest, in their scales, up to which they are rounding."""

STILL = {"fixed": 0.0, "moved": []}
"""A place of a drawing that is not written."""


def quantity(variable: Any) -> str:
    """A quantity: its name, its unit, and the scale or value where that is not usual."""
    value = f" = {variable.value:.6g}" if variable.value and not math.isnan(variable.value) else ""
    scale = f" / {variable.scale:.6g}" if variable.scale != 1.0 else ""
    return f"{variable.name}{value}{scale} {variable.unit}".rstrip()


def shape(drawn: Mapping[str, Any]) -> str:
    """A shape of the drawing: what differs from one that stands still at 0."""
    told = {key: value for key, value in drawn.items() if value and value != STILL}
    each = (
        f"{key} {_place(value) if isinstance(value, dict) else _plain(value)}" for key, value in told.items()
    )
    return ", ".join(each)


def _place(place: Mapping[str, Any]) -> str:
    return " + ".join([f"{place['fixed']:.6g}", *(f"{factor:.6g} {name}" for name, factor in place["moved"])])


def _plain(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def scene(name: str) -> Iterator[str]:
    """The lines of a scene."""
    system = sym.scene(name)
    rest, unknown = system.rest(system.nominal)
    for kind in ("states", "algebraics", "parameters", "outputs"):
        yield f"{kind} {', '.join(map(quantity, getattr(system, kind)))}".rstrip()
    yield f"rest {', '.join(f'{value:.6g}' if abs(value) > ROUNDED else '0' for value in (*rest, *unknown))}"
    for switch in system.switches:
        levels = ", ".join(f"{level:.6g}" for level in switch.levels)
        yield f"switch {switch.name} {switch.direction:+d} {levels}"
    yield from (f"shape {shape(drawn)}" for drawn in system.sketch)
