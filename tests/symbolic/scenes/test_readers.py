"""How values of a type are read from text, and where the keys of a scene stand."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Literal

import pytest

from symbolic.equations.variables import Coordinate, Parameter
from symbolic.scenes.model import readers
from symbolic.scenes.model.keys import model_keys
from symbolic.scenes.model.readers import PLAIN, Either, OneOf, Several, UnreadableError, reader_of


def nothing(kind: type) -> None:
    """No class stands for an inline table."""


@pytest.mark.parametrize(
    ("annotation", "expected"),
    [
        (float, PLAIN[float]),
        (float | None, PLAIN[float]),
        (Coordinate | None, PLAIN[Coordinate]),
        (float | Parameter, readers.Number()),
        (int | float | Fraction | str, PLAIN[Fraction]),
        (bool | str, Either((PLAIN[bool], PLAIN[str]))),
        (float | complex, PLAIN[float]),
        (Literal["a", "b"], OneOf(("a", "b"))),
        (tuple[float, float], Several(PLAIN[float], 2)),
        (tuple[float, ...], Several(PLAIN[float], None)),
        (Sequence[str] | None, Several(PLAIN[str], None)),
    ],
)
def test_reader_of_a_type(annotation: Any, expected: object) -> None:
    """Assert what reads each type: of a union whatever its members ask for, alone if it is one."""
    assert reader_of(annotation, nothing) == expected


@pytest.mark.parametrize("annotation", [complex, complex | None, tuple[float, str], list])
def test_what_text_cannot_give(annotation: Any) -> None:
    """Assert that there is no reader of types that no text stands for."""
    with pytest.raises(UnreadableError):
        reader_of(annotation, nothing)


def test_where_keys_stand() -> None:
    """Assert the path of each kind of key: numbers and tables of parameters, parts that share a name."""
    damper = {"kind": "Damper", "q": "x", "c": 0.1}
    tables = {
        "parameters": {"plain": 1.0, "full": {"value": 2.0, "unit": "N"}},
        "values": {"Omega": 3.0},
        "coordinate": [{"name": "x"}, {"name": "y"}],
        "part": [{"kind": "Mass", "q": "x", "m": 1.0}, damper, damper],
    }
    found = model_keys(tables)
    assert found["title"] == ["title"]
    assert found["trace.from"] == ["trace", "from"]
    assert found["parameters.plain"] == ["parameters", "plain"]
    assert found["parameters.full"] == ["parameters", "full", "value"]
    assert found["values.Omega"] == ["values", "Omega"]
    assert found["coordinate.y.scale"] == ["coordinate", 1, "scale"]
    assert found["part.Mass.m"] == ["part", 0, "m"]
    assert found["part.2.c"] == ["part", 1, "c"]
    assert found["part.3.c"] == ["part", 2, "c"]
    assert "part.Damper.c" not in found
