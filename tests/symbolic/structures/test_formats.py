"""Files of matrices as SciPy and NumPy write them, and such as are damaged."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy
from scipy import sparse

from symbolic.guarded import DamagedError
from symbolic.structures import formats, matlab
from symbolic.structures.formats import contents

DENSE = np.array([[1.5, 2.0, 3.0], [4.0, 5.0, -6.0]])
THIN = np.array([[0.0, 2.0, 0.0], [0.0, 0.0, -3.0], [4.0, 0.0, 0.0], [0.0, 0.5, 0.0]])
KINDS = {
    "M": DENSE,
    "cube": np.arange(24.0).reshape(2, 3, 4),
    "complex": DENSE * (1 + 2j),
    "small": np.array([[7]], dtype=np.int8),
    "bytes": np.arange(5, dtype=np.uint8)[None],
    "long": np.array([[2**40, -1]]),
    "single": np.array([[0.5, 2.5, 4.0]], dtype=np.float32),
}


def written(path: Path, given: dict[str, Any], **options: Any) -> Path:
    """A MATLAB file."""
    scipy.io.savemat(path, given, **options)
    return path


@pytest.mark.parametrize("compressed", [False, True])
def test_matlab_files_of_version_5(compressed: bool, tmp_path: Path) -> None:
    """Assert values, shapes and kinds of numbers, dense and sparse; no texts."""
    sparse_ones = {"K": sparse.csc_matrix(THIN), "Z": sparse.csc_matrix(THIN * 1j)}
    given = {**KINDS, **sparse_ones, "text": "abc", "cell": np.array([1, "b"], dtype=object)}
    found = contents(written(tmp_path / "a.mat", given, do_compression=compressed))
    assert list(found) == [*KINDS, "K", "Z"]
    for name, value in KINDS.items():
        assert found[name].tolist() == value.tolist() and found[name].dtype == value.dtype
    assert found["K"].toarray().tolist() == THIN.tolist()
    assert found["Z"].toarray().tolist() == (THIN * 1j).tolist()


def test_matlab_files_of_version_4(tmp_path: Path) -> None:
    """Assert values, and no texts."""
    found = contents(written(tmp_path / "a.mat", {"M": DENSE, "text": "abc"}, format="4"))
    assert {name: value.tolist() for name, value in found.items()} == {"M": DENSE.tolist()}


@pytest.mark.parametrize("cut", [1, 8, 50, 100])
def test_matlab_files_that_end_early(cut: int, tmp_path: Path) -> None:
    """Assert the sentence for a file whose last variable lacks bytes."""
    path = written(tmp_path / "a.mat", {"M": DENSE})
    path.write_bytes(path.read_bytes()[:-cut])
    with pytest.raises(ValueError, match="cannot be read as a .mat file: it ends before what it declares$"):
        contents(path)


def element(kind: int, held: bytes, count: int | None = None) -> bytes:
    """An element with its type and its count of bytes before it."""
    return struct.pack("<II", kind, len(held) if count is None else count) + held


@pytest.mark.parametrize(
    ("held", "place", "expected"),
    [
        (element(14, b"abc"), 0, (14, b"abc")),
        (b"12345" + element(9, b"x"), 5, (9, b"x")),
        (element(3, b"ab") + b"rest", 0, (3, b"ab")),
        (element(14, b""), 0, None),
        (element(14, b"abc", 4), 0, None),
        (b"12345" + element(9, b"x", 2), 5, None),
        (element(14, b"abc")[:7], 0, None),
        (b"123" + element(14, b"a"), 5, None),
    ],
)
def test_elements_of_a_file(held: bytes, place: int, expected: tuple[int, bytes] | None) -> None:
    """Assert type and bytes from a place on; an error where they are none or go beyond the end."""
    if expected:
        assert matlab._element(held, place, "<") == expected
        return
    with pytest.raises(DamagedError, match="^it ends before what it declares$"):
        matlab._element(held, place, "<")


def test_elements_of_a_variable() -> None:
    """Assert numbers of long elements, filled to 8 bytes, and of short ones beside their type."""
    short = struct.pack("<HHi", 5, 4, -7)
    held = (
        element(9, struct.pack("<d", 2.5)) + short + element(3, struct.pack("<5h", 1, 2, 3, 4, 5)) + b"\0" * 6
    )
    found = [part.tolist() for part in matlab._elements(held + short, "<")]
    assert found == [[2.5], [-7], [1, 2, 3, 4, 5], [-7]]
    for wrong in (
        struct.pack("<HHi", 5, 5, 0) + b"\0" * 8,
        struct.pack("<HHi", 8, 4, 0),
        element(9, b"\0" * 8, 16),
        element(8, b"\0" * 8),
        short + b"\0" * 7,
    ):
        with pytest.raises(DamagedError, match="^it has an element of no known type, or one that ends"):
            list(matlab._elements(wrong, "<"))


def parts(rows: list[int], columns: list[int], values: list[float]) -> list[Any]:
    """The arrays of a sparse matrix."""
    return [np.array(rows), np.array(columns), np.array(values)]


@pytest.mark.parametrize(
    ("size", "given", "said"),
    [
        ([2, 2], parts([0, 1, 9], [0, 1, 2], [1.5, 2.5, 9.0]), ""),
        ([2, 2], parts([0, 1], [0, 1, 3], [1.5, 2.5]), "it declares a matrix that is larger"),
        ([2, 2], parts([0, 1], [0, 1, 2], [1.5]), "it declares a matrix that is larger"),
        ([2, 2], parts([0], [0, 1, 2], [1.5, 2.5]), "it declares a matrix that is larger"),
        ([2, 3], parts([0, 1], [0, 1, 2], [1.5, 2.5]), "it declares a matrix that is larger"),
        ([2, 2, 1], parts([0, 1], [0, 1, 2], [1.5, 2.5]), "it declares a matrix that is larger"),
        ([-1, 2], parts([0, 1], [0, 1, 2], [1.5, 2.5]), "it declares a matrix that is larger"),
        ([2, 2], parts([0, 1], [0, 1, -1], [1.5, 2.5]), "it declares a matrix that is larger"),
        ([2, 2], parts([0, 5], [0, 1, 2], [1.5, 2.5]), ".*ind"),
    ],
)
def test_sparse_variables(size: list[int], given: list[Any], said: str) -> None:
    """Assert a matrix of the entries that are used, and errors for arrays that do not fit its size."""
    if not said:
        assert matlab._sparse(size, given).toarray().tolist() == [[1.5, 0], [0, 2.5]]
        return
    with pytest.raises((DamagedError, ValueError), match=f"^{said}"):
        matlab._sparse(size, given)


def test_dense_variables() -> None:
    """Assert an order by columns, complex ones, and errors where there are fewer numbers than entries."""
    numbers = [np.arange(6.0), -np.arange(6.0)]
    assert matlab._dense([2, 3], numbers, False).tolist() == [[0, 2, 4], [1, 3, 5]]
    assert matlab._dense([3, 2], numbers, True)[1, 1] == 4 - 4j
    for size in ([2, 4], [-1, -6], [7, 1]):
        with pytest.raises(DamagedError, match="^it declares a matrix that is larger than what it holds$"):
            matlab._dense(size, numbers, False)


def test_variables_twice_and_newer_files(tmp_path: Path) -> None:
    """Assert the sentences."""
    path = written(tmp_path / "a.mat", {"M": DENSE}, do_compression=False)
    held = path.read_bytes()
    path.write_bytes(held + held[128:])
    with pytest.raises(ValueError, match="it has two variables of one name$"):
        contents(path)
    path.write_bytes(held[:124] + b"\x00\x02IM" + held[128:])
    with pytest.raises(ValueError, match="it is of MATLAB's version 7.3; save it there with -v7$"):
        contents(path)


def test_archives_of_numpy(tmp_path: Path) -> None:
    """Assert arrays by name, a sparse matrix without one, and an error for a size that lies."""
    np.savez(tmp_path / "a.npz", M=DENSE, K=np.eye(2))
    found = contents(tmp_path / "a.npz")
    assert {k: v.tolist() for k, v in found.items()} == {"M": DENSE.tolist(), "K": np.eye(2).tolist()}
    sparse.save_npz(tmp_path / "b.npz", sparse.csr_array(THIN))
    assert contents(tmp_path / "b.npz")[""].toarray().tolist() == THIN.tolist()
    with np.load(tmp_path / "b.npz") as held:
        arrays = dict(held)
    np.savez(tmp_path / "c.npz", **arrays | {"shape": np.array([10**6, 3])})
    with pytest.raises(ValueError, match=r"'.*c.npz' cannot be read as a .npz file: it declares a matrix"):
        contents(tmp_path / "c.npz")


@pytest.mark.parametrize(
    ("name", "held", "said"),
    [
        ("a.txt", b"", "'.*a.txt' is no file of matrices; its name must end in .npz, .mat, .mtx, .op4$"),
        ("a.mtx", None, "file of matrices '.*a.mtx' does not exist$"),
        ("a.MTX", b"x", "'.*a.MTX' cannot be read as a .MTX file: "),
        ("a.npz", b"x", "'.*a.npz' cannot be read as a .npz file: "),
    ],
)
def test_files_that_are_none(name: str, held: bytes | None, said: str, tmp_path: Path) -> None:
    """Assert the sentence."""
    if held is not None:
        (tmp_path / name).write_bytes(held)
    with pytest.raises(ValueError, match=f"^{said}"):
        contents(tmp_path / name)


def test_package_of_a_format_that_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert which package it is."""

    def reader(*_: object) -> dict[str, Any]:
        raise ModuleNotFoundError("No module named 'pyyeti'", name="pyyeti")

    monkeypatch.setitem(formats.READERS, ".op4", reader)
    (tmp_path / "a.op4").write_bytes(b"x")
    with pytest.raises(ValueError, match="^a.op4 needs the package pyyeti: "):
        contents(tmp_path / "a.op4")


def test_why_a_file_cannot_be_read() -> None:
    """Assert the row that a library names, and nothing of what it quotes."""
    assert formats._why(DamagedError("it is odd")) == "it is odd"
    assert formats._why(ValueError("could not convert 'x'")) == "it is damaged or of another kind"
    assert formats._why(ValueError("'x' at row 7, column 1")) == "it is damaged or of another kind (row 7)"
