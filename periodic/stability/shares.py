"""Which intervals the multipliers' error comes from.

Where a derivative of the equations has a kink, as at the lift-off of a Hertzian contact, the fundamental
solutions are less smooth than the orbit: a mesh made for the orbit alone leaves them their error.
"""

from __future__ import annotations

import numpy as np

from periodic.orbit.scheme import Array


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
        None where motions are damped so well that nothing is left of them to tell it by, or where matrices
        are of other places.
    """
    if len(halved) != 2 * len(fundamental) - 1:
        return None
    try:
        late = np.linalg.solve(fundamental, halved[::2] - fundamental)
    except np.linalg.LinAlgError:
        return None
    found: Array = np.linalg.norm(fundamental[-1] @ np.diff(late, axis=0), axis=(1, 2))
    return found if np.isfinite(found).all() else None
