"""Matrices of elements by quadrature, what is sound in files, and what is definite."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest
from scipy import sparse

from symbolic.arrays import Array
from symbolic.guarded import DamagedError
from symbolic.structures.beam import bending_element
from symbolic.structures.formats import _sound
from symbolic.structures.market import _sparse, matrix_market, whole_numbers
from symbolic.structures.matlab import _of_version_4
from symbolic.structures.matrices import _is_definite
from symbolic.structures.shaft import slope_element


def shapes(length: float) -> list[np.poly1d]:
    """Cubics with one unit deflection or slope at one of both ends."""
    h = length
    ends = np.array([[0, 0, 0, 1], [0, 0, 1, 0], [h**3, h**2, h, 1], [3 * h**2, 2 * h, 1, 0]])
    return [np.poly1d(row) for row in np.linalg.inv(ends).T]


def product(one: np.poly1d, other: np.poly1d, length: float) -> float:
    """The integral of a product over the element."""
    return float((one * other).integ()(length))


@pytest.mark.parametrize("length", [1.0, 0.4, 3.0])
def test_element_of_a_beam(length: float) -> None:
    """Assert stiffness E I int N'' N'', mass int N N and int N' N' of cubic shape functions."""
    cubics = shapes(length)
    stiffness, mass = bending_element(length, 2.5)
    exact = [[[product(a.deriv(k), b.deriv(k), length) for b in cubics] for a in cubics] for k in (0, 1, 2)]
    assert mass == pytest.approx(np.array(exact[0]), rel=1e-9)
    assert slope_element(length) == pytest.approx(np.array(exact[1]), rel=1e-9, abs=1e-12)
    assert stiffness == pytest.approx(2.5 * np.array(exact[2]), rel=1e-9)


def test_matrices_that_are_sound() -> None:
    """Assert the matrix itself, dense and sparse, and a refusal of what is none."""
    for matrix in (np.eye(2), np.eye(2, dtype=int), sparse.csr_array(np.eye(3)), sparse.coo_array(np.eye(2))):
        assert _sound(matrix) is matrix
    for wrong in ("x", np.array(["a"]), np.array([object()])):
        with pytest.raises(DamagedError, match="^it has an array that is not of numbers$"):
            _sound(wrong)


@pytest.mark.parametrize(
    ("pointers", "error"),
    [([1, 1, 2], DamagedError), ([0, 3, 2], DamagedError), ([0, 2, 1], DamagedError)],
)
def test_sparse_matrices_out_of_order(pointers: list[int], error: type[Exception]) -> None:
    """Assert that rows whose begins do not rise from 0 are refused."""
    matrix = sparse.csr_array(np.eye(2))
    matrix.indptr = np.array(pointers, dtype=np.int32)
    with pytest.raises(error, match="^it has a sparse matrix whose rows or columns are out of order$"):
        _sound(matrix)


def test_sparse_matrices_with_indices_outside() -> None:
    """Assert that SciPy's own check is asked."""
    matrix = sparse.csr_array(np.eye(2))
    matrix.indices = np.array([0, 5], dtype=np.int32)
    with pytest.raises(ValueError, match="ind"):
        _sound(matrix)


def listed(text: str, sizes: list[int], mirrored: int = 0) -> Array:
    """The matrix of entries of a file."""
    found: Array = _sparse(sizes, text.encode(), mirrored).toarray()
    return found


def test_entries_of_a_matrix() -> None:
    """Assert values and places, ones where there are no values, and the mirror images of what is below."""
    both = "1 1 2.5\n3 2 -1.5\n"
    assert listed(both, [3, 2, 2]).tolist() == [[2.5, 0], [0, 0], [0, -1.5]]
    assert listed("1 1\n3 2 \n 2 2\n", [3, 2, 3]).tolist() == [[1, 0], [0, 1], [0, 1]]
    assert listed(both, [3, 3, 2], 1).tolist() == [[2.5, 0, 0], [0, 0, -1.5], [0, -1.5, 0]]
    assert listed("3 2 -1.5\n2 1 4\n", [3, 3, 2], -1).tolist() == [[0, -4, 0], [4, 0, 1.5], [0, -1.5, 0]]


@pytest.mark.parametrize(
    ("kind", "beside"),
    [("general", [0.0, -1.5]), ("symmetric", [-1.5, -1.5]), ("skew-symmetric", [1.5, -1.5])],
)
def test_kinds_of_matrices(kind: str, beside: list[float]) -> None:
    """Assert what a Matrix Market file says of the entries above the diagonal."""
    diagonal = "" if kind == "skew-symmetric" else "1 1 2.5\n"
    head = f"%%MatrixMarket matrix coordinate real {kind}\n% a comment\n2 2 {1 + bool(diagonal)}\n"
    found = matrix_market(f"{head}{diagonal}2 1 -1.5\n".encode()).toarray()
    assert [found[0, 1], found[1, 0]] == beside


@pytest.mark.parametrize(
    ("kind", "numbers", "expected"),
    [
        ("general", "1 2 3 4", [[1, 3], [2, 4]]),
        ("symmetric", "1 2 4", [[1, 2], [2, 4]]),
        ("skew-symmetric", "3.25", [[0, -3.25], [3.25, 0]]),
        ("skew-symmetric", "3", [[0, -3], [3, 0]]),
    ],
)
def test_dense_matrices_by_columns(kind: str, numbers: str, expected: list[list[float]]) -> None:
    """Assert the entries of an array of each kind, and a refusal of one entry more or less."""
    head = f"%%MatrixMarket matrix array real {kind}\n% a comment\n%another\n\n 2 2\n"

    def of(given: list[str]) -> Any:
        return matrix_market((head + "\n".join(given) + "\n").encode())

    each = numbers.split()
    assert of(each).tolist() == expected
    for wrong in (["5", "5", *each], [*each, "5"], [*each[:-1], ""]):
        with pytest.raises((DamagedError, ValueError)):
            of(wrong)


def test_dense_matrices_that_are_not_square() -> None:
    """Assert entries by columns of a general one, and a refusal of one that is to be symmetric."""
    head = "%%MatrixMarket matrix array {}\n3 2\n"
    found = matrix_market((head.format("integer general") + "1\n2\n3\n4\n5\n6\n").encode())
    assert found.tolist() == [[1, 4], [2, 5], [3, 6]]
    with pytest.raises(DamagedError, match="^it has not as many entries as it declares$"):
        matrix_market((head.format("real symmetric") + "1\n2\n3\n4\n5\n").encode())


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ("%%MatrixMarket matrix array real\n1 1\n5\n", "its first line does not say what it is"),
        ("%%MatrixMarket vector array real general\n1 1\n5\n", "its first line does not say what it is"),
        ("%%MatrixMarket matrix dense real general\n1 1\n5\n", "its first line does not say what it is"),
        ("%%MatrixMarket matrix array complex general\n1 1\n5\n", "it is not of real numbers"),
        ("%%MatrixMarket matrix array real hermitian\n1 1\n5\n", "it is not of real numbers"),
        ("%%MatrixMarket matrix array real general\n1\n5\n", "it declares a matrix that is larger"),
        ("%%MatrixMarket matrix array real general\n0 1\n5\n", "it declares a matrix that is larger"),
        ("%%MatrixMarket matrix array real general\n2 2\n5\n", "it declares a matrix that is larger"),
        (f"%%MatrixMarket matrix array real general\n1 {'0' * 19}1\n5\n", "it declares a matrix that is"),
    ],
)
def test_heads_that_are_refused(head: str, said: str) -> None:
    """Assert the sentence for words, kinds and sizes that are none."""
    with pytest.raises(DamagedError, match=f"^{said}"):
        matrix_market(head.encode())


@pytest.mark.parametrize("value", [0.5, 4.0, -4.0, np.inf, np.nan])
def test_indices_that_are_none(value: float) -> None:
    """Assert a refusal of what is no whole number, or larger than 3."""
    assert whole_numbers(np.array([3.0, -3.0, 0.0]), 3).tolist() == [3, -3, 0]
    with pytest.raises(DamagedError, match="^it has indices that are not whole numbers, or larger"):
        whole_numbers(np.array([1.0, value]), 3)


@pytest.mark.parametrize(
    ("text", "sizes", "mirrored", "said"),
    [
        ("1 1 2.5\n3 2 -1.5\n", [3, 2, 3], 0, "it has not as many entries as it declares"),
        ("1 1 2.5 7\n3 2 -1.5 7\n", [3, 2, 2], 0, "it has not as many entries as it declares"),
        ("1 1 2.5\n4 2 -1.5\n", [4, 2, 2], 1, "it is symmetric and not square"),
        ("0 1 2.5\n3 2 -1.5\n", [3, 2, 2], 0, ""),
        ("1 1 2.5\n3 3 -1.5\n", [3, 2, 2], 0, "it has entries outside its matrix"),
        ("1 1 2.5\n3 2 -1.5\n", [2, 3, 2], 0, "it has entries outside its matrix"),
        ("1 1 2.5\n3 2 -1.5\n", [3, 99, 2], 0, ""),
        ("1 1 2.5\n3 2 -1.5\n", [0, 2, 2], 0, ""),
        ("1 1 2.5\n3 2 -1.5\n", [3, 2], 0, ""),
    ],
)
def test_entries_that_are_refused(text: str, sizes: list[int], mirrored: int, said: str) -> None:
    """Assert what does not fit sizes, numbers of entries and places."""
    with pytest.raises(DamagedError, match=f"^{said}"):
        listed(text, sizes, mirrored)


def variable(name: str, values: Array, imaginary: bool = False, order: str = "<", kind: int = 0) -> bytes:
    """A variable of a file of version 4."""
    numbers = np.asarray(values, dtype=float)
    rows, columns = numbers.shape
    head = struct.pack(
        f"{order}5i", kind + (1000 if order == ">" else 0), rows, columns, int(imaginary), len(name) + 1
    )
    body = numbers.T.astype(f"{order}f8").tobytes()
    return head + name.encode() + b"\0" + body * (2 if imaginary else 1)


@pytest.mark.parametrize("order", ["<", ">"])
def test_variables_of_version_4(order: str) -> None:
    """Assert names and values of two, one of them complex, in either order of bytes."""
    one, other = np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([[5.0, 6.0, 7.0]])
    held = variable("M", one, order=order) + variable("Z", other, True, order=order)
    found = dict(_of_version_4(held))
    assert found["M"].tolist() == one.tolist() and found["Z"].tolist() == (other * (1 + 1j)).tolist()


@pytest.mark.parametrize(
    "spoil",
    [
        lambda held: held[:-1],
        lambda held: held + b"\0",
        lambda held: held[:10],
        lambda held: held + held[:19],
        lambda held: held[:4] + struct.pack("<i", -1) + held[8:],
        lambda held: struct.pack("<i", 60) + held[4:],
    ],
)
def test_damage_of_version_4(spoil: Any) -> None:
    """Assert that a file is refused that has not the bytes which its headers declare."""
    held = variable("M", np.eye(2))
    assert len(dict(_of_version_4(held))) == 1
    with pytest.raises(DamagedError):
        dict(_of_version_4(spoil(held)))


@pytest.mark.parametrize("size", [3, 600])
@pytest.mark.parametrize(("coupling", "definite"), [(0.4, True), (0.6, False), (-0.4, True)])
def test_definite_matrices(size: int, coupling: float, definite: bool) -> None:
    """Assert it of 1 on the diagonal and a number beside it, in any unit, of small and large ones."""
    beside = np.full(size - 1, coupling if size > 3 else coupling * np.sqrt(2))
    unit = np.logspace(-3, 3, size)
    matrix = sparse.diags_array([beside, np.ones(size), beside], offsets=[-1, 0, 1])
    scaled = sparse.csc_array(sparse.diags_array(unit) @ matrix @ sparse.diags_array(unit))
    assert _is_definite(scaled if size > 3 else scaled.toarray()) is definite
