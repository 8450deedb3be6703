"""Names and units that a terminal would obey, wherever a model takes one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import symbolic as sym

OBEYED = ["\x1b[31m", "\x9b2J", "a\rb", "a\nb", "a\u202eb", "a\u2028b"]


def _decay(x: Any, p: Any) -> dict[str, Any]:
    return {"x": -x.x}


PLACES: dict[str, Callable[[str], object]] = {
    "coordinate": sym.coordinate,
    "unit of a coordinate": lambda text: sym.coordinate("x", unit=text),
    "coordinates": lambda text: sym.coordinates(text, 2),
    "parameter": lambda text: sym.parameter(text, 1.0),
    "unit of a parameter": lambda text: sym.parameter("k", 1.0, text),
    "part": lambda text: sym.Spring(sym.coordinate("x"), 1.0).named(text),
    "output": lambda text: sym.compile(sym.Equations(_decay, {"x": 1.0}, outputs=lambda x, p: {text: x.x})),
    "switch": lambda text: sym.compile(sym.Equations(_decay, {"x": 1.0}, switches=lambda x, p: {text: x.x})),
    "reset": lambda text: sym.compile(
        sym.Equations(_decay, {"x": 1.0}, resets=lambda x, p: {text: (x.x, {"x": 1.0})})
    ),
}


@pytest.mark.parametrize("text", OBEYED)
@pytest.mark.parametrize("place", PLACES)
def test_refused(place: str, text: str) -> None:
    """Assert one sentence that shows the text written out."""
    with pytest.raises(ValueError, match="it must be one line of text") as caught:
        PLACES[place](text)
    assert str(caught.value).isprintable()
