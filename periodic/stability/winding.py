"""Whether a step passes a resonance unseen.

Where a complex pair of multipliers passes near +1 the free vibration is in tune with a harmonic of the
excitation (a superharmonic resonance): the branch may leave its course for a peak far narrower than a step
and return to it. The response to the parameter goes with (I - M)^-1, so the pair may not turn by more than
a part of its distance from +1. Where it passes -1 or +1 it may also leave the unit circle and come back. Its
solution is followed over the whole period, so that full turns count.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.checks import positive
from periodic.stability.spectrum import Pair, Spectrum


@dataclass(frozen=True, kw_only=True)
class WindingLimits:
    """How far multipliers may turn in a step.

    Parameters
    ----------
    part : float
        Largest turn of a multiplier (rad), as a part of its distance from +1.
    least : float
        Turns (rad) as small as this are always allowed.
    light : float
        Pairs of smaller modulus are damped too well for a narrow peak.
    """

    part: float = 0.7
    least: float = 0.002
    light: float = 0.8

    def __post_init__(self) -> None:
        for name in ("part", "least", "light"):
            positive(name, getattr(self, name))


@dataclass(frozen=True)
class Turn:
    """How far multipliers turn in a step, where 1 is the most that they may, and whether towards +1.

    On the way towards +1 the most shrinks with the distance, of which it is the part `most`.
    """

    part: float
    nearing: bool = False
    most: float = 0.7

    @property
    def strain(self) -> float:
        """The same, about linear in the step's length."""
        return self.part * (1 + self.most) / self._nearer if self.nearing else self.part

    @property
    def ahead(self) -> float:
        """What the strain of a step as long would be next."""
        return self.strain * self._nearer if self.nearing else self.part

    @property
    def _nearer(self) -> float:
        return 1 + self.most * self.part


def turned(before: Spectrum, after: Spectrum, limits: WindingLimits) -> Turn:
    """How far lightly damped pairs of multipliers turn between two orbits."""

    def turn(a: Pair, b: Pair) -> Turn:
        allowed = max(limits.part * min(a.distance, b.distance), limits.least)
        return Turn(abs(a.turn(b)) / allowed, b.distance < a.distance, limits.part)

    pairs = [(a, b) for a, b in _matched(before, after) if min(a.modulus, b.modulus) > limits.light]
    return max((turn(*pair) for pair in pairs), key=lambda turn: turn.part, default=Turn(0.0))


def passes(before: Spectrum, after: Spectrum, sign: int) -> bool:
    """Whether a pair turns past `sign` (+1 or -1) between two orbits."""
    offset = 0.0 if sign > 0 else np.pi

    def turns(angle: float) -> int:
        return int(np.floor((angle - offset) / (2 * np.pi)))

    return any(turns(a.argument) != turns(a.argument + a.turn(b)) for a, b in _matched(before, after))


def _matched(before: Spectrum, after: Spectrum) -> list[tuple[Pair, Pair]]:
    """The pairs of two orbits, each of the side that has fewer with the nearest of the other.

    A pair may be born of two real multipliers or end in them.
    """
    fewer, more = sorted((before.pairs, after.pairs), key=len)
    return [(a, a.nearest(more)) for a in fewer]
