"""Matrices in MATLAB's files up to version 7."""

from __future__ import annotations

import io
import math
import struct
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import scipy

from symbolic.guarded import LARGEST, DamagedError

files: Any = scipy.io.matlab
"""Untyped: its stubs know of paths alone."""

HEADER = 128
"""Bytes before the first variable from version 5 on."""

MATRIX, COMPRESSED = 14, 15
"""Types of what a file is made of: a variable, and one that is compressed."""

NUMBERS = {"double", "single", "sparse", "logical"} | {
    f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
}
"""Classes of variables that are read: no cells, no texts, no objects, no functions."""

NUMERIC = range(5, 16)
"""Codes of the classes of numbers, those of sparse matrices included."""

TYPES = {*range(1, 8), 9, 12, 13}
"""Codes of the types of numbers in a file."""

SHORT = "it ends before what it declares"


def matlab(path: Path, held: bytes) -> Mapping[str, Any]:
    """Return the variables of a MATLAB file that are numbers."""
    version = files.matfile_version(io.BytesIO(held))[0]
    if version not in (0, 1):
        raise DamagedError("it is of MATLAB's version 7.3; save it there with -v7")
    bytes_held = _of_version_4(held) if version == 0 else _of_version_5(held)
    declared = files.whosmat(io.BytesIO(held))
    numbers = {name: shape for name, shape, kind in declared if kind in NUMBERS}
    if len({name for name, *_ in declared}) < len(declared):
        raise DamagedError("it has two variables of one name")
    sparse = {name for name, _, kind in declared if kind == "sparse"}
    sizes = [max(shape, default=0) if name in sparse else math.prod(shape) for name, shape in numbers.items()]
    if min(map(min, numbers.values()), default=0) < 0 or max(sizes, default=0) > bytes_held:
        raise DamagedError("it declares a matrix that is larger than what it holds")
    found = files.loadmat(io.BytesIO(held), variable_names=list(numbers))
    return {name: found[name] for name in numbers}


def _of_version_5(held: bytes) -> int:
    """How many bytes a file has, uncompressed. Raises DamagedError where it declares more."""
    order = ">" if held[126:128] == b"MI" else "<"
    place, total = HEADER, HEADER
    while place < len(held):
        if place + 8 > len(held):
            raise DamagedError(SHORT)
        kind, count = struct.unpack_from(f"{order}II", held, place)
        if kind not in (MATRIX, COMPRESSED) or not 0 < count <= len(held) - place - 8:
            raise DamagedError(SHORT)
        variable = held[place + 8 : place + 8 + count]
        if kind == COMPRESSED:
            variable = zlib.decompressobj().decompress(variable, LARGEST + 1)
            kind, within = struct.unpack_from(f"{order}II", variable)
            if kind != MATRIX or within > len(variable) - 8:
                raise DamagedError(SHORT)
            variable = variable[8 : 8 + within]
        total, place = total + len(variable), place + 8 + count
        if total > LARGEST:
            raise DamagedError(f"its arrays take more than {LARGEST} bytes")
        _check_elements(variable, order)
    return total


def _check_elements(variable: bytes, order: str) -> None:
    """Refuse a variable of numbers whose elements are of no known type or end beyond it."""
    if len(variable) < 16 or variable[8 if order == "<" else 11] not in NUMERIC:
        return  # it is passed over
    place = 0
    while place < len(variable):
        if place + 8 > len(variable):
            raise DamagedError(SHORT)
        kind, count = struct.unpack_from(f"{order}II", variable, place)
        if kind >> 16:  # of up to four bytes, which stand in the place of the second number
            kind, count, end = kind & 0xFFFF, kind >> 16, place + 8
            short = count > 4
        else:
            end = place + 8 + count + -count % 8
            short = place + 8 + count > len(variable)
        if short or kind not in TYPES:
            raise DamagedError("it has an element of no known type, or one that ends beyond it")
        place = end


def _of_version_4(held: bytes) -> int:
    """The same for files of version 4: of each variable a header of five numbers, its name, its entries."""
    place = 0
    while place < len(held):
        if place + 20 > len(held):
            raise DamagedError(SHORT)
        kind, *_ = struct.unpack_from("<i", held, place)
        order = "<" if 0 <= kind < 5000 else ">"
        kind, rows, columns, imaginary, name = struct.unpack_from(f"{order}5i", held, place)
        size = {0: 8, 1: 4, 2: 4, 3: 2, 4: 2, 5: 1}.get(kind // 10 % 10)
        if size is None or min(rows, columns, imaginary, name) < 0:
            raise DamagedError(SHORT)
        place += 20 + name + size * rows * columns * (2 if imaginary else 1)
    if place != len(held):
        raise DamagedError(SHORT)
    return len(held)
