"""The bordered solve: equations closed by side conditions, for several right-hand sides at once."""

from __future__ import annotations

import numpy as np

from periodic.orbit.scheme import Array


def solve(rows: Array, right: Array) -> Array:
    """Return u with J u = -s r and C u = b - s c for each column (s, b) of `right`, see `Operator`.

    Parameters
    ----------
    rows : ndarray, shape (u, 1 + u)
        The equations (r, J), and below them the side conditions (c, C).
    right : ndarray, shape (1 + q, columns)
        The columns (s, b_1, ..., b_q), q the number of side conditions.

    Returns
    -------
    ndarray, shape (u, columns)
        The unknowns, one solution a column.

    Raises
    ------
    numpy.linalg.LinAlgError
        Where the bordered matrix is singular.
    """
    aim = -rows[:, :1] * right[:1]
    aim[len(aim) - len(right) + 1 :] += right[1:]
    found = np.linalg.solve(rows[:, 1:], aim).astype(float, copy=False)
    if not np.isfinite(found).all():
        raise np.linalg.LinAlgError("the bordered matrix is singular")
    return found
