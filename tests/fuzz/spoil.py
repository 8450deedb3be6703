"""Bytes spoilt at random: bits, lengths, numbers as text and as machines write them."""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from typing import Any

import numpy as np

Random = np.random.Generator

SECRET = b"Zq7XKEYZq7"
"""What is put into files, and no sentence may quote."""

TEXTS = [
    *(b"0", b"-1", b"1e300", b"-1e300", b"1e-300", b"5e-324", b"nan", b"inf", b"1e999", b"1e100000000"),
    *(b"1000000000000", b"9223372036854775808", b"9" * 400, b"9" * 5000, b"4294967295", b"1e9"),
    *(b"", b" ", b"\n", b"null", b"true", b'"a"', b"[]", b"{}", b"[" * 3000, b"*", b"%", b"\x00", SECRET),
]
"""Found where a number stands in a text."""

WORDS = [0, 1, -1, 2**31 - 1, -(2**31), 48, 24, 2**16, 2**20, 2**28, 10**9, 3, 8, 14, 15]
LONG = [0, -1, 2**63 - 1, -(2**63), 10**12, 2**32, 2**40, 7 * 2**30]
REALS = [0.0, -1.0, 1e300, -1e300, 1e-300, 5e-324, float("nan"), float("inf"), 1e308]


def spoilt(held: bytes, random: Random, *, texts: bool = False) -> bytes:
    """Return some bytes, one to a few things in them changed."""
    for _ in range(int(random.geometric(0.6))):
        ways = WAYS if not texts else [*WAYS, _number, _number, _number]
        held = one_of(ways, random)(held, random)
    return held


def one_of(items: list[Any], random: Random) -> Any:
    """Return one of some things."""
    return items[int(random.integers(len(items)))]


def _number(held: bytes, random: Random) -> bytes:
    """A number of a text becomes another."""
    found = list(re.finditer(rb"-?\d+(\.\d*)?([eE][+-]?\d+)?", held[:200_000]))
    if not found:
        return held
    hit = one_of(found, random)
    return held[: hit.start()] + bytes(one_of(TEXTS, random)) + held[hit.end() :]


def _bit(held: bytes, random: Random) -> bytes:
    changed = bytearray(held or b"\0")
    changed[_place(held, random) % len(changed)] ^= 1 << int(random.integers(8))
    return bytes(changed)


def _word(held: bytes, random: Random) -> bytes:
    """A whole number or a real one in a machine's form, anywhere; beginnings hold most that matters."""
    form, values = one_of([("<i", WORDS), (">i", WORDS), ("<q", LONG), ("<d", REALS)], random)
    place = _place(held, random)
    place -= place % 4 if random.random() < 0.8 else 0
    word = struct.pack(form, one_of(list(values), random))
    return held[:place] + word + held[place + len(word) :]


def _cut(held: bytes, random: Random) -> bytes:
    return held[: int(random.integers(len(held) + 1))]


def _out(held: bytes, random: Random) -> bytes:
    place = _place(held, random)
    return held[:place] + held[place + int(random.integers(1, 60)) :]


def _twice(held: bytes, random: Random) -> bytes:
    a, b = sorted(int(random.integers(len(held) + 1)) for _ in range(2))
    return held[:b] + held[a : min(b, a + 4000)] + held[b:]


def _noise(held: bytes, random: Random) -> bytes:
    place = _place(held, random)
    return held[:place] + random.bytes(int(random.integers(1, 30))) + held[place:]


def _marked(held: bytes, random: Random) -> bytes:
    place = _place(held, random)
    return held[:place] + SECRET + held[place:]


def _place(held: bytes, random: Random) -> int:
    end = len(held) if random.random() < 0.6 else min(len(held), 300)
    return int(random.integers(end + 1))


WAYS: list[Callable[[bytes, Random], bytes]] = [
    *(_bit, _bit, _word, _word, _word, _cut, _out, _twice, _noise, _marked),
]
