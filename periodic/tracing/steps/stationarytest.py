"""Stationary tests: test functions of where a functional of the orbit has a peak or trough on the branch."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.conditions.extremes import PeakToPeak
from periodic.conditions.functionals import Functional, Smooth
from periodic.correction.measured import ARCLENGTH_STEP, measured
from periodic.correction.predictor import tangent
from periodic.correction.solution import Solution
from periodic.tracing.steps.leveltest import rate_of

PLACE_PRECISION = 1e-7
"""Error of the place along the branch, in steps; that of the functional is about its square."""


def stationary_test(functional: Functional, name: str) -> TestFunction:
    """Return the test function of the places where a functional is stationary along the branch."""
    if isinstance(functional, PeakToPeak):
        return TestFunction(
            label=Label.PEAK, value=_swing_slope(functional.output), precision=PLACE_PRECISION, name=name
        )
    exact, by_difference = rate_of(cast(Smooth, functional)), slope(functional)

    def value(solution: Solution) -> float:
        problem = solution.problem
        known = hasattr(functional, "linearise") and hasattr(problem.system, "output_gradient")
        return exact(solution) if known and problem.wider is None else by_difference(solution)

    return TestFunction(label=Label.PEAK, value=value, precision=PLACE_PRECISION, name=name)


def _swing_slope(output: str) -> Callable[[Solution], float]:
    """Return the derivative of the peak to peak of an output in arclength."""

    def value(solution: Solution) -> float:
        names = [known.name for known in solution.problem.full.outputs]
        return float(measured(solution).peak_to_peak_slope[names.index(output)])

    return value


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
