"""GPD: generalised period doublings, beyond which the doubled orbits are born on the other side.

There the cubic coefficient of the period map vanishes; a fold of doubled orbits begins.
"""

from __future__ import annotations

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.conditions.flip import flip_coefficient
from periodic.correction.outcome import FAILURES
from periodic.correction.solution import Solution
from periodic.system import linear_of


def _coefficient(solution: Solution) -> float:
    """The cubic coefficient; 0 where it is not known: beside kinks, and of condensed systems."""
    system, orbit = solution.problem.system, solution.orbit
    if len(orbit.phases) or linear_of(system) is not None:
        return 0.0
    try:
        return flip_coefficient(system, orbit)
    except FAILURES:
        return 0.0


GENERALISED = TestFunction(label=Label.GENERALISED_DOUBLING, value=_coefficient)
