"""Whether a step passes a resonance unseen.

Where a complex pair of multipliers passes near +1 the free vibration is in tune with a harmonic of the
excitation (a superharmonic resonance): the branch may leave its course for a peak far narrower than a step
and return to it. The response to the parameter goes with (I - M)^-1, so the pair may not turn by more than
a part of its distance from +1. Where it passes -1 or +1 it may also leave the unit circle and come back. Its
solution is followed over the whole period, so that full turns count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from periodic.newton import Correction

PART = 0.7
"""Largest turn of a multiplier (rad), as a part of its distance from +1."""

LEAST = 0.002
"""Turns as small as this are always allowed."""


LIGHT = 0.8
"""Pairs of smaller modulus are damped too well for a narrow peak."""


@dataclass(frozen=True)
class Pair:
    """A complex pair of multipliers: argument, modulus, distance from +1, and how far its solution w turns.

    turned: the mean of the turns of all components, the integral of Im(w* dw)/|w|^2 over the period. Unlike
    that of a single component, which may pass through 0, it changes smoothly with the orbit.
    """

    argument: float
    modulus: float
    distance: float
    turned: float

    @property
    def conjugate(self) -> Pair:
        """The other member of the pair."""
        return replace(self, argument=-self.argument, turned=-self.turned)

    def turn(self, other: Pair) -> float:
        """Return by how much the multiplier turns to that of another orbit, whole turns included."""
        least = other.argument - self.argument
        whole = round((other.turned - self.turned - least) / (2 * np.pi))
        return least + 2 * np.pi * whole

    def nearest(self, others: Sequence[Pair]) -> Pair:
        """Return the member of another orbit's pairs to which this one leads."""
        members = [member for other in others for member in (other, other.conjugate)]
        return min(members, key=lambda other: abs(self.turn(other)) + abs(other.turned - self.turned))


def is_resolved(before: Correction, after: Correction) -> bool:
    """Whether two orbits' lightly damped pairs of multipliers are close enough, seen from +1."""
    for a, b in _matched(before, after):
        light = min(a.modulus, b.modulus) > LIGHT
        if light and abs(a.turn(b)) > max(PART * min(a.distance, b.distance), LEAST):
            return False
    return True


def passes(before: Correction, after: Correction, sign: int) -> bool:
    """Whether a pair turns past `sign` (+1 or -1) between two orbits."""
    offset = 0.0 if sign > 0 else np.pi

    def turns(angle: float) -> int:
        return int(np.floor((angle - offset) / (2 * np.pi)))

    return any(turns(a.argument) != turns(a.argument + a.turn(b)) for a, b in _matched(before, after))


def _matched(before: Correction, after: Correction) -> list[tuple[Pair, Pair]]:
    """The pairs of two orbits, each of the side that has fewer with the nearest of the other.

    A pair may be born of two real multipliers or end in them.
    """
    fewer, more = sorted((pairs(before), pairs(after)), key=len)
    return [(a, a.nearest(more)) for a in fewer]


def pairs(correction: Correction) -> list[Pair]:
    """Return a member of each complex pair of multipliers that is not 1 whatever the parameters."""
    fundamental = correction.fundamental
    multipliers, vectors = np.linalg.eig(correction.monodromy)
    unit = np.abs(multipliers - 1).argsort()[: correction.unit]
    found = []
    for k in np.setdiff1d(np.flatnonzero(multipliers.imag > 0), unit):
        solution, mu = fundamental @ vectors[:, k], multipliers[k]
        turned = float(np.angle((solution[:-1].conj() * solution[1:]).sum(axis=1)).sum())
        found.append(Pair(float(np.angle(mu)), float(abs(mu)), float(abs(1 - mu)), turned))
    return found
