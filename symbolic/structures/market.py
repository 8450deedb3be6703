"""Matrix Market, NIST's exchange format of matrices, and what it has in common with other files of text.

SciPy's own reader ends the process at some files that are none.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from symbolic.arrays import Array
from symbolic.guarded import DamagedError
from symbolic.structures.matrices import sparse

MIRRORED = {"general": 0, "symmetric": 1, "skew-symmetric": -1}
"""Factors of the mirror images of the entries below the diagonal."""

LARGER = "it declares a matrix that is larger than what it holds"


def matrix_market(held: bytes) -> Any:
    """Return the matrix of a Matrix Market file, dense or sparse as written.

    Parameters
    ----------
    held : bytes
        The file: a line that says form, field and symmetry, comments, sizes, and entries one a line.

    Returns
    -------
    ndarray or scipy.sparse.coo_array, shape (rows, columns)
        The matrix.

    Raises
    ------
    DamagedError
        For what is complex, and where sizes or indices are not those of the entries.
    ValueError
        For lines that are no numbers.
    """
    head, _, rest = held.partition(b"\n")
    words = head.decode(errors="replace").lower().split()[1:]
    if len(words) != 4 or words[0] != "matrix" or words[1] not in ("array", "coordinate"):
        raise DamagedError("its first line does not say what it is")
    _, form, field, symmetry = words
    if field not in ("real", "double", "integer", "pattern") or symmetry not in MIRRORED:
        raise DamagedError("it is not of real numbers")
    while rest.lstrip().startswith(b"%"):
        rest = rest.lstrip().partition(b"\n")[2]
    line, _, body = rest.lstrip().partition(b"\n")
    sizes = [int(word) for word in line.split()[:3] if len(word) < 20]
    if form == "array":
        return _dense(sizes, body, MIRRORED[symmetry])
    return _sparse(sizes, body, MIRRORED[symmetry])


def _dense(sizes: list[int], body: bytes, mirrored: int) -> Array:
    """A matrix of its entries by columns; with a mirror image of those on the diagonal, if any, and below."""
    if len(sizes) != 2 or min(sizes) < 1:
        raise DamagedError(LARGER)
    rows, columns = sizes
    if mirrored and rows != columns:
        raise DamagedError("it has not as many entries as it declares")
    if (rows * columns + mirrored * rows) // (2 if mirrored else 1) > len(body.strip()):
        raise DamagedError(LARGER)
    values, matrix = entries(body).ravel(), np.zeros((rows, columns))
    if not mirrored:
        below = np.ones((rows, columns), dtype=bool)
    else:
        below = np.tri(rows, columns, k=0 if mirrored > 0 else -1, dtype=bool)
    if len(values) != below.sum():
        raise DamagedError("it has not as many entries as it declares")
    matrix.T[below.T] = values
    return matrix + mirrored * np.tril(matrix, -1).T if mirrored else matrix


def _sparse(sizes: list[int], body: bytes, mirrored: int) -> Any:
    if len(sizes) != 3 or min(sizes) < 1 or max(sizes) > len(body):
        raise DamagedError(LARGER)
    found = entries(body)
    if len(found) != sizes[2] or found.shape[1] not in (2, 3):
        raise DamagedError("it has not as many entries as it declares")
    row, column = whole_numbers(found[:, :2], max(sizes)).T - 1
    value = found[:, 2] if found.shape[1] == 3 else np.ones(len(found))
    if min(row.min(), column.min()) < 0 or row.max() >= sizes[0] or column.max() >= sizes[1]:
        raise DamagedError("it has entries outside its matrix")
    if mirrored:
        if sizes[0] != sizes[1]:
            raise DamagedError("it is symmetric and not square")
        below = row != column
        row, column = np.r_[row, column[below]], np.r_[column, row[below]]
        value = np.r_[value, mirrored * value[below]]
    return sparse.coo_array((value, (row, column)), shape=(sizes[0], sizes[1]))


def entries(held: bytes, delimiter: str | None = None) -> Array:
    """Return the numbers of lines of text, comments left out, shape (lines, numbers). Raises ValueError."""
    text = io.StringIO(held.decode(errors="replace"))
    return np.loadtxt(text, delimiter=delimiter, comments=("*", "%", "#"), ndmin=2)


def whole_numbers(given: Array, most: int) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Return indices of a file, none so large that a matrix of that size would not fit it."""
    if not (np.abs(given) <= most).all() or (given != np.round(given)).any():
        raise DamagedError("it has indices that are not whole numbers, or larger than what it holds")
    return given.astype(np.int64)
