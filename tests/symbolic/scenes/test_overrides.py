"""Where an overridden key stands in a scene, and what becomes of its value."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from symbolic.scenes.errors import InputError
from symbolic.scenes.overrides import Steps, _has, _value, address, complaint, fields_of, keys_of, set_value


class Inner(BaseModel):
    """A table."""

    model_config = ConfigDict(extra="forbid")
    kind: str = "inner"
    mass: float = Field(1.0, description="a number from 0 to 9 (kg)", le=9)
    rate: float = Field(2.0, alias="from")


class Outer(BaseModel):
    """A table with a table, one that may be left out, and a list of them."""

    model_config = ConfigDict(extra="forbid")
    one: Inner
    two: Inner | None = None
    many: list[Inner] = []
    plain: int = 3


KEYS: dict[str, Steps] = {
    "plain": ("plain",),
    "one.mass": ("one", "mass"),
    "two.mass": ("two", "mass"),
    "many.mass": ("many", 1, "mass"),
    "one.from": ("one", "from"),
}


def test_keys_of_a_scene() -> None:
    """Assert tables and values by the names that they have in a file, kinds left out."""
    assert list(fields_of(Inner)) == ["kind", "mass", "from"]
    inner = ["mass", "from"]
    expected = [name for k in ("one", "two", "many") for name in (k, *(f"{k}.{key}" for key in inner))]
    assert list(keys_of(Outer)) == [*expected, "plain"]


@pytest.mark.parametrize(
    ("key", "tables", "expected"),
    [
        ("plain", {}, ("plain",)),
        ("two.mass", {}, ("two", "mass")),
        ("from", {}, ("one", "from")),
        ("mass", {"one": {"mass": 1}}, ("one", "mass")),
        ("mass", {"two": {"mass": 1}, "one": {}}, ("two", "mass")),
        ("mass", {"many": [{}, {"mass": 1}]}, ("many", 1, "mass")),
    ],
)
def test_where_a_key_stands(key: str, tables: dict[str, Any], expected: tuple[str | int, ...]) -> None:
    """Assert the whole key, the only one that ends so, or that which the scene has."""
    assert address(KEYS, key, tables) == expected


@pytest.mark.parametrize(
    ("key", "tables", "choice"),
    [
        ("mass", {}, "one.mass, two.mass, many.mass"),
        ("mass", {"one": {"mass": 1}, "two": {"mass": 1}}, "one.mass, two.mass"),
        ("width", {}, "one.mass, two.mass, many.mass, one.from"),
        ("ass", {}, "one.mass, two.mass, many.mass, one.from"),
    ],
)
def test_keys_that_stand_nowhere(key: str, tables: dict[str, Any], choice: str) -> None:
    """Assert between which keys there is a choice."""
    with pytest.raises(InputError, match=f"one of {choice}$"):
        address(KEYS, key, tables)


@pytest.mark.parametrize(
    ("tables", "path", "there"),
    [
        ({}, (), True),
        ({"a": 1}, ("a",), True),
        ({"a": 1}, ("b",), False),
        ({"a": 1}, ("a", "b"), False),
        ({"a": [{}, {"b": 0}]}, ("a", 1, "b"), True),
        ({"a": [{}, {"b": 0}]}, ("a", 2, "b"), False),
        ({"a": [{}, {"b": 0}]}, ("a", "b"), False),
        (3, ("a",), False),
    ],
)
def test_whether_a_scene_has_a_key(tables: Any, path: tuple[str | int, ...], there: bool) -> None:
    """Assert it in tables and lists of them."""
    assert _has(tables, path) is there


def test_values_that_are_set_and_taken_out() -> None:
    """Assert tables made on the way, places in lists, numbers of texts, and nothing for an empty text."""
    tables: dict[str, Any] = {"a": [{"b": 1}, {"b": 2}], "c": {"d": 1, "e": 2}}
    set_value(tables, ("a", 1, "b"), "7")
    set_value(tables, ("f", "g", "h"), 2.5)
    set_value(tables, ("c", "d"), "")
    set_value(tables, ("c", "x"), None)
    assert tables == {"a": [{"b": 1}, {"b": 7}], "c": {"e": 2}, "f": {"g": {"h": 2.5}}}
    set_value(tables, ("c", "e"), None)
    assert tables["c"] == {}
    with pytest.raises(InputError, match="f.g.h .*a table"):
        set_value(tables, ("f", "g", "h", "i"), 1)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3),
        ("-2.5e3", -2500.0),
        ("true", True),
        ("false", False),
        ("True", "True"),
        ("[1, 2]", [1, 2]),
        ("{a = 1}", {"a": 1}),
        ("[1, 2", "[1, 2"),
        ("oil", "oil"),
        ("1-2", "1-2"),
    ],
)
def test_values_of_texts(text: str, value: object) -> None:
    """Assert numbers, lists and tables as TOML has them; other texts stay as they are."""
    found = _value(text)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"one": {"mas": 1}}, r"one.mas is not a key of the scene; \[one\] may have kind, mass and from"),
        (
            {"one": {}, "twoo": {}},
            "twoo is not a key of the scene; the scene may have one, two, many and plain",
        ),
        ({"on": {}}, "on is not a key of the scene; the scene may have"),
        ({}, "one is missing; it must be a table with kind, mass and from"),
        ({"one": {"mass": 10}}, r"one.mass is 10; it must be a number from 0 to 9 \(kg\)"),
        ({"one": {}, "many": [{}, {"mass": 11}]}, r"many.2.mass is 11; it must be a number from 0 to 9"),
        ({"one": 4}, "one is 4; it must be a table with kind, mass and from"),
    ],
)
def test_first_complaint(given: dict[str, Any], said: str) -> None:
    """Assert the sentence: of a mistyped key before that of what it leaves missing."""
    with pytest.raises(ValidationError) as error:
        Outer.model_validate(given)
    with pytest.raises(InputError, match=f"^{said}"):
        raise complaint(Outer, error.value)
