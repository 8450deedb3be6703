"""The invariant subspace of a pair of eigenvalues, which stays smooth where the pair becomes real."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.orbit.scheme import Array

Numbers = NDArray[np.inexact]


def subspaces(matrix: Array, which: list[int], values: Numbers) -> tuple[Array, Array]:
    """Return right and left bases (n, 2) of the invariant subspace of two eigenvalues, left.T right = I.

    `which` are their indices among all eigenvalues `values` (n,) of the matrix. Raises
    numpy.linalg.LinAlgError where they cannot be told from others.
    """
    chosen, others = values[which], np.delete(values, which)

    def wanted(real: float, imag: float) -> bool:
        value = complex(real, imag)
        return bool(np.abs(chosen - value).min() < np.abs(others - value).min(initial=np.inf))

    right = scipy.linalg.schur(matrix, sort=wanted)[1][:, :2]
    left = scipy.linalg.schur(matrix.T, sort=wanted)[1][:, :2]
    return right, left @ np.linalg.inv(right.T @ left)


def within(basis: Array, vectors: Numbers) -> list[int]:
    """Return which two of some vectors of unit length (n, k) lie nearest to an orthonormal basis' span."""
    outside = np.linalg.norm(vectors - basis @ (basis.T @ vectors), axis=0)
    first, second = np.triu_indices(vectors.shape[1], 1)
    k = int((outside[first] + outside[second]).argmin())
    return [int(first[k]), int(second[k])]
