"""Matrices from files of other programs."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from symbolic.checks import mapping, refusal
from symbolic.structures.formats import contents
from symbolic.structures.matrices import Matrices

File = str | PathLike[str]

NAMES = ("M", "C", "K", "G")


def read_matrices(
    file: File | None = None,
    *,
    M: File | None = None,
    C: File | None = None,
    K: File | None = None,
    G: File | None = None,
    names: Mapping[str, str] | None = None,
    at: Mapping[str, int] | None = None,
) -> Matrices:
    """Return the matrices of a linear structure from one file, or from one file for each matrix.

    Parameters
    ----------
    file : path, optional
        A file that holds several: .npz (numpy.savez), .mat (MATLAB up to version 7), .op4 (Nastran OUTPUT4),
        .mtx of Abaqus' substructures.
    M, C, K, G : path, optional
        Files of single matrices, also beside `file`: all of those, scipy.sparse.save_npz, Matrix Market .mtx
        and Abaqus' .mtx (COORDINATE and MATRIX INPUT).
    names : mapping of str to str, optional
        Names that the file has for M, C, K and G, where they differ: ``{"M": "MAA", "K": "KAA"}``.
    at : mapping of str to int, optional
        Places: names of degrees of freedom by their index, counted from 0.

    Returns
    -------
    Matrices
        M and K, and C and G where there are any.

    Raises
    ------
    ValueError
        For a file that is missing or of another kind, for a matrix it does not have, and as `Matrices` does.

    Notes
    -----
    .op4 needs ``pip install 'orbitrace[files]'``. Units are those of the file: see
    `Matrices.first_frequency`.
    """
    called = {name: name for name in NAMES} | _names(names)
    found = {} if file is None else _found(Path(file), called)
    for name, path in zip(NAMES, (M, C, K, G), strict=True):
        if path is not None:
            found[name] = _single(Path(path), called[name])
    for name in ("M", "K"):
        if name not in found:
            where = (
                f"file {str(file)!r} has no matrix {called[name]!r}"
                if file is not None
                else f"{name} is missing"
            )
            raise ValueError(f"{where}; mass M and stiffness K are needed, see names= and {name}=")
    return Matrices(found["M"], found.get("C"), found["K"], found.get("G"), at or {})


def _names(names: Mapping[str, str] | None) -> dict[str, str]:
    given = dict(mapping("names", names or {}))
    for key in given:
        if key not in NAMES:
            raise refusal("a key of names", key, f"one of {', '.join(NAMES)}")
    return given


def _found(path: Path, called: Mapping[str, str]) -> dict[str, Any]:
    held = contents(path)
    return {name: held[word] for name, word in called.items() if word in held}


def _single(path: Path, word: str) -> Any:
    """The only matrix of a file, or the one of that name."""
    held = contents(path)
    if len(held) == 1:
        return next(iter(held.values()))
    if word in held:
        return held[word]
    raise ValueError(f"{str(path)!r} holds {', '.join(held) or 'nothing'}; say which is meant by names=")
