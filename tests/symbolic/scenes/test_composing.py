"""From tables of parts to parts: names, lists of coordinates, and what is refused."""

from __future__ import annotations

from typing import Any

import pytest

import symbolic as sym
from symbolic.equations.model import Model
from symbolic.scenes.errors import InputError
from symbolic.scenes.model.composing import composed, entry_for

X, Y = sym.coordinate("x"), sym.coordinate("y")


def model(*tables: dict[str, Any]) -> Model:
    """The model of tables over x and y."""
    return composed([X, Y], [sym.parameter("k", 2.5, "N/m")], tables)


def test_parts_of_tables() -> None:
    """Assert one part for each coordinate of a list, in step with another list, and parameters by name."""
    found = model(
        {"kind": "Mass", "q": ["x", "y"], "m": 1.5},
        {"kind": "Spring", "q": ["x", "y"], "to": ["y", "x"], "k": "k"},
        {"kind": "Damper", "q": "x", "c": 0.1},
    )
    k = sym.parameter("k", 2.5, "N/m")
    by_hand = [sym.Mass(X, 1.5), sym.Mass(Y, 1.5), sym.Spring(X, k, to=Y), sym.Spring(Y, k, to=X)]
    assert repr(found) == repr(sym.combine([*by_hand, sym.Damper(X, 0.1)]))


def test_names_of_parts() -> None:
    """Assert that a part's numbers are called by it, and not by it where there is none."""
    parts = [{"kind": "Damper", "name": "left", "q": "x", "c": 0.1}, {"kind": "Damper", "q": "y", "c": 0.2}]
    found = sym.compile(model({"kind": "Mass", "q": ["x", "y"], "m": 1.0}, *parts))
    assert {"c_left", "c_y"} <= {p.name for p in found.parameters}


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"q": "x"}, r"\[\[part\]\] 1 kind is missing; it must be the name of a part"),
        ({"kind": "Mas", "q": "x"}, r"\[\[part\]\] 1 kind is .Mas.; it must be"),
        ({"kind": 3}, r"\[\[part\]\] 1 kind is 3; it must be"),
        (
            {"kind": "Mass", "q": "x", "m": 1.0, "name": ""},
            r"\[\[part\]\] 1 \(Mass\) name is ..; it must be a t",
        ),
        (
            {"kind": "Mass", "q": "x", "m": 1.0, "name": "  "},
            r"\[\[part\]\] 1 \(Mass\) name is ..; it must be",
        ),
        (
            {"kind": "Mass", "q": "x", "m": 1.0, "name": 3},
            r"\[\[part\]\] 1 \(Mass\) name is 3; it must be a text",
        ),
        (
            {"kind": "Mass", "q": [], "m": 1.0},
            r"\[\[part\]\] 1 \(Mass\) q differ in length; they must be as long",
        ),
        (
            {"kind": "Spring", "q": ["x", "y"], "to": ["y"], "k": 1.0},
            r"\[\[part\]\] 1 \(Spring\) q and to differ in length; they must be as long, not 1 and 2$",
        ),
    ],
)
def test_tables_that_are_refused(table: dict[str, Any], said: str) -> None:
    """Assert the sentence."""
    with pytest.raises(InputError, match=f"^{said}"):
        model(table)


def test_place_of_a_part_that_is_refused() -> None:
    """Assert that parts are counted from 1, and that coordinates need names of their own."""
    assert entry_for(0, {"kind": "Mass"}).name == "Mass"
    with pytest.raises(InputError, match=r"^\[\[part\]\] 3 kind is missing"):
        entry_for(2, {})
    with pytest.raises(InputError, match=r"^\[\[coordinate\]\] name is .y.; it must be one of its own$"):
        composed([X, Y, sym.coordinate("y")], [], [])
