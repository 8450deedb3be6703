"""Dynamic flexibility: what a linear structure answers to harmonic forces at its places."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy
from scipy.sparse.linalg import MatrixRankWarning, splu

from symbolic.arrays import Array, Complex
from symbolic.checks import finite, refusal, sequence
from symbolic.structures.matrices import Matrices, index, sparse


def flexibility(
    matrices: Matrices, places: Sequence[str | int], omega: Sequence[float], *, speed: float = 0.0
) -> Complex:
    """Return the dynamic flexibility at places of a structure.

    H(omega) = B' (K + i omega (C + Omega G) - omega^2 M)^-1 B, B the columns of the identity at the places.

    Parameters
    ----------
    matrices : Matrices
        The structure.
    places : sequence of str or int
        Names or indices of k degrees of freedom.
    omega : sequence of float
        N angular frequencies in rad/s.
    speed : float
        Omega in rad/s.

    Returns
    -------
    ndarray, shape (N, k, k)
        H in m/N: row the place that moves, column the place of the force.

    Raises
    ------
    ValueError
        For places that do not exist, and at an undamped resonance, where there is no answer.
    """
    dofs = indices(matrices, places)
    damping = damping_at(matrices, finite("speed", speed))
    load = np.zeros((matrices.size, len(dofs)))
    load[dofs, np.arange(len(dofs))] = 1
    answers: list[Complex] = []
    for w in sequence("omega", omega):
        answer = solved(matrices.K + 1j * w * damping - w**2 * matrices.M, load)
        if answer is None:
            raise ValueError(f"omega is {w:g}; it must not be that of an undamped resonance")
        answers.append(answer[dofs])
    return np.array(answers)


def indices(matrices: Matrices, places: Sequence[str | int]) -> Array:
    """Return the indices of places given by name or index, no one twice. Raises ValueError."""
    if isinstance(places, str) or not np.iterable(places) or not len(places):
        raise refusal("places", places, "a sequence of at least one name or index")
    dofs = [matrices[p] if isinstance(p, str) else index(str(p), p, matrices.size) for p in places]
    if len(set(dofs)) < len(dofs):
        raise refusal("places", places, "different degrees of freedom")
    return np.array(dofs)


def damping_at(matrices: Matrices, speed: float) -> Array:
    """Return C + Omega G."""
    damping: Array = matrices.C if matrices.G is None else matrices.C + speed * matrices.G
    return damping


def solved(matrix: Array, load: Array) -> Complex | None:
    """Return matrix^-1 load for an array or a sparse matrix; None where the matrix is singular."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", category=MatrixRankWarning)
        warnings.simplefilter("error", category=scipy.linalg.LinAlgWarning)
        try:
            if sparse.issparse(matrix):
                found: Any = splu(sparse.csc_array(matrix)).solve(load.astype(matrix.dtype))
            else:
                found = scipy.linalg.solve(matrix, load)
        except (RuntimeError, MatrixRankWarning, scipy.linalg.LinAlgWarning, np.linalg.LinAlgError):
            return None
    return np.asarray(found) if np.isfinite(found).all() else None
