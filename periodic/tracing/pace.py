"""How soon a motion settles, from how far it was from coming back over its last periods."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

LAST = 10
"""How many of the last periods tell at the most: a beat between modes is seen as a whole."""


def periods_left(apart: Sequence[float], wanted: float) -> float:
    """Return in how many periods a motion settles, if it goes on as before; infinite if it does not settle.

    Parameters
    ----------
    apart : sequence of float
        Distances of the ends of its periods from their beginnings. At least two.
    wanted : float
        The distance at which it has settled.
    """
    last = np.log(np.maximum(apart[-LAST:], np.finfo(float).tiny))
    slope, here = np.polyfit(np.arange(1 - len(last), 1), last, 1)
    return max(float((np.log(wanted) - here) / slope), 0.0) if slope < 0 else np.inf
