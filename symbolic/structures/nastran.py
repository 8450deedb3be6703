"""Matrices in Nastran's OUTPUT4 files."""

from __future__ import annotations

import struct
import warnings
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from symbolic.guarded import DamagedError
from symbolic.structures.matrices import sparse

LARGER = "it declares a matrix that is larger than what it holds"

FILLED = 4
"""How much larger than their file dense matrices may be; else they are sparse: files leave out zeros."""


def op4(path: Path, held: bytes) -> Mapping[str, Any]:
    """Return the matrices of a Nastran OUTPUT4 file, names in capitals, by pyyeti."""
    module = _module("pyyeti.nastran.op4")
    warnings.filterwarnings("ignore", "Output4 file has matrix name")  # it is called m0, m1, ... then
    kept: bool | None = True  # in text zeros may be left out, and how many is not known before it is read
    if 0 in held[:4]:
        _check_records(held)
        names, sizes, _, _ = module.dir(str(path), verbose=False)
        if len({*names}) < len(names):
            raise DamagedError("it has two matrices of one name")
        kept = None if _small(sizes, held) else True
    read = module.read(str(path), into="dct", justmatrix=True, sparse=kept)
    small = _small([matrix.shape for matrix in read.values()], held)
    return {
        name.upper(): matrix.toarray() if small and kept and sparse.issparse(matrix) else matrix
        for name, matrix in read.items()
    }


def _small(sizes: Sequence[tuple[int, int]], held: bytes) -> bool:
    """Whether matrices may be dense. Raises DamagedError for those of more rows than a file has bytes."""
    if any(max(size) > len(held) or min(size) < 0 for size in sizes):
        raise DamagedError(LARGER)
    return 8 * sum(rows * columns for rows, columns in sizes) <= FILLED * len(held)


def _check_records(held: bytes) -> None:
    """Refuse a binary file that is no chain of Fortran's records: length, so many bytes, length."""
    order = "<" if struct.unpack_from("<I", held)[0] <= 48 else ">"
    place = 0
    while place < len(held):
        if place + 8 > len(held):
            raise DamagedError("it ends within a record")
        (count,) = struct.unpack_from(f"{order}i", held, place)
        end = place + 4 + count
        if count < 0 or end + 4 > len(held) or struct.unpack_from(f"{order}i", held, end)[0] != count:
            raise DamagedError("it ends within a record")
        place = end + 4


def _module(name: str) -> ModuleType:
    """A package that is installed only for its format; how it sets NumPy's printing is undone."""
    with np.printoptions():
        return import_module(name)
