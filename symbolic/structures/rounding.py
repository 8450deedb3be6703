"""What rounding of a stiffness matrix leaves of its modes.

Fine meshes have stiffnesses that cancel: the matrix of a beam of n elements has the condition n^4, and its
entries, right to rounding, hold its first frequency to n^4 times that.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symbolic.arrays import Array

LEFT = 1e-2
"""Largest relative error of omega^2, by rounding of K, of a mode that is told from a rigid-body mode: less
than that to which damping and supports of a structure are known."""


def uncertainty(stiffness: Any, shapes: Array) -> Array:
    """Return the standard deviation of omega^2 by rounding of the entries of K, each by itself.

    The first variation is phi' dK phi with dK_ij = eps K_ij: its root mean square is
    eps (sum_ij (phi_i K_ij phi_j)^2)^(1/2). Regular meshes, all of whose elements are rounded alike, come out
    better by a factor of about ten.

    Parameters
    ----------
    stiffness : array or sparse array, shape (n, n)
        K in N/m.
    shapes : ndarray, shape (n, J)
        Mode shapes, phi' M phi = 1.

    Returns
    -------
    ndarray, shape (J,)
        In rad^2/s^2.
    """
    moved = shapes**2
    variance = np.einsum("nj,nj->j", moved, (stiffness * stiffness) @ moved)
    return np.asarray(np.finfo(float).eps * np.sqrt(variance))


def hidden(stiffness: Any, squares: Array, shapes: Array) -> NDArray[np.bool_]:
    """Return which modes are rigid-body ones, or cannot be told from them: rounding of K hides their omega^2.

    Parameters
    ----------
    stiffness, shapes
        As `uncertainty` takes them.
    squares : ndarray, shape (J,)
        omega^2 in rad^2/s^2.

    Returns
    -------
    ndarray of bool, shape (J,)
        Whether omega^2 is less than its uncertainty over `LEFT`.
    """
    return np.asarray(np.abs(squares) * LEFT <= uncertainty(stiffness, shapes))
