"""The multipliers that every autonomous orbit has at 1, and what can be told from them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CONSERVED = 100.0
"""What lies within so many errors of the multipliers from 1 cannot be told from it,"""

ROUNDING = 1e-10
"""... or within this."""


def without_unit(multipliers: NDArray[np.complex128], count: int) -> NDArray[np.complex128]:
    """Return the multipliers without the `count` that are nearest 1."""
    return np.delete(multipliers, np.abs(multipliers - 1).argsort(kind="stable")[:count])
