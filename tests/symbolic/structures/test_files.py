"""Matrices in files of other programs: forms and sizes, by bytes written by hand."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np
import pytest

from symbolic.guarded import DamagedError
from symbolic.structures import abaqus, nastran


@pytest.mark.parametrize(
    ("sizes", "held", "small"),
    [
        ([(4, 4)], 32, True),
        ([(4, 4)], 31, False),
        ([(2, 8)], 32, True),
        ([(4, 2), (2, 4)], 32, True),
        ([(4, 2), (2, 4)], 31, False),
        ([(32, 0)], 32, True),
        ([], 0, True),
    ],
)
def test_matrices_that_may_be_dense(sizes: list[tuple[int, int]], held: int, small: bool) -> None:
    """Assert 8 bytes a number, together up to four times their file."""
    assert nastran._small(sizes, bytes(held)) is small


@pytest.mark.parametrize("size", [(33, 1), (1, 33), (-1, 4), (4, -1)])
def test_matrices_larger_than_their_file(size: tuple[int, int]) -> None:
    """Assert the sentence for more rows or columns than bytes, and for fewer than none."""
    with pytest.raises(DamagedError, match="^it declares a matrix that is larger than what it holds$"):
        nastran._small([(1, 1), size], bytes(32))


def records(order: str, *counts: int) -> bytes:
    """A chain of Fortran's records."""
    ends = [struct.pack(f"{order}i", count) for count in counts]
    return b"".join(end + bytes(count) + end for end, count in zip(ends, counts, strict=True))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("counts", [(24,), (48,), (24, 0), (24, 8, 300)])
def test_chains_of_records(order: str, counts: Sequence[int]) -> None:
    """Assert that whole ones are taken in either order of bytes, empty records too, and none that is cut."""
    held = records(order, *counts)
    nastran._check_records(held)
    with pytest.raises(DamagedError):
        nastran._check_records(held[:-1])


@pytest.mark.parametrize(
    "held",
    [
        records("<", 24)[:-1],
        records("<", 24) + bytes(7),
        records("<", 24) + struct.pack("<i", -8) + struct.pack("<i", -8),
        records("<", 24)[:-4] + struct.pack("<i", 23),
        records("<", 24) + struct.pack("<i", 9) + bytes(4),
        records("<", 49),
        records("<", 24) + records(">", 24),
    ],
    ids=["cut", "begun", "negative", "another end", "past the end", "too long for a first one", "two orders"],
)
def test_broken_chains(held: bytes) -> None:
    """Assert the sentence."""
    with pytest.raises(DamagedError, match="^it ends within a record$"):
        nastran._check_records(held)


def test_triangle_and_square() -> None:
    """Assert a lower triangle by rows, mirrored, and all numbers by rows."""
    assert abaqus._square(np.arange(1.0, 7.0), False).tolist() == [[1, 2, 4], [2, 3, 5], [4, 5, 6]]
    assert abaqus._square(np.arange(1.0, 5.0), True).tolist() == [[1, 2], [3, 4]]
    assert abaqus._square(np.zeros(0), False).shape == abaqus._square(np.zeros(0), True).shape == (0, 0)


@pytest.mark.parametrize("count", [2, 4, 5, 7])
def test_numbers_that_make_no_triangle(count: int) -> None:
    """Assert the sentence with their number."""
    with pytest.raises(DamagedError, match=f"^it has a matrix of {count} numbers, which make no triangle$"):
        abaqus._square(np.ones(count), False)


@pytest.mark.parametrize("count", [2, 3, 5, 8])
def test_numbers_that_make_no_square(count: int) -> None:
    """Assert the sentence with their number."""
    with pytest.raises(DamagedError, match=f"^it has a matrix of {count} numbers, which make no square$"):
        abaqus._square(np.ones(count), True)


@pytest.mark.parametrize(
    ("entries", "matrix"),
    [
        ([(0, 0, 1), (1, 0, 2), (2, 1, 3)], [[1, 2, 0], [2, 0, 3], [0, 3, 0]]),
        ([(0, 0, 1), (0, 1, 2), (1, 2, 3)], [[1, 2, 0], [2, 0, 3], [0, 3, 0]]),
        ([(0, 1, 2), (1, 0, 5)], [[0, 2], [5, 0]]),
        ([(0, 0, 4), (1, 1, 5)], [[4, 0], [0, 5]]),
        ([(1, 0, 2), (1, 0, 3)], [[0, 5], [5, 0]]),
    ],
    ids=["lower", "upper", "both", "diagonal", "twice"],
)
def test_entries(entries: list[tuple[int, int, float]], matrix: list[list[float]]) -> None:
    """Assert that one triangle is mirrored, two are not, and entries of one place add up."""
    row, column, value = np.array(entries).T
    assert abaqus._filled(row, column, value.astype(float)).toarray().tolist() == matrix


@pytest.mark.parametrize(
    ("text", "matrix"),
    [
        ("1 1 4.0\n2 1 1.0\n2 2 3.0\n", [[4, 1], [1, 3]]),
        ("1, 1, 4.0\n2, 2, 3.0\n", [[4, 0], [0, 3]]),
        ("7 1 7 1 4.0\n7 3 7 1 1.0\n9 1 9 1 2.0\n", [[4, 1, 0], [1, 0, 0], [0, 0, 2]]),
    ],
    ids=["row and column", "with commas", "node and freedom"],
)
def test_lists_of_entries(text: str, matrix: list[list[float]]) -> None:
    """Assert the forms of Abaqus that have no keyword; freedoms in the order of their nodes."""
    (found,) = abaqus.mtx(None, text.encode()).values()  # type: ignore[arg-type]
    assert found.toarray().tolist() == matrix


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("0 1 4.0\n1 1 1.0\n", "its indices begin below 1"),
        ("1 0 4.0\n1 1 1.0\n", "its indices begin below 1"),
        ("1 1 1 4.0\n", "its lines have 4 numbers; 3 or 5 are known"),
        ("1 4.0\n", "its lines have 2 numbers; 3 or 5 are known"),
    ],
)
def test_lists_that_are_none(text: str, said: str) -> None:
    """Assert the sentence."""
    with pytest.raises(DamagedError, match=f"^{said}$"):
        abaqus.mtx(None, text.encode())  # type: ignore[arg-type]


SUBSTRUCTURE = """** made by hand
*USER ELEMENT, NODES=2{unsym}
*MATRIX, TYPE=STIFFNESS
{stiffness}
** a remark within
*MATRIX,TYPE=MASS
7., 0., 8.
*DAMPING, ALPHA=1.
"""


def test_substructures() -> None:
    """Assert that only the stiffness of an unsymmetric element is written whole."""
    plain = abaqus.substructure(SUBSTRUCTURE.format(unsym="", stiffness="1., 2.,\n3.").encode())
    assert {name: matrix.tolist() for name, matrix in plain.items()} == {
        "K": [[1, 2], [2, 3]],
        "M": [[7, 0], [0, 8]],
    }
    whole = abaqus.substructure(SUBSTRUCTURE.format(unsym=", UNSYM", stiffness="1., 2., 3., 4.").encode())
    assert whole["K"].tolist() == [[1, 2], [3, 4]] and whole["M"].tolist() == [[7, 0], [0, 8]]
