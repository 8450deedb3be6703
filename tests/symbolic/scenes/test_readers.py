"""How values of a type are read from text, and where the keys of a scene stand."""

from __future__ import annotations

import enum
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Literal

import pytest

from symbolic.equations.variables import Coordinate, Parameter
from symbolic.parts.contact.pair import ContactPair
from symbolic.scenes.errors import InputError, listed, shown
from symbolic.scenes.model import readers
from symbolic.scenes.model.bench import Bench, unknown
from symbolic.scenes.model.keys import model_keys
from symbolic.scenes.model.readers import PLAIN, Choice, Either, OneOf, Several, UnreadableError, reader_of
from symbolic.scenes.ranges import SpeedRange


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


class Kind(enum.Enum):
    """Two kinds."""

    THE_FIRST = 1
    OTHER = 2


X, Y = Coordinate("x"), Coordinate("y")
BENCH = Bench({"x": X, "y": Y}, {}, {"k": Parameter("k", 2.0)})
PAIR = PLAIN[ContactPair].allowed


@pytest.mark.parametrize(
    ("reader", "value", "found"),
    [
        (PLAIN[float], 3, 3.0),
        (PLAIN[float], -1e299, -1e299),
        (PLAIN[int], 3, 3),
        (PLAIN[bool], True, True),
        (PLAIN[str], "b", "b"),
        (PLAIN[Fraction], "1/2", "1/2"),
        (PLAIN[Parameter], 2, 2.0),
        (PLAIN[Coordinate], "y", Y),
        (Choice(Kind), "the-first", Kind.THE_FIRST),
        (Choice(Kind), "other", Kind.OTHER),
        (OneOf(("a", "b")), "b", "b"),
        (Several(PLAIN[float]), [1, 2.5], (1.0, 2.5)),
        (Several(PLAIN[float]), [], ()),
        (Several(PLAIN[float], 2), [1, 2], (1.0, 2.0)),
        (Either((PLAIN[bool], PLAIN[str])), "b", "b"),
        (Either((PLAIN[bool], PLAIN[str])), False, False),
    ],
)
def test_values_that_are_read(reader: Any, value: Any, found: Any) -> None:
    """Assert what each reader makes of a value, and that it reads its own example."""
    got = reader.read(BENCH, "where", value)
    assert got == found and type(got) is type(found)
    assert reader.read(BENCH, "where", reader.example) is not None


@pytest.mark.parametrize(
    ("value", "coordinates", "name"),
    [
        ("x", (X,), "contact"),
        (["x", "y"], (X, Y), "contact"),
        ({"coordinates": ["y"], "name": "upper"}, (Y,), "upper"),
    ],
)
def test_contact_pairs_that_are_read(value: Any, coordinates: tuple[Coordinate, ...], name: str) -> None:
    """Assert coordinates and name, and that equal tables are one pair."""
    found = PLAIN[ContactPair].read(BENCH, "where", value)
    assert (found.coordinates, found.name) == (coordinates, name)
    assert PLAIN[ContactPair].read(BENCH, "elsewhere", value) is found
    assert PLAIN[Parameter].read(BENCH, "where", "k") is BENCH.parameters["k"]


@pytest.mark.parametrize(
    ("reader", "value", "said"),
    [
        (PLAIN[float], True, "where is true; it must be a number"),
        (PLAIN[float], "1", 'where is "1"; it must be a number'),
        (PLAIN[float], 1e300, "where is 1e+300; it must be a number"),
        (PLAIN[float], -1e300, "where is -1e+300; it must be a number"),
        (PLAIN[float], float("nan"), "where is nan; it must be a number"),
        (PLAIN[int], 1.0, "where is 1.0; it must be a whole number"),
        (PLAIN[bool], 1, "where is 1; it must be true or false"),
        (
            PLAIN[Parameter],
            "c",
            'where is "c"; it must be a number or the name of one in [parameters]; there is k',
        ),
        (PLAIN[Coordinate], 3, "where is 3; it must be the name of a [[coordinate]]"),
        (PLAIN[Coordinate], "xx", 'where is "xx"; it must be the name of a [[coordinate]]; nearest is "x"'),
        (PLAIN[ContactPair], [], f"where is a list; it must be {PAIR}"),
        (PLAIN[ContactPair], {"coordinates": ["x"], "law": 1}, f"where is a table; it must be {PAIR}"),
        (PLAIN[ContactPair], {"coordinates": ["x"], "name": 1}, f"where is a table; it must be {PAIR}"),
        (PLAIN[ContactPair], [3], "where is 3; it must be the name of a [[coordinate]]"),
        (Choice(Kind), "first", 'where is "first"; it must be "the-first" or "other"'),
        (OneOf(("a", "b", "c")), "d", 'where is "d"; it must be "a", "b" or "c"'),
        (OneOf(("a",)), ["a"], 'where is a list; it must be "a"'),
        (Several(PLAIN[float], 2), [1.0], "where is a list; it must be a list of 2, each a number"),
        (Several(PLAIN[float]), 1.0, "where is 1.0; it must be a list, each a number"),
        (Several(PLAIN[float]), [1.0, "b"], 'where[2] is "b"; it must be a number'),
        (Either((PLAIN[bool], PLAIN[str])), 3, "where is 3; it must be true or false or a text"),
        (Either((PLAIN[bool],)), 3, "where is 3; it must be true or false"),
    ],
)
def test_values_that_are_refused(reader: Any, value: Any, said: str) -> None:
    """Assert one sentence that names the place, the value and what is allowed."""
    with pytest.raises(InputError) as caught:
        reader.read(BENCH, "where", value)
    assert str(caught.value) == said


@pytest.mark.parametrize(
    ("count", "names"),
    [(0, "none"), (1, "n0"), (2, "n0 and n1"), (12, "n10 and n11"), (13, "n11 and others")],
)
def test_names_that_there_are(count: int, names: str) -> None:
    """Assert that at most twelve are listed."""
    said = str(unknown("where", "zzz", [f"n{k}" for k in range(count)], "a name"))
    assert said.startswith('where is "zzz"; it must be a name; there is ') and said.endswith(names)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ({"a": 1}, "a table"),
        ([1], "a list"),
        (True, "true"),
        (2.5, "2.5"),
        ("a\n b", '"a b"'),
        (10**400, "a number of too many digits"),
        (-(10**400), "a number of too many digits"),
        (7, "7"),
    ],
)
def test_values_in_a_sentence(value: Any, text: str) -> None:
    """Assert that they are on one line and not too long."""
    assert shown(value) == text


@pytest.mark.parametrize(
    ("names", "said"), [([], ""), (["a"], "a"), (["a", "b"], "a or b"), (["a", "b", "c"], "a, b or c")]
)
def test_lists_in_a_sentence(names: list[str], said: str) -> None:
    """Assert commas and the last word."""
    assert listed(names) == said and listed(names, "and") == said.replace(" or ", " and ")


def test_range_in_other_units() -> None:
    """Assert bounds in SI, and both ends as shown in another unit; an empty range is refused."""
    given = SpeedRange(from_rpm=60.0, to_rpm=30.0)
    assert given.bounds == pytest.approx((2 * math.pi, math.pi), rel=1e-15)
    assert (given.ends, given.axis, given.written) == ((60.0, 30.0), "rev/min", ("from_rpm", "to_rpm"))
    shown_in = given.shown_in("Hz")
    assert (shown_in.ends, shown_in.axis) == ((1.0, 0.5), "Hz")
    assert shown_in.unit == pytest.approx(2 * math.pi) and given.axis == "rev/min"
    assert given.shown_in("rev/min").ends == (60.0, 30.0)
    said = "trace.to_rpm is 60; it must differ from trace.from_rpm so that there is a range"
    with pytest.raises(InputError, match=f"^{said}$"):
        SpeedRange(from_rpm=60.0, to_rpm=60.0)
