"""Whether a step passes a resonance unseen.

Where a complex pair of multipliers passes near +1 the free vibration is in tune with a harmonic of the
excitation (a superharmonic resonance): the branch may leave its course for a peak far narrower than a step
and return to it. The response to the parameter goes with (I - M)^-1, so the pair may not move by more than
a part of its distance from +1.
"""

from __future__ import annotations

import numpy as np

from periodic.scheme import Array

PART = 0.7
"""Largest move of a multiplier, as a part of its distance from +1."""

LEAST = 0.002
"""Moves as small as this are always allowed."""


def is_resolved(before: Array, after: Array) -> bool:
    """Whether the complex multipliers of two monodromy matrices are close enough, seen from +1."""
    old, new = np.linalg.eigvals(before), np.linalg.eigvals(after)
    for multiplier in new[np.abs(new.imag) > 0]:
        nearest = old[np.abs(old - multiplier).argmin()]
        allowed = PART * min(abs(1 - multiplier), abs(1 - nearest))
        if nearest.imag != 0 and abs(multiplier - nearest) > max(allowed, LEAST):
            return False
    return True
