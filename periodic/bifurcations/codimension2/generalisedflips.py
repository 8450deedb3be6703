"""GPD: generalised period doublings, where the doubling changes from supercritical to subcritical.

There the cubic coefficient of the period map vanishes; a fold of doubled orbits begins.
"""

from __future__ import annotations

import warnings

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.condensed.condensedcollocation import mesh_method
from periodic.conditions.flip import flip_coefficient
from periodic.correction.outcome import FAILURES
from periodic.correction.solution import Solution

SIMPLE = 1e-3
"""With a second multiplier as near to -1 the coefficient is not computed: it is infinite at R2."""


LEAST_COEFFICIENT = 1e-8
"""Coefficients smaller than this times the norm of the monodromy matrix are rounding, and taken as 0."""


def _simple(solution: Solution) -> bool:
    """Whether one multiplier alone is -1."""
    beside = np.sort(np.abs(solution.spectrum.multipliers + 1))[1:]
    return bool(beside.min(initial=np.inf) > SIMPLE)


def _coefficient(solution: Solution) -> float:
    """The cubic coefficient of the period map; 0 where it is not computed.

    It is not computed for orbits with event nodes, for condensed and for autonomous systems, and beside a
    second multiplier -1. A remark of the branch says so; where the computation fails, a warning does.
    """
    problem, orbit = solution.problem, solution.orbit
    system, known = problem.system, _simple(solution) and not problem.autonomous
    if len(orbit.phases) or not mesh_method(system).all_states or not known:
        return 0.0
    try:
        found = flip_coefficient(system, orbit)
    except FAILURES as error:
        place = f"{solution.problem.parameter} = {solution.value:.6g}"
        warnings.warn(f"GPD is not looked for about {place}: {error}", RuntimeWarning, stacklevel=2)
        return 0.0
    return found if abs(found) > LEAST_COEFFICIENT * np.linalg.norm(solution.spectrum.monodromy, 2) else 0.0


GENERALISED = TestFunction(label=Label.GENERALISED_DOUBLING, value=_coefficient, genuine=_simple)
