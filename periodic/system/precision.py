"""What double precision leaves: steps of differences, where an iteration is done, the largest number."""

from __future__ import annotations

import numpy as np

EPSILON = float(np.finfo(float).eps)
"""Relative rounding of a number."""

CONVERGED = float(np.sqrt(EPSILON))
"""Newton's increment, relative, after which the next one is rounding: it would be about its square.

Also how nearly dependent two directions may be: numbers that are found along them have half their digits.
"""

MOST_ITERATIONS = 12
"""Newton steps for a few unknowns: with its digits doubled at each, five lead from one digit to rounding."""

EXTREME = 1e100
"""Largest magnitude of an end of a range, its reciprocal the least: cubes of both are finite."""

SMALLEST = float(np.finfo(float).tiny)
"""Least number with all its digits: a length or a factor below it is none, and nothing is divided by it."""

LARGEST = 1e300
"""What is larger is given as this number; it may still be added up, and the square of its root is finite."""


def difference_step(order: int, derivative: int = 1, noise: float = EPSILON) -> float:
    """Return the step of a finite difference, relative to the size of the argument.

    Its error is about h^order from what it leaves out and noise / h^derivative from the values: as small as
    can be at h = noise^(1 / (order + derivative)).

    Parameters
    ----------
    order : int
        Order of the difference.
    derivative : int
        Which derivative it stands for.
    noise : float
        Relative error of the values: rounding, or more where they are solved for.

    Returns
    -------
    float
        The step h.
    """
    return float(noise ** (1 / (order + derivative)))
