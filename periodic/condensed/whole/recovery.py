"""Quantities that are linear in the displacements of a structure: stresses, strains, moments, sensors."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from periodic.condensed.whole.displacements import motion
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System


def recovery(
    system: System, orbit: Orbit, matrix: Any, tau: ArrayLike, structure: str | None = None
) -> Array:
    """Return R q, a recovery matrix R times the displacements q of a structure along an orbit.

    Parameters
    ----------
    system : System
        A system compiled from a structure.
    orbit : Orbit
        An orbit of it.
    matrix : array_like or scipy.sparse, shape (p, n)
        R, one column for each of the n degrees of freedom: stresses in Pa/m as a finite-element program
        writes them, say.
    tau : array_like, shape (K,)
        Phases in rad; tau = Omega t.
    structure : str, optional
        Name of the structure, where the system has several.

    Returns
    -------
    ndarray, shape (K, p)
        R q(tau). Only the degrees of freedom that R reads are computed.

    Raises
    ------
    ValueError
        For anything but a matrix of finite numbers with n columns, and where `motion` raises it.
    """
    rows = _checked(matrix)
    read = np.unique(rows.nonzero()[1])
    size = motion(system, orbit, None, 0.0, structure)[0].shape[1]
    if rows.shape[1] != size:
        raise ValueError(f"matrix has {rows.shape[1]} columns; it must have {size}, one for each freedom")
    displacement, _ = motion(system, orbit, read.tolist(), tau, structure)
    found: Array = np.asarray((rows[:, read] @ displacement.T).T)
    return found


def _checked(matrix: Any) -> Any:
    """The matrix in sparse rows."""
    try:
        rows = scipy.sparse.csr_array(matrix, dtype=float)
    except (TypeError, ValueError):
        rows = None
    if rows is None or rows.ndim != 2 or not np.isfinite(rows.data).all():
        raise ValueError(
            f"matrix is {matrix!r}; it must be a matrix of finite numbers with a column for each freedom"
        )
    return rows
