"""Thresholds of what events decide, each with its equation.

A switch s is compared with its level 0 in parts of its largest value along the orbit; a radian is the time in
which it changes by about as much. What is near is so by the rounding of s, or by the error that an orbit of
the standard tolerance has. The levels lie a decade or more apart: no decision is undone by the rounding of
the next. With `NOISE` a tenth and ten times as large, and all that follows from it, models drawn at random
have the same special points, to 2e-9 in the parameter.
"""

from __future__ import annotations

from periodic.correction.tolerance import Accuracy
from periodic.orbit.mesh import MIN_INTERVALS
from periodic.system.precision import EPSILON

NOISE = 1e-11
"""Rounding of s on a solved orbit: eps, times the condition of its equations."""

RELEASED = 10 * NOISE
"""How far past its limit what holds the motion may be at an event node, by rounding."""

AT_LEVEL = 100 * NOISE
"""s at its level. Orbits are held so far short of a change of their word: then they are on their own side."""

TOGETHER = 100 * AT_LEVEL
"""s of what happens at once with another event, by symmetry or as the other brings it about."""

SAME_PHASE = AT_LEVEL
"""rad; about AT_LEVEL / s', the error of the phase at which s passes its level."""

AT_EXTREMUM = NOISE**0.5
"""rad; about (2 NOISE / s'')^(1/2), the error of an extremum's phase by rounding; the slope is as small."""

BESIDE_EXTREMUM = Accuracy.STANDARD**0.5
"""rad; the same by the orbit's error. Lengths of excursions of one depth differ by as much, relatively."""

SLOW_CROSSING = Accuracy.STANDARD ** (1 / 3)
"""rad; about (6 tol / s''')^(1/3): how long s is at its level to that error where s' = s'' = 0."""

LONGEST = 1e-2
"""Largest size at which words are exchanged (rad; of impacts the speed, as a part of the range of s).

The states change by its square: by the error of an orbit at the coarsest tolerances, by far less than a step.
"""

LEAST_GRAZING = AT_LEVEL**0.5
"""Least size of what touches, whose depth s'' size^2 is AT_LEVEL there."""

LEAST_CROSSING = MIN_INTERVALS * EPSILON / AT_LEVEL
"""Least size of what passes: on the intervals within it rates, by rounding, are just known to AT_LEVEL."""

VANISHING = 0.5
"""What a step would leave this part of, by its tangent, may end in it; what is not longer by 1 / this too."""

SHALLOW = 0.1
"""Depth past a level, over the largest, of what may be about to vanish, and may do without event nodes."""


def decades(most: float, least: float) -> tuple[float, ...]:
    """Return sizes from the largest on, each a tenth of the one before, none below the least."""
    found = [most]
    while found[-1] / 10 >= least:
        found.append(found[-1] / 10)
    return tuple(found)
