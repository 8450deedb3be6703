"""Stationary tests: test functions of where a functional of the orbit has a peak or trough on the branch."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.conditions.functionals import Functional, Smooth
from periodic.correction.predictor import tangent
from periodic.correction.solution import Solution
from periodic.tracing.steps.leveltest import rate_of

ARCLENGTH_STEP = 1e-4
"""Arclength of the difference that stands for a derivative along the branch."""

PLACE_PRECISION = 1e-7
"""Error of the place along the branch, in steps; that of the functional is about its square."""


def stationary_test(functional: Functional, name: str) -> TestFunction:
    """Return the test function of the places where a functional is stationary along the branch."""
    exact, by_difference = rate_of(cast(Smooth, functional)), slope(functional)

    def value(solution: Solution) -> float:
        problem = solution.problem
        known = hasattr(functional, "linearise") and hasattr(problem.system, "output_gradient")
        return exact(solution) if known and problem.wider is None else by_difference(solution)

    return TestFunction(label=Label.USER, value=value, precision=PLACE_PRECISION, name=name)


def slope(functional: Functional) -> Callable[[Solution], float]:
    """Return the derivative of a functional in arclength, by a central difference along the tangent."""

    def value(solution: Solution) -> float:
        problem = solution.problem
        ends = [
            functional(problem.full, problem.expand(tangent(problem, solution, h)))
            for h in (ARCLENGTH_STEP, -ARCLENGTH_STEP)
        ]
        return (ends[0] - ends[1]) / (2 * ARCLENGTH_STEP)

    return value
