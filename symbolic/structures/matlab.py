"""Matrices in MATLAB's files up to version 7.

From version 5 on a file is made of elements: a type, a count of bytes, and these. SciPy's reader of them ends
the process at some that lie, so that they are read here; version 4 is read by SciPy.
"""

from __future__ import annotations

import io
import math
import struct
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from symbolic.guarded import LARGEST, DamagedError
from symbolic.structures.matrices import sparse

files: Any = scipy.io.matlab
"""Untyped: its stubs know of paths alone."""

HEADER = 128
"""Bytes before the first variable from version 5 on."""

MATRIX, COMPRESSED = 14, 15
"""Types of what a file is made of: a variable, and one that is compressed."""

TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
"""NumPy's types by those of the numbers of an element."""

SPARSE, FIRST, LAST = 5, 6, 15
"""Classes of variables: sparse ones, and the first and the last of those of plain numbers."""

COMPLEX = 0x800
"""The flag of a variable that has an imaginary part."""

SHORT = "it ends before what it declares"
LARGER = "it declares a matrix that is larger than what it holds"
STRANGE = "it has an element of no known type, or one that ends beyond it"


def matlab(path: Path, held: bytes) -> Mapping[str, Any]:
    """Return the variables of a MATLAB file that are numbers: no cells, texts, objects or functions."""
    version = files.matfile_version(io.BytesIO(held))[0]
    if version not in (0, 1):
        raise DamagedError("it is of MATLAB's version 7.3; save it there with -v7")
    found: dict[str, Any] = {}
    for name, matrix in _of_version_4(held) if version == 0 else _of_version_5(held):
        if name in found:
            raise DamagedError("it has two variables of one name")
        found[name] = matrix
    return found


def _of_version_4(held: bytes) -> Iterator[tuple[str, Any]]:
    """The variables, once each has the bytes that its header of five numbers declares."""
    place = 0
    while place < len(held):
        if place + 20 > len(held):
            raise DamagedError(SHORT)
        order = "<" if 0 <= struct.unpack_from("<i", held, place)[0] < 5000 else ">"
        kind, rows, columns, imaginary, name = struct.unpack_from(f"{order}5i", held, place)
        size = {0: 8, 1: 4, 2: 4, 3: 2, 4: 2, 5: 1}.get(kind // 10 % 10)
        if size is None or min(rows, columns, imaginary, name) < 0:
            raise DamagedError(SHORT)
        place += 20 + name + size * rows * columns * (2 if imaginary else 1)
    if place != len(held):
        raise DamagedError(SHORT)
    for name, shape, kind in files.whosmat(io.BytesIO(held)):
        if kind != "char":
            if min(shape) < 0 or max(shape) > len(held):
                raise DamagedError(LARGER)
            yield name, files.loadmat(io.BytesIO(held), variable_names=[name])[name]


def _of_version_5(held: bytes) -> Iterator[tuple[str, Any]]:
    """The variables one after another, uncompressed."""
    order, place, total = ">" if held[126:128] == b"MI" else "<", HEADER, 0
    while place < len(held):
        kind, variable = _element(held, place, order)
        place += 8 + len(variable)
        if kind == COMPRESSED:
            kind, variable = _element(zlib.decompressobj().decompress(variable, LARGEST + 1), 0, order)
        total += len(variable)
        if total > LARGEST:
            raise DamagedError(f"its arrays take more than {LARGEST} bytes")
        if kind != MATRIX:
            raise DamagedError(STRANGE)
        yield from _variable(variable, order)


def _element(held: bytes, place: int, order: str) -> tuple[int, bytes]:
    """The type and the bytes of an element that has its count in a place of its own."""
    if place + 8 > len(held):
        raise DamagedError(SHORT)
    kind, count = struct.unpack_from(f"{order}II", held, place)
    if not 0 < count <= len(held) - place - 8:
        raise DamagedError(SHORT)
    return kind, held[place + 8 : place + 8 + count]


def _variable(held: bytes, order: str) -> Iterator[tuple[str, Any]]:
    """The name and the numbers of a variable, if it is one of numbers."""
    if len(held) < 16:
        raise DamagedError(SHORT)
    flags = struct.unpack_from(f"{order}I", held, 8)[0]
    kind = flags & 0xFF
    if kind == SPARSE or FIRST <= kind <= LAST:
        _, shape, name, *parts = _elements(held, order)
        size = [int(number) for number in shape]
        matrix = _sparse(size, parts) if kind == SPARSE else _dense(size, parts, bool(flags & COMPLEX))
        yield name.tobytes().decode(errors="replace"), matrix


def _elements(held: bytes, order: str) -> Iterator[np.ndarray[Any, Any]]:
    """The numbers of each element of a variable; those of up to four bytes stand beside their type."""
    place = 0
    while place < len(held):
        if place + 8 > len(held):
            raise DamagedError(STRANGE)
        kind, count = struct.unpack_from(f"{order}II", held, place)
        small = kind >> 16
        begin, count, kind = (place + 4, small, kind & 0xFFFF) if small else (place + 8, count, kind)
        if (small > 4) or begin + count > len(held) or kind not in TYPES:
            raise DamagedError(STRANGE)
        yield np.frombuffer(held[begin : begin + count], f"{order}{TYPES[kind]}")
        place = place + 8 if small else begin + count + -count % 8


def _dense(size: list[int], parts: list[np.ndarray[Any, Any]], complex_: bool) -> Any:
    numbers = parts[0] + 1j * parts[1] if complex_ else parts[0]
    if min(size, default=0) < 0 or math.prod(size) > len(numbers):
        raise DamagedError(LARGER)
    return numbers.reshape(size, order="F")


def _sparse(size: list[int], parts: list[np.ndarray[Any, Any]]) -> Any:
    """Columns compressed; the arrays may be longer than what is used of them."""
    rows, columns, *values = (part.astype(np.int64) if k < 2 else part for k, part in enumerate(parts))
    numbers = values[0] + 1j * values[1] if len(values) > 1 else values[0]
    if len(size) != 2 or min(size) < 0 or len(columns) != size[1] + 1:
        raise DamagedError(LARGER)
    used = int(columns[-1])
    if not 0 <= used <= min(len(rows), len(numbers)):
        raise DamagedError(LARGER)
    native = numbers[:used].astype(numbers.dtype.newbyteorder("="))
    found = sparse.csc_array((native, rows[:used], columns), shape=size)
    found.check_format(full_check=True)
    return found
