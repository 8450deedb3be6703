"""Thresholds for decisions about events, each with its equation.

Values of a switch s are relative to its largest value along the orbit, and s is taken to change by about as
much in a radian. Two values are near each other within the rounding of s, or within the error of an orbit of
the standard tolerance. The thresholds lie a decade or more apart, so that rounding at one does not undo a
decision at the next. With `NOISE` a tenth and ten times as large, and all that follows from it, models drawn
at random have the same special points, to 2e-9 in the parameter.
"""

from __future__ import annotations

from periodic.correction.tolerance import Accuracy
from periodic.orbit.mesh import MIN_INTERVALS
from periodic.system.precision import EPSILON

NOISE = 1e-11
"""Rounding of s on a solved orbit: eps, times the condition of its equations."""

RELEASED = 10 * NOISE
"""How far past its limit the force that holds a motion may be at an event node, by rounding."""

AT_LEVEL = 100 * NOISE
"""Largest |s| that counts as at its level. Orbits are held this far short of a change of their word."""

TOGETHER = 100 * AT_LEVEL
"""Largest |s| of an event that coincides with another one, by symmetry or as the other causes it."""

ALIKE = 10 * Accuracy.STANDARD
"""The same where the orbit's error parts them: tried last, as the word of the orbit beyond decides."""

SAME_PHASE = AT_LEVEL
"""rad; about AT_LEVEL / s', the error of the phase at which s passes its level."""

AT_EXTREMUM = NOISE**0.5
"""rad; about (2 NOISE / s'')^(1/2), the error of an extremum's phase by rounding; the slope is as small."""

BESIDE_EXTREMUM = Accuracy.STANDARD**0.5
"""rad; the same by the orbit's error. Also the relative difference of equally deep excursions' lengths."""

SLOW_CROSSING = Accuracy.STANDARD ** (1 / 3)
"""rad; about (6 tol / s''')^(1/3): how long |s| is below the orbit's error where s = s' = s'' = 0."""

LONGEST = 1e-2
"""Largest size at which words are exchanged (rad; of impacts the speed, as a part of the range of s).

The exchange changes the states by its square: by the error of an orbit at the coarsest tolerances, and by far
less than a step does.
"""

LEAST_GRAZING = AT_LEVEL**0.5
"""Least size of an excursion beyond grazing: its depth s'' size^2 is AT_LEVEL."""

LEAST_CROSSING = MIN_INTERVALS * EPSILON / AT_LEVEL
"""Least size of a segment between crossings: in its intervals rounding leaves rates an error of AT_LEVEL."""

VANISHING = 0.5
"""An excursion that a step along the tangent shortens to this part may end in the step.

Excursions up to 1 / this times as long count as equally short.
"""

SHALLOW = 0.1
"""Depth of an excursion, over the largest |s|, up to which it may vanish soon and needs no event nodes."""


def decades(most: float, least: float) -> tuple[float, ...]:
    """Return sizes from the largest on, each a tenth of the one before, none below the least."""
    found = [most]
    while found[-1] / 10 >= least:
        found.append(found[-1] / 10)
    return tuple(found)
