"""Energy of each mode of a structure in a motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from symbolic.arrays import Array
from symbolic.checks import refusal, whole
from symbolic.structures.matrices import Matrices, modes


def modal_energy(
    matrices: Matrices, displacement: ArrayLike, velocity: ArrayLike, count: int | None = None
) -> Array:
    """Return the energy of each of the lowest undamped modes at K instants of a motion.

    E_j = (eta_j'^2 + omega_j^2 eta_j^2)/2 with eta_j = phi_j' M q and phi_j' M phi_j = 1. All n modes
    together have the kinetic and the elastic energy.

    Parameters
    ----------
    matrices : Matrices
        The structure, its K symmetric.
    displacement, velocity : array_like, shape (K, n)
        As `periodic.motion` returns them for all degrees of freedom (m, m/s).
    count : int, optional
        Number k of modes; by default all, up to 12.

    Returns
    -------
    ndarray, shape (K, k)
        In J, the lowest mode first; its mean over the rows of a period is the mean energy.

    Raises
    ------
    ValueError
        For arrays of another width, a number of modes out of range and a K that is not symmetric.
    """
    n = matrices.size
    moved = [
        _rows(name, given, n) for name, given in (("displacement", displacement), ("velocity", velocity))
    ]
    kept = min(n, 12) if count is None else whole("count", count, 1)
    if kept > n:
        raise refusal("count", kept, f"a whole number from 1 to {n}")
    if abs(matrices.K - matrices.K.T).max() > 1e-10 * abs(matrices.K).max():
        raise ValueError("K is not symmetric; energy per mode is that of a structure with a symmetric K")
    squares, shapes = modes(matrices.K, matrices.M, kept)
    place, rate = (given @ (matrices.M @ shapes) for given in moved)
    energy: Array = (rate**2 + squares * place**2) / 2
    return energy


def _rows(name: str, given: ArrayLike, size: int) -> Array:
    try:
        rows = np.atleast_2d(np.asarray(given, dtype=float))
    except (TypeError, ValueError):
        raise refusal(name, given, "an array of numbers") from None
    if rows.ndim != 2 or rows.shape[1] != size:
        raise ValueError(f"{name} has shape {rows.shape}; it must be (K, {size}), a row for each instant")
    return rows
