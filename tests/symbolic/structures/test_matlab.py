"""Elements of MATLAB's files, by bytes written by hand."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest

from symbolic.guarded import DamagedError
from symbolic.structures import matlab

DOUBLE, INT32, INT8, UINT32 = 9, 5, 1, 6


def element(kind: int, data: bytes, order: str = "<") -> bytes:
    """An element with its count in a place of its own, filled up to eight bytes."""
    return struct.pack(f"{order}II", kind, len(data)) + data + bytes(-len(data) % 8)


def brief(kind: int, data: bytes, order: str = "<") -> bytes:
    """An element of up to four bytes beside its type."""
    return struct.pack(f"{order}I", len(data) << 16 | kind) + data + bytes(4 - len(data))


def variable(kind: int, *parts: bytes, flags: int = 0, order: str = "<") -> bytes:
    """A variable: its class, and what follows."""
    head = element(UINT32, struct.pack(f"{order}II", flags | kind, 0), order)
    return head + b"".join(parts)


@pytest.mark.parametrize("order", ["<", ">"])
def test_elements_one_after_another(order: str) -> None:
    """Assert numbers of both forms, in either order of bytes, whatever fills them up."""
    numbers = struct.pack(f"{order}3i", 1, -2, 3)
    held = element(INT32, numbers, order) + brief(INT8, b"ab", order) + element(DOUBLE, b"", order)
    found = [part.tolist() for part in matlab._elements(held, order)]
    assert found == [[1, -2, 3], [97, 98], []]


@pytest.mark.parametrize(
    "held",
    [
        bytes(7),
        element(8, bytes(8)),
        element(INT32, bytes(8))[:-1],
        struct.pack("<I", 5 << 16 | INT8) + bytes(4),
        struct.pack("<I", 4 << 16 | INT8) + bytes(3),
        element(INT32, bytes(8)) + bytes(4),
    ],
    ids=["cut", "no type", "short", "five bytes in four", "brief and cut", "begun"],
)
def test_elements_that_are_none(held: bytes) -> None:
    """Assert the sentence."""
    with pytest.raises(DamagedError, match=f"^{matlab.STRANGE}$"):
        list(matlab._elements(held, "<"))


@pytest.mark.parametrize("order", ["<", ">"])
def test_variables_of_numbers(order: str) -> None:
    """Assert name and numbers by columns, and an imaginary part where the flag says so."""
    size, name = element(INT32, struct.pack(f"{order}2i", 2, 2), order), brief(INT8, b"K", order)
    real = element(DOUBLE, struct.pack(f"{order}4d", 1, 2, 3, 4), order)
    other = element(DOUBLE, struct.pack(f"{order}4d", 5, 6, 7, 8), order)
    ((called, matrix),) = matlab._variable(variable(6, size, name, real, order=order), order)
    assert (called, matrix.tolist()) == ("K", [[1, 3], [2, 4]])
    both = variable(15, size, name, real, other, flags=matlab.COMPLEX, order=order)
    ((_, matrix),) = matlab._variable(both, order)
    assert matrix.tolist() == [[1 + 5j, 3 + 7j], [2 + 6j, 4 + 8j]]


@pytest.mark.parametrize(("kind", "known"), [(4, False), (5, False), (6, True), (15, True), (16, False)])
def test_classes_of_variables(kind: int, known: bool) -> None:
    """Assert that plain numbers are read and texts, cells and objects left out; sparse ones need more."""
    parts = element(INT32, struct.pack("<2i", 1, 1)), brief(INT8, b"a"), element(DOUBLE, struct.pack("<d", 2))
    if kind == matlab.SPARSE:
        with pytest.raises((DamagedError, ValueError)):
            list(matlab._variable(variable(kind, *parts), "<"))
        return
    assert [name for name, _ in matlab._variable(variable(kind, *parts), "<")] == ["a"] * known


@pytest.mark.parametrize(
    ("size", "fits"), [([2, 2], True), ([4, 1], True), ([5, 1], False), ([2, -1], False)]
)
def test_sizes_of_dense_variables(size: list[int], fits: bool) -> None:
    """Assert no more numbers than there are, and no fewer than none."""
    given: Any = [np.arange(4.0)]
    if fits:
        assert matlab._dense(size, given, False).shape == tuple(size)
        return
    with pytest.raises(DamagedError, match=f"^{matlab.LARGER}$"):
        matlab._dense(size, given, False)


def compressed(rows: list[int], columns: list[int], *values: list[float]) -> list[Any]:
    """The parts of a sparse variable."""
    return [np.array(rows, dtype="i4"), np.array(columns, dtype="i4"), *map(np.array, values)]


def test_sparse_variables() -> None:
    """Assert columns compressed, arrays longer than what is used, and an imaginary part."""
    found = matlab._sparse([2, 3], compressed([0, 1, 0, 9], [0, 2, 2, 3], [1.0, 2.0, 3.0, 7.0]))
    assert found.toarray().tolist() == [[1, 0, 3], [2, 0, 0]]
    found = matlab._sparse([1, 1], compressed([0], [0, 1], [1.0], [2.0]))
    assert found.toarray().tolist() == [[1 + 2j]]


@pytest.mark.parametrize(
    ("size", "rows", "columns"),
    [
        ([2, 3], [0, 1, 0], [0, 2, 3]),
        ([2, 3], [0, 1, 0], [0, 2, 3, 3, 3]),
        ([2, 2, 1], [0, 1], [0, 1, 2]),
        ([-1, 1], [0], [0, 1]),
        ([2, 1], [0], [0, 2]),
        ([2, 1], [0, 1, 1, 0], [0, 4]),
        ([2, 1], [0], [0, -1]),
    ],
)
def test_sparse_variables_that_are_none(size: list[int], rows: list[int], columns: list[int]) -> None:
    """Assert the sentence where counts do not fit: there are three numbers."""
    with pytest.raises(DamagedError, match=f"^{matlab.LARGER}$"):
        matlab._sparse(size, compressed(rows, columns, [1.0, 2.0, 3.0]))


def test_counts_of_elements() -> None:
    """Assert the bytes of one that ends with the file, and the sentence for one beyond it, or of none."""
    held = struct.pack("<II", 14, 8) + bytes(8)
    assert matlab._element(held, 0, "<") == (14, bytes(8))
    assert matlab._element(bytes(3) + held, 3, "<") == (14, bytes(8))
    for bad in (held[:-1], struct.pack("<II", 14, 0), held[:7]):
        with pytest.raises(DamagedError, match=f"^{matlab.SHORT}$"):
            matlab._element(bad, 0, "<")


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(("kind", "size"), [(0, 8), (10, 4), (20, 4), (30, 2), (40, 2), (50, 1)])
def test_version_4(kind: int, size: int, order: str) -> None:
    """Assert that as many bytes are needed as numbers of a kind take."""
    numbers = {8: "d", 4: "f" if kind == 10 else "i", 2: "h" if kind == 30 else "H", 1: "B"}[size]
    data = struct.pack(f"{order}2{numbers}", 3, 4)
    code = kind if order == "<" else 1000 + kind
    held = struct.pack(f"{order}5i", code, 2, 1, 0, 2) + b"A\0" + data
    ((name, matrix),) = matlab._of_version_4(held)
    assert (name, matrix.ravel().tolist()) == ("A", [3, 4])
    for bad in (held[:-1], held + b"\0", held[:19]):
        with pytest.raises(DamagedError, match=f"^{matlab.SHORT}$"):
            list(matlab._of_version_4(bad))
