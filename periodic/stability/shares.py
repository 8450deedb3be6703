"""Which intervals the multipliers' error comes from.

Where a derivative of the equations has a kink, as at the lift-off of a Hertzian contact, the fundamental
solutions are less smooth than the orbit: a mesh made for the orbit alone leaves them their error.
"""

from __future__ import annotations

import numpy as np

from periodic.orbit.scheme import Array

WORST = 1e12
"""Condition of fundamental matrices beyond which what damping has left of motions is rounding."""


def shares(fundamental: Array, halved: Array) -> Array | None:
    """Return the norm of what each interval adds to the error of the monodromy matrix, shape (N,).

    With Phi the fundamental matrices and D their difference from those on the mesh with every interval
    halved, that is M (Phi_{j+1}^-1 D_{j+1} - Phi_j^-1 D_j).

    Parameters
    ----------
    fundamental, halved : ndarray, shapes (N+1, n, n), (2N+1, n, n)
        Fundamental matrices at the mesh points of both.

    Returns
    -------
    ndarray or None
        None where motions are damped so well that nothing but rounding is left of them to tell it by, or
        where matrices are of other places.
    """
    if len(halved) != 2 * len(fundamental) - 1:
        return None
    with np.errstate(all="ignore"):  # growth by hundreds of decades is too much for shares, no error
        return _shares(fundamental, halved[::2] - fundamental)


def _shares(fundamental: Array, late: Array) -> Array | None:
    try:
        inverse: Array = np.asarray(np.linalg.inv(fundamental), dtype=float)
    except np.linalg.LinAlgError:
        return None
    condition = _norms(inverse) * _norms(fundamental)
    if not condition.max() < WORST:
        return None
    steps: Array = fundamental[-1] @ np.diff(inverse @ late, axis=0)
    found = _norms(steps)
    return found if np.isfinite(found).all() else None


def _norms(matrices: Array) -> Array:
    return np.asarray(np.linalg.norm(matrices, axis=(1, 2)))
