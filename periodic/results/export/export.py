"""One file of a branch for another program; its ending tells the format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from periodic.checks import whole
from periodic.results.branch import Branch
from periodic.results.export.content import Content, content
from periodic.results.export.hdf5 import write_hdf5
from periodic.results.export.matlab import write_mat
from periodic.results.export.texts import write_csv
from periodic.results.export.uff import write_uff

FORMATS: dict[str, Callable[[Path, Content], list[Path]]] = {
    ".csv": write_csv,
    ".mat": write_mat,
    ".h5": write_hdf5,
    ".hdf5": write_hdf5,
    ".uff": write_uff,
    ".unv": write_uff,
}
"""What writes a format, by the ending of its files."""

FEWEST_SAMPLES = 4
"""Fewest samples of a period."""


def export(branch: Branch, path: str | Path, *, samples: int = 256) -> list[Path]:
    """Write a branch for another program: the numbers of its points, and its orbits over one period, in SI.

    Parameters
    ----------
    branch : Branch
        The branch.
    path : str or Path
        The file; it ends in .csv (a second file, FILE-orbits.csv, has the orbits), .mat (MATLAB, Octave),
        .h5 or .hdf5, .uff or .unv (UFF58). One that is there is replaced. Folders are made. A name or label
        that a spreadsheet would take for a formula, as one that begins with =, +, - or @, has an apostrophe
        before it in CSV and UFF58: ``'=x [m]``.
    samples : int
        Values of each signal over the period, evenly in time, the end of the period left out.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    ValueError
        For what is no branch, another ending, and too few samples.
    ModuleNotFoundError
        For UFF58 without pyuff: ``pip install 'orbitrace[uff]'``.
    OSError
        Where it cannot be written.
    """
    if not isinstance(branch, Branch):
        raise ValueError(f"branch is {branch!r}; it must be a Branch, as periodic.trace returns it")
    file, count = Path(path), whole("samples", samples, FEWEST_SAMPLES)
    if file.suffix.lower() not in FORMATS:
        raise ValueError(f"path is {str(path)!r}; it must be a file that ends in {', '.join(FORMATS)}")
    return FORMATS[file.suffix.lower()](file, content(branch, count))
