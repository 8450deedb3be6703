"""The k-th largest of several numbers: how many elements carry load, as a function without their names.

Elements take each other's places after each passage, so that only what is the same in any order of them has
the period of the passage.
"""

from __future__ import annotations

from collections.abc import Sequence

import casadi as ca


def ranked(values: Sequence[ca.SX]) -> list[ca.SX]:
    """Return the values in falling order, by exchanges of neighbours."""
    found = list(values)
    for last in range(len(found) - 1, 0, -1):
        for k in range(last):
            found[k], found[k + 1] = ca.fmax(found[k], found[k + 1]), ca.fmin(found[k], found[k + 1])
    return found
