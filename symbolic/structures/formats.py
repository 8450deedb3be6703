"""Readers of matrices, one for each kind of file: name of a matrix to the matrix.

Each is given the bytes of a file, and holds what its header declares against them before it makes anything.
"""

from __future__ import annotations

import io
import logging
import re
import struct
import warnings
import zipfile
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from symbolic.guarded import LARGEST, DamagedError, archive, content
from symbolic.structures.abaqus import mtx
from symbolic.structures.matlab import files, matlab
from symbolic.structures.matrices import sparse
from symbolic.structures.nastran import op4

EXTRA = "pip install 'orbitrace[files]'"
"""What installs the readers of other programs' formats."""

FAILURES = (
    *(OSError, EOFError, ValueError, TypeError, LookupError, ArithmeticError, RuntimeError, MemoryError),
    *(
        AssertionError,
        UnboundLocalError,
        Warning,
        files.MatReadError,
        struct.error,
        zipfile.BadZipFile,
        zlib.error,
    ),
)
"""What readers raise on what is no file of theirs."""

PLACE = re.compile(r"\b(row|line) \d+")
"""Where a library says that a file is wrong; what else it says may quote the file."""

_log = logging.getLogger(__name__)


def contents(path: Path) -> dict[str, Any]:
    """Return the matrices of a file by their names; "" names the one of a file that holds just one.

    Raises
    ------
    ValueError
        For a file that is missing, of a kind not known here, too large, or not what its ending says.
    """
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ValueError(f"{str(path)!r} is no file of matrices; its name must end in {', '.join(READERS)}")
    try:
        held = content(path)
    except FileNotFoundError:
        raise ValueError(f"file of matrices {str(path)!r} does not exist") from None
    except OSError as error:
        why = error.strerror or type(error).__name__
        raise ValueError(f"{str(path)!r} cannot be read as a {path.suffix} file: {why}") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # a reader that has doubts goes on with what it has
            return {name: _sound(matrix) for name, matrix in reader(path, held).items()}
    except ModuleNotFoundError as error:
        raise ValueError(f"{path.name} needs the package {error.name}: {EXTRA}") from None
    except FAILURES as error:
        said = f"{str(path)!r} cannot be read as a {path.suffix} file: {_why(error)}"
    raise ValueError(said)


def _why(error: Exception) -> str:
    """Why a file cannot be read, without any of what it holds."""
    if isinstance(error, DamagedError):
        return str(error)
    _log.debug("what the reader of a file of matrices says", exc_info=error)
    where = PLACE.search(str(error))
    return "it is damaged or of another kind" + (f" ({where[0]})" if where else "")


def _sound(matrix: Any) -> Any:
    """A matrix, if it is one of numbers whose indices are within it, and of a size to be handled."""
    if not hasattr(matrix, "dtype") or matrix.dtype.kind not in "biufc":
        raise DamagedError("it has an array that is not of numbers")
    if max(matrix.shape, default=0) > LARGEST // 8:
        raise DamagedError("it has a matrix of more rows or columns than are read")
    if hasattr(matrix, "indptr"):  # compiled code trusts these; SciPy's check leaves out what seems empty
        if matrix.indptr[0] != 0 or (np.diff(matrix.indptr) < 0).any():
            raise DamagedError("it has a sparse matrix whose rows or columns are out of order")
        matrix.check_format(full_check=True)
    return matrix


def numpy_archive(path: Path, held: bytes) -> Mapping[str, Any]:
    """Return what numpy.savez or scipy.sparse.save_npz has written."""
    found = archive(held)
    if "format" not in found:
        return found
    sizes = [int(size) for size in found["shape"].ravel()]
    if max(sizes) > sum(array.nbytes for array in found.values()):
        raise DamagedError("it declares a matrix that is larger than what it holds")
    return {"": sparse.load_npz(io.BytesIO(held))}


READERS: dict[str, Callable[[Path, bytes], Mapping[str, Any]]] = {
    ".npz": numpy_archive,
    ".mat": matlab,
    ".mtx": mtx,
    ".op4": op4,
}
"""The reader of each ending."""
