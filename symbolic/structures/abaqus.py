"""Matrices in .mtx files: Matrix Market, and Abaqus in any of its three forms."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from symbolic.arrays import Array
from symbolic.guarded import DamagedError
from symbolic.structures.market import entries, matrix_market, whole_numbers
from symbolic.structures.matrices import sparse

BELOW = "its indices begin below 1"

KEYS = {"STIFFNESS": "K", "MASS": "M"}
"""The types of matrices that a substructure has, and what they are called here."""


def mtx(path: Path, held: bytes) -> Mapping[str, Any]:
    """Return what a .mtx file holds: Matrix Market, or Abaqus in any of its three forms.

    The forms of Abaqus are `*SUBSTRUCTURE MATRIX OUTPUT`, and of `*MATRIX OUTPUT` the formats COORDINATE
    (row, column, value) and MATRIX INPUT (node, dof, node, dof, value; one triangle where it is symmetric).
    """
    head = held[: held.find(b"\n") + 1 or len(held)]
    if head.startswith(b"%%MatrixMarket"):
        return {"": matrix_market(held)}
    if head.startswith(b"*"):
        return substructure(held)
    rows = entries(held, "," if b"," in head else None)
    if rows.shape[1] == 3:
        row, column = whole_numbers(rows[:, :2], len(held)).T
        if min(row.min(), column.min()) < 1:
            raise DamagedError(BELOW)
        return {"": _filled(row - 1, column - 1, rows[:, 2])}
    if rows.shape[1] == 5:
        four = whole_numbers(rows[:, :4], 2**53)
        pairs = np.concatenate([four[:, :2], four[:, 2:]])
        numbered = np.unique(pairs, axis=0, return_inverse=True)[1].ravel()
        return {"": _filled(numbered[: len(rows)], numbered[len(rows) :], rows[:, 4])}
    raise DamagedError(f"its lines have {rows.shape[1]} numbers; 3 or 5 are known")


def substructure(held: bytes) -> dict[str, Any]:
    """Return stiffness and mass of `*SUBSTRUCTURE MATRIX OUTPUT`: lower triangles by rows, or all of K.

    Only a stiffness is ever written whole, where the user element is UNSYM.
    """
    found, whole = {}, False
    for words, numbers in _keywords(held.decode(errors="replace")):
        if words[0] == "USER ELEMENT":
            whole = "UNSYM" in words
        name = KEYS.get(next((word[5:].strip() for word in words if word.startswith("TYPE=")), ""))
        if words[0] == "MATRIX" and name is not None:
            found[name] = _square(numbers, whole and name == "K")
    return found


def _keywords(text: str) -> Iterator[tuple[list[str], Array]]:
    """Each keyword line, in capitals cut at commas, and the numbers below it; those of other lines unread."""
    for block in "".join(line for line in text.splitlines(True) if not line.startswith("**")).split("*")[1:]:
        head, _, below = block.partition("\n")
        words = [word.strip() for word in head.upper().split(",")]
        numbers = below.replace(",", " ").split() if words[0] == "MATRIX" else []
        yield words, np.array([float(number) for number in numbers])


def _square(numbers: Array, whole: bool) -> Array:
    size = math.isqrt(len(numbers) if whole else 2 * len(numbers))
    if len(numbers) != (size * size if whole else size * (size + 1) // 2):
        form = "square" if whole else "triangle"
        raise DamagedError(f"it has a matrix of {len(numbers)} numbers, which make no {form}")
    if whole:
        return numbers.reshape(size, size)
    matrix, below = np.zeros((size, size)), np.tril_indices(size)
    matrix[below] = numbers
    matrix.T[below] = numbers
    return matrix


def _filled(row: Any, column: Any, value: Any) -> Any:
    """A sparse matrix of entries; where only one triangle is there, the other is its mirror image."""
    size = int(max(row.max(), column.max())) + 1
    if (row >= column).all() or (row <= column).all():
        below = row != column
        row, column = np.r_[row, column[below]], np.r_[column, row[below]]
        value = np.r_[value, value[below]]
    return sparse.coo_array((value, (row, column)), shape=(size, size)).tocsr()
