"""Readers of matrices, one for each kind of file: name of a matrix to the matrix."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import scipy

from symbolic.structures.matrices import sparse

EXTRA = "pip install 'orbitrace[files]'"
"""What installs the readers of other programs' formats."""


def contents(path: Path) -> dict[str, Any]:
    """Return the matrices of a file by their names; "" names the one of a file that holds just one.

    Raises
    ------
    ValueError
        For a file that is missing, of a kind not known here, or not what its ending says.
    """
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ValueError(f"{str(path)!r} is no file of matrices; its name must end in {', '.join(READERS)}")
    try:
        return dict(reader(path))
    except FileNotFoundError:
        raise ValueError(f"file of matrices {str(path)!r} does not exist") from None
    except ModuleNotFoundError as error:
        raise ValueError(f"{path.name} needs the package {error.name}: {EXTRA}") from None
    except (OSError, EOFError, ValueError, TypeError, KeyError, AssertionError, zipfile.BadZipFile) as error:
        said = " ".join(str(error).split())[:120] or type(error).__name__
        raise ValueError(f"{str(path)!r} cannot be read as a {path.suffix} file: {said}") from None


def numpy_archive(path: Path) -> Mapping[str, Any]:
    """Return what numpy.savez or scipy.sparse.save_npz has written."""
    with np.load(path, allow_pickle=False) as archive:
        if "format" not in archive:
            return {name: archive[name] for name in archive}
    return {"": sparse.load_npz(path)}


def matlab(path: Path) -> Mapping[str, Any]:
    """Return the variables of a MATLAB file up to version 7."""
    return {k: v for k, v in scipy.io.loadmat(path).items() if not k.startswith("__")}


def mtx(path: Path) -> Mapping[str, Any]:
    """Return what a .mtx file holds: Matrix Market, or Abaqus in any of its three forms.

    The forms of Abaqus are `*SUBSTRUCTURE MATRIX OUTPUT`, and of `*MATRIX OUTPUT` the formats COORDINATE
    (row, column, value) and MATRIX INPUT (node, dof, node, dof, value; one triangle where it is symmetric).
    """
    with path.open(errors="replace") as lines:
        head = lines.readline()
    if head.startswith("%%MatrixMarket"):
        return {"": scipy.io.mmread(path, spmatrix=False)}
    if head.startswith("*"):
        return _substructure(path)
    rows = np.loadtxt(path, delimiter="," if "," in head else None, comments=("*", "%", "#"), ndmin=2)
    if rows.shape[1] == 3:
        return {"": _filled(rows[:, 0].astype(int) - 1, rows[:, 1].astype(int) - 1, rows[:, 2])}
    if rows.shape[1] == 5:
        pairs = np.concatenate([rows[:, :2], rows[:, 2:4]]).astype(int)
        numbered = np.unique(pairs, axis=0, return_inverse=True)[1].ravel()
        return {"": _filled(numbered[: len(rows)], numbered[len(rows) :], rows[:, 4])}
    raise ValueError(f"its lines have {rows.shape[1]} numbers; 3 or 5 are known")


def op4(path: Path) -> Mapping[str, Any]:
    """Return the matrices of a Nastran OUTPUT4 file, names in capitals, by pyyeti."""
    read: Mapping[str, Any] = _module("pyyeti.nastran.op4").read(str(path), into="dct", justmatrix=True)
    return {name.upper(): matrix for name, matrix in read.items()}


READERS: dict[str, Callable[[Path], Mapping[str, Any]]] = {
    ".npz": numpy_archive,
    ".mat": matlab,
    ".mtx": mtx,
    ".op4": op4,
}
"""The reader of each ending."""


def _substructure(path: Path) -> Mapping[str, Any]:
    found = _module("abaqus_mtx_parser").parse_mtx(str(path))
    matrices = {"M": found.mass, "K": found.stiffness}
    return {name: matrix for name, matrix in matrices.items() if matrix is not None}


def _filled(row: Any, column: Any, value: Any) -> Any:
    """A sparse matrix of entries; where only one triangle is there, the other is its mirror image."""
    size = int(max(row.max(), column.max())) + 1
    if row.min() < 0 or column.min() < 0:
        raise ValueError("its indices begin below 1")
    if (row >= column).all() or (row <= column).all():
        below = row != column
        row, column = np.r_[row, column[below]], np.r_[column, row[below]]
        value = np.r_[value, value[below]]
    return sparse.coo_array((value, (row, column)), shape=(size, size)).tocsr()


def _module(name: str) -> ModuleType:
    """A package that is installed only for its format; how it sets NumPy's printing is undone."""
    with np.printoptions():
        return import_module(name)
