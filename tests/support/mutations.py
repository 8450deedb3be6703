"""Scene files spoilt at random, in what they say or in their bytes; every seed is one file."""

from __future__ import annotations

import datetime
import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

SCENES = sorted((Path(__file__).parents[2] / "symbolic" / "scenes" / "data").glob("*.toml"))

Random = np.random.Generator
Tables = dict[str, Any]

ODD = [
    *(0, -0.0, -1, 1, 2, 1e-300, 5e-324, 1e300, -1e300, 10**30, 2**63, 10**400, float("nan"), float("inf")),
    *(-float("inf"), True, False, "", " ", "1", "nan", "810 N", "810", "a\nb", "\x00", "\x1b[2J\x1b]0;x\x07"),
    *("\u202eevil", "\u2028", "é", "\U0001f600", "$x_{\\frac", "{0} %s {", "x" * 3000, "[bold]", "null"),
    *("__import__('os').system('false')", [], [[]], [1, 2], [{}], [{"mass": 1.0}], {}, {"": {}}, {"a": 1}),
    *(datetime.date(1979, 5, 27), datetime.time(7, 32), datetime.datetime(1979, 5, 27, 7, 32)),
]
"""Values that are found where others belong."""

NAMES = [
    *("mass", "film", "law", "squeeze", "floor", "lubricant", "support", "damping", "ratio", "trace", "kind"),
    *("", " ", "Mass", "MASS", "mаss", "a.b", "a\nb", "\x00", "\x1b[2J", "'", '"', "__class__", "k" * 3000),
    *("\U0001f600", "0", "\u2028"),
]
"""Names that keys are given: those of other keys, and no names at all. One m-ss is Cyrillic."""

BYTES = [
    *(
        b"\x00",
        b"\xff",
        b"\xfe\xff",
        b"\xc3",
        b"\xed\xa0\x80",
        b"\r",
        b"\n",
        b"\r\n",
        b'"""',
        b"'",
        b"#",
        b"[",
    ),
    *(b"]]", b"=", b".", b"\x1b", b"\xe2\x80\xa8", b"\xef\xbb\xbf", b"0x", b"_", b"e99999", b"9" * 5000),
    *(b"0x" + b"f" * 5000, b"1979-05-27T07:32:00Z", b"\\u0000", b"[" * 3000, b"a." * 2000),
]


def mutant(seed: int) -> bytes:
    """Return the content of a scene file: a built-in one, some of it changed."""
    random = np.random.default_rng(seed)
    text = SCENES[random.integers(len(SCENES))].read_bytes()
    if random.random() < 0.65:
        tables = tomllib.loads(text.decode())
        for _ in range(1 + random.geometric(0.6)):
            _one_of(STRUCTURAL, random)(tables, random)
        text = _written(tables).encode()
    if random.random() < 0.45:
        for _ in range(random.geometric(0.5)):
            text = _one_of(BYTEWISE, random)(text, random)
    return text


def _one_of(items: list[Any], random: Random) -> Any:
    return items[int(random.integers(len(items)))]


def _places(tables: Tables) -> list[tuple[Tables, str]]:
    """Every key, with the table that it is in."""
    lists = [item for value in tables.values() if isinstance(value, list) for item in value]
    inner = [item for item in (*tables.values(), *lists) if isinstance(item, dict)]
    return [(tables, key) for key in tables] + [place for item in inner for place in _places(item)]


def _place(tables: Tables, random: Random) -> tuple[Tables, str]:
    places = _places(tables) or [(tables, "title")]
    table, key = _one_of(places, random)
    table.setdefault(key, 1.0)
    return table, key


def _removed(tables: Tables, random: Random) -> None:
    table, key = _place(tables, random)
    del table[key]


def _renamed(tables: Tables, random: Random) -> None:
    table, key = _place(tables, random)
    table[_one_of(NAMES, random)] = table.pop(key)


def _added(tables: Tables, random: Random) -> None:
    table, _ = _place(tables, random)
    table[_one_of(NAMES, random)] = _one_of(ODD, random)


def _moved(tables: Tables, random: Random) -> None:
    (a, key), (b, _) = _place(tables, random), _place(tables, random)
    value = a.pop(key)
    if b is not value:
        b[key] = value


def _swapped(tables: Tables, random: Random) -> None:
    (a, i), (b, j) = _place(tables, random), _place(tables, random)
    if not isinstance(a[i], dict) and not isinstance(b[j], dict):
        a[i], b[j] = b[j], a[i]


def _odd(tables: Tables, random: Random) -> None:
    table, key = _place(tables, random)
    table[key] = _one_of(ODD, random)


def _scaled(tables: Tables, random: Random) -> None:
    """In other units."""
    table, key = _place(tables, random)
    if isinstance(table[key], int | float):
        factor = _one_of([1e3, 1e-3, 1e6, 1e-6, 9.81, 0.10472, 60, -1], random)
        table[key] = factor * min(max(table[key], -1e300), 1e300)


def _varied(tables: Tables, random: Random) -> None:
    """As another user may have it."""
    table, key = _place(tables, random)
    if isinstance(table[key], float):
        table[key] = min(max(table[key], -1e300), 1e300) * 2 ** random.uniform(-1, 1)


def _grafted(tables: Tables, random: Random) -> None:
    """With a table of another scene."""
    other = tomllib.loads(_one_of(SCENES, random).read_text("utf-8"))
    key = _one_of(list(other), random)
    tables[key] = other[key]


def _emptied(tables: Tables, random: Random) -> None:
    table, key = _place(tables, random)
    table[key] = {}


def _buried(tables: Tables, random: Random) -> None:
    table, key = _place(tables, random)
    value = table[key]
    for _ in range(int(random.integers(1, 60))):
        value = {key: value} if random.random() < 0.5 else [value]
    table[key] = value


STRUCTURAL: list[Callable[[Tables, Random], None]] = [
    *(_removed, _renamed, _added, _moved, _swapped, _odd, _odd, _odd),
    *(_scaled, _scaled, _varied, _varied, _varied, _varied, _grafted, _grafted, _emptied, _buried),
]


def _flipped(text: bytes, random: Random) -> bytes:
    spoilt = bytearray(text or b" ")
    spoilt[random.integers(len(spoilt))] ^= 1 << int(random.integers(8))
    return bytes(spoilt)


def _inserted(text: bytes, random: Random) -> bytes:
    place = int(random.integers(len(text) + 1))
    return text[:place] + _one_of(BYTES, random) + text[place:]


def _cut(text: bytes, random: Random) -> bytes:
    return text[: int(random.integers(len(text) + 1))]


def _taken_out(text: bytes, random: Random) -> bytes:
    a, b = sorted(map(int, random.integers(len(text) + 1, size=2)))
    return text[:a] + text[min(b, a + 40) :]


def _line_twice(text: bytes, random: Random) -> bytes:
    lines = text.splitlines(keepends=True) or [b"\n"]
    lines.insert(int(random.integers(len(lines) + 1)), _one_of(lines, random))
    return b"".join(lines)


def _line_out(text: bytes, random: Random) -> bytes:
    lines = text.splitlines(keepends=True) or [b"\n"]
    del lines[random.integers(len(lines))]
    return b"".join(lines)


def _commented(text: bytes, random: Random) -> bytes:
    return text + b"# " + random.bytes(8).hex().encode() + b"\n"


BYTEWISE: list[Callable[[bytes, Random], bytes]] = [
    *(_flipped, _flipped, _inserted, _cut, _taken_out, _line_twice, _line_out, _commented),
]


def _written(tables: Tables) -> str:
    """TOML of tables: values first, then one [table] after another, all that is deeper inline."""
    plain = {key: value for key, value in tables.items() if not isinstance(value, dict)}
    text = _lines(plain)
    for name, table in tables.items():
        if isinstance(table, dict):
            text += f"\n[{_text(name)}]\n{_lines(table)}"
    return text


def _lines(table: Tables) -> str:
    return "".join(f"{_text(key)} = {_value(value)}\n" for key, value in table.items())


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=not text.isprintable())


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_text(key)} = {_value(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return str(value).lower()
