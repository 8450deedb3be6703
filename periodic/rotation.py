"""Whether a step passes a resonance unseen.

Where a complex pair of multipliers passes near +1 the free vibration is in tune with a harmonic of the
excitation (a superharmonic resonance): the branch may leave its course for a peak far narrower than a step
and return to it. The response to the parameter goes with (I - M)^-1, so the pair may not turn by more than
a part of its distance from +1. Where it passes -1 or +1 it may also leave the unit circle and come back. Its
angle is followed over the whole period, so that full turns count.
"""

from __future__ import annotations

from dataclasses import dataclass

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
    """A complex pair of multipliers: the angle turned over the period, its modulus, its distance from +1."""

    angle: float
    modulus: float
    distance: float


@dataclass(frozen=True)
class Turn:
    """How far multipliers turn in a step, where 1 is the most that they may, and whether towards +1.

    On the way towards +1 the most shrinks with the distance.
    """

    part: float
    nearing: bool = False

    @property
    def strain(self) -> float:
        """The same, about linear in the step's length."""
        return self.part * (1 + PART) / self._nearer if self.nearing else self.part

    @property
    def ahead(self) -> float:
        """What the strain of a step as long would be next."""
        return self.strain * self._nearer if self.nearing else self.part

    @property
    def _nearer(self) -> float:
        return 1 + PART * self.part


def turned(before: Correction, after: Correction) -> Turn:
    """How far lightly damped pairs of multipliers turn between two orbits."""
    turns = [
        Turn(abs(a.angle - b.angle) / max(PART * min(a.distance, b.distance), LEAST), b.distance < a.distance)
        for a, b in _matched(before, after)
        if min(a.modulus, b.modulus) > LIGHT
    ]
    return max(turns, key=lambda turn: turn.part, default=Turn(0.0))


def passes(before: Correction, after: Correction, sign: int) -> bool:
    """Whether a pair turns past `sign` (+1 or -1) between two orbits."""
    offset = 0.0 if sign > 0 else np.pi
    return any(
        np.floor((a.angle - offset) / (2 * np.pi)) != np.floor((b.angle - offset) / (2 * np.pi))
        for a, b in _matched(before, after)
    )


def _matched(before: Correction, after: Correction) -> list[tuple[Pair, Pair]]:
    """The pairs of two orbits, each of the side that has fewer with the nearest of the other.

    A pair may be born of two real multipliers or end in them.
    """
    fewer, more = sorted((pairs(before), pairs(after)), key=len)
    return [(a, min(more, key=lambda b: abs(b.angle - a.angle))) for a in fewer]


def pairs(correction: Correction) -> list[Pair]:
    """Return the complex pairs of multipliers, without those that are 1 whatever the parameters.

    The angle is that of the largest component of the eigenvector's solution, followed along the mesh.
    """
    fundamental = correction.fundamental
    multipliers, vectors = np.linalg.eig(correction.monodromy)
    unit = np.abs(multipliers - 1).argsort()[: correction.unit]
    found = []
    for k in np.setdiff1d(np.flatnonzero(multipliers.imag > 0), unit):
        solution = fundamental @ vectors[:, k]
        component = int(np.abs(solution).mean(axis=0).argmax())
        angle = np.unwrap(np.angle(solution[:, component]))
        turned = abs(float(angle[-1] - angle[0]))
        found.append(Pair(turned, float(abs(multipliers[k])), float(abs(1 - multipliers[k]))))
    return found
