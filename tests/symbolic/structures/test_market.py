"""Matrix Market files, by bytes written by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from symbolic.guarded import DamagedError
from symbolic.structures.market import LARGER, entries, matrix_market, whole_numbers

AS_MANY = "it has not as many entries as it declares"


def read(kind: str, body: str) -> Any:
    """The matrix of a file of some form, field and symmetry."""
    return matrix_market(f"%%MatrixMarket matrix {kind}\n{body}".encode())


@pytest.mark.parametrize(
    ("kind", "body", "matrix"),
    [
        ("array real general", "2 3\n1\n2\n3\n4\n5\n6\n", [[1, 3, 5], [2, 4, 6]]),
        ("array integer symmetric", "2 2\n1\n2\n3\n", [[1, 2], [2, 3]]),
        ("array real skew-symmetric", "3 3\n1\n2\n3\n", [[0, -1, -2], [1, 0, -3], [2, 3, 0]]),
        ("Array Double General", "% a remark\n\n%another\n1 1\n\n4\n", [[4]]),
    ],
)
def test_dense(kind: str, body: str, matrix: list[list[float]]) -> None:
    """Assert entries by columns, and those below the diagonal mirrored."""
    assert read(kind, body).tolist() == matrix


@pytest.mark.parametrize(
    ("kind", "body", "matrix"),
    [
        ("coordinate real general", "2 3 2\n1 3 4.5\n2 1 -1\n", [[0, 0, 4.5], [-1, 0, 0]]),
        ("coordinate pattern general", "2 2 2\n1 1\n2 1\n", [[1, 0], [1, 0]]),
        ("coordinate real symmetric", "2 2 2\n1 1 4\n2 1 7\n", [[4, 7], [7, 0]]),
        ("coordinate real skew-symmetric", "2 2 1\n2 1 7\n", [[0, -7], [7, 0]]),
        ("coordinate real general", "1 1 2\n1 1 4\n1 1 5\n", [[9]]),
    ],
)
def test_sparse(kind: str, body: str, matrix: list[list[float]]) -> None:
    """Assert rows and columns from 1 on, ones where there are no values, and mirrored entries."""
    assert read(kind, body).toarray().tolist() == matrix


@pytest.mark.parametrize(
    ("kind", "body", "said"),
    [
        ("array real general", "2 2\n1\n2\n3\n", AS_MANY),
        ("array real general", "2 2\n1\n2\n3\n4\n5\n", AS_MANY),
        ("array real symmetric", "2 3\n1\n2\n3\n4\n5\n6\n", AS_MANY),
        ("array real symmetric", "2 2\n1\n2\n3\n4\n", AS_MANY),
        ("array real skew-symmetric", "2 2\n1\n2\n", AS_MANY),
        ("array real general", "0 2\n1\n", LARGER),
        ("array real general", "4\n1\n", LARGER),
        ("array real general", "2 2 2\n1\n2\n3\n4\n", LARGER),
        ("array real general", "90 90\n1\n2\n3\n", LARGER),
        ("array real general", f"{10**30} 1\n1\n", LARGER),
        ("coordinate real general", "2 2\n1 1 4\n", LARGER),
        ("coordinate real general", "2 0 1\n1 1 4\n", LARGER),
        ("coordinate real general", "7 2 1\n1 1 4\n", LARGER),
        ("coordinate real general", "2 2 2\n1 1 4\n", AS_MANY),
        ("coordinate real general", "2 2 1\n1 1 4 5\n", AS_MANY),
        ("coordinate real general", "2 2 1\n1\n1\n1\n", AS_MANY),
        ("coordinate real general", "2 2 1\n0 1 4.0\n", "it has entries outside its matrix"),
        ("coordinate real general", "2 2 1\n1 0 4.0\n", "it has entries outside its matrix"),
        ("coordinate real general", "1 2 1\n2 1 4.0\n", "it has entries outside its matrix"),
        ("coordinate real general", "2 1 1\n1 2 4.0\n", "it has entries outside its matrix"),
        ("coordinate real symmetric", "1 2 1\n1 2 4.0\n", "it is symmetric and not square"),
        ("coordinate real general", "2 2 1\n1.5 1 4.0\n", "it has indices that are not whole numbers"),
        (
            "coordinate real general",
            "2 2 1\n3 1 4.0\n",
            "it has indices that are not whole numbers, or larger",
        ),
        ("array complex general", "1 1\n1 0\n", "it is not of real numbers"),
        ("array real hermitian", "1 1\n1\n", "it is not of real numbers"),
        ("list real general", "1 1\n1\n", "its first line does not say what it is"),
        ("array real", "1 1\n1\n", "its first line does not say what it is"),
        ("array real general more", "1 1\n1\n", "its first line does not say what it is"),
    ],
)
def test_what_is_refused(kind: str, body: str, said: str) -> None:
    """Assert the sentence."""
    with pytest.raises(DamagedError, match=f"^{said}"):
        read(kind, body)


def test_vectors_are_no_matrices() -> None:
    """Assert that the first line says of what it is."""
    with pytest.raises(DamagedError, match="^its first line does not say what it is$"):
        matrix_market(b"%%MatrixMarket vector array real general\n1 1\n1\n")


def test_lines_of_numbers() -> None:
    """Assert that remarks of three kinds are left out, that one line is a matrix, and what parts numbers."""
    assert entries(b"1 2 % rest\n# a\n* b\n3 4\n").tolist() == [[1, 2], [3, 4]]
    assert entries(b"5, 6", ",").tolist() == [[5, 6]]
    with pytest.raises(ValueError, match="could not convert"):
        entries(b"1 x\n")


def test_indices() -> None:
    """Assert whole numbers up to the largest one, either sign."""
    assert whole_numbers(np.array([3.0, -3.0]), 3).tolist() == [3, -3]
    for bad in (3.5, 4.0, -4.0, np.nan, np.inf):
        with pytest.raises(DamagedError, match="^it has indices that are not whole numbers, or larger than"):
            whole_numbers(np.array([1.0, bad]), 3)
