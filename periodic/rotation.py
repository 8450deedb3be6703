"""Whether a step passes a resonance unseen.

Where a complex pair of multipliers passes near +1 the free vibration is in tune with a harmonic of the
excitation (a superharmonic resonance): the branch may leave its course for a peak far narrower than a step
and return to it. Near -1 it may double its period and undouble it again. The response to the parameter goes
with (I - M)^-1 or (I + M)^-1, so the pair may not turn by more than a part of its distance from these points.
Its angle is followed over the whole period, so that full turns count.
"""

from __future__ import annotations

import numpy as np

from periodic.scheme import Array

PART = 0.7
"""Largest turn of a multiplier (rad), as a part of its distance from +1."""

DOUBLED = 1.5
"""The same for -1, where a peak that is passed unseen has both its doublings within the step."""

LEAST = 0.002
"""Turns as small as this are always allowed."""


LIGHT = 0.8
"""Pairs of smaller modulus are damped too well for a narrow peak."""


def is_resolved(before: Array, after: Array) -> bool:
    """Whether two orbits' complex multipliers are close enough, seen from +1 and -1.

    before, after: fundamental matrices at the mesh points, shape (N+1, n, n); the last is the monodromy.
    """
    # A pair may be born of two real multipliers or end in them.
    fewer, more = sorted((turns(before), turns(after)), key=len)
    for angle, allowed in fewer:
        other, other_allowed = min(more, key=lambda pair: abs(pair[0] - angle))
        if abs(angle - other) > max(min(allowed, other_allowed), LEAST):
            return False
    return True


def turns(fundamental: Array) -> list[tuple[float, float]]:
    """Angle turned over the period by each lightly damped pair of multipliers, and how far it may turn on.

    The angle is that of the largest component of the eigenvector's solution, followed along the mesh.
    """
    multipliers, vectors = np.linalg.eig(fundamental[-1])
    result = []
    for k in np.flatnonzero((multipliers.imag > 0) & (np.abs(multipliers) > LIGHT)):
        solution = fundamental @ vectors[:, k]
        component = int(np.abs(solution).mean(axis=0).argmax())
        angle = np.unwrap(np.angle(solution[:, component]))
        allowed = min(PART * abs(1 - multipliers[k]), DOUBLED * abs(1 + multipliers[k]))
        result.append((abs(float(angle[-1] - angle[0])), float(allowed)))
    return result
