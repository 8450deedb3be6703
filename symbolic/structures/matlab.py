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
        total += _uncompressed(held[place + 8 : place + 8 + count]) if kind == COMPRESSED else count
        place += 8 + count
        if total > LARGEST:
            raise DamagedError(f"its arrays take more than {LARGEST} bytes")
    return total


def _uncompressed(held: bytes) -> int:
    """The length of what was compressed, as far as it is of interest."""
    reader, length = zlib.decompressobj(), 0
    while held and length <= LARGEST:
        length += len(reader.decompress(held, 2**20))
        held = reader.unconsumed_tail
    return length


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
