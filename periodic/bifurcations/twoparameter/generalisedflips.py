"""GPD: generalised period doublings, beyond which the doubled orbits are born on the other side.

There the cubic coefficient of the period map vanishes; a fold of doubled orbits begins.
"""

from __future__ import annotations

import warnings

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.condensed.method import mesh_method
from periodic.conditions.flip import flip_coefficient
from periodic.correction.outcome import FAILURES
from periodic.correction.solution import Solution

SIMPLE = 1e-3
"""Distance of a second multiplier from -1 up to which the coefficient is not known: it is infinite at R2."""


ROUNDING = 1e-8
"""What is left of the coefficient of a linear system, about, in norms of the monodromy matrix."""


def _simple(solution: Solution) -> bool:
    """Whether one multiplier alone is -1."""
    beside = np.sort(np.abs(solution.spectrum.multipliers + 1))[1:]
    return bool(beside.min(initial=np.inf) > SIMPLE)


def _coefficient(solution: Solution) -> float:
    """The cubic coefficient; 0 where it is not known: beside kinks, of condensed and of autonomous systems.

    Of these the branch says so in a remark; where the coefficient cannot be computed a warning does.
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
    return found if abs(found) > ROUNDING * np.linalg.norm(solution.spectrum.monodromy, 2) else 0.0


GENERALISED = TestFunction(label=Label.GENERALISED_DOUBLING, value=_coefficient, genuine=_simple)
