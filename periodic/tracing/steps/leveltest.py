"""Level tests: test functions of where a functional of the orbit crosses a level, or grazes it.

A functional that has a derivative is about a cubic of the way within a step, by its values and its rates
along the branch at both ends: so one that comes to its level and goes back is seen, in a first step too.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import cast

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import PARABOLA_LEFT, TestFunction
from periodic.conditions.functionals import Functional, Smooth, apart
from periodic.correction.outcome import FAILURES
from periodic.correction.predictor import difference
from periodic.correction.solution import Solution
from periodic.linear.unknowns import size_of
from periodic.orbit.orbit import Orbit
from periodic.system import System


def level_test(functional: Functional, level: float, label: Label, name: str) -> TestFunction:
    """Return the test function of a level that is crossed, or grazed within a step."""

    def value(solution: Solution) -> float:
        problem = solution.problem
        found = called(f"event {name}", functional, problem.full, problem.expand(solution.orbit))
        return apart(functional, finite(f"event {name}", found, solution), level)

    def twice(base: Solution, new: Solution) -> bool:
        problem = base.problem
        known = hasattr(functional, "linearise") and hasattr(problem.system, "output_gradient")
        if problem.wider is not None or not known:
            return False
        way = difference(problem, base.orbit, new.orbit)
        length = base.tangent.dot(way, base.orbit, problem.units(base.orbit), size_of(base.orbit))
        ends = base.once(value), new.once(value)
        try:
            return comes_back(ends, (length * base.once(rate), length * new.once(rate)))
        except FAILURES as error:
            place = f"{problem.parameter} = {base.value:.6g} to {new.value:.6g}"
            message = (
                f"{name or label} has no derivative ({error}); grazing in {place} is seen by values alone"
            )
            warnings.warn(message, RuntimeWarning, stacklevel=2)
            return False

    rate = rate_of(cast(Smooth, functional))
    return TestFunction(label=label, value=value, twice=twice, name=name)


def comes_back(ends: tuple[float, float], rates: tuple[float, float]) -> bool:
    """Whether a cubic with these values, of one sign, and slopes at 0 and 1 comes near 0 between."""
    sign = math.copysign(1.0, ends[0])
    (a, b), (slope, last) = (sign * end for end in ends), (sign * rate for rate in rates)
    cubic = np.polynomial.Polynomial([a, slope, 3 * (b - a) - 2 * slope - last, 2 * (a - b) + slope + last])
    flat = np.asarray(cubic.deriv().roots(), dtype=np.complex128)
    inside = flat.real[(flat.imag == 0) & (flat.real > 0) & (flat.real < 1)]
    return bool(cubic(inside).min(initial=np.inf) < PARABOLA_LEFT * min(a, b))


def rate_of(functional: Smooth) -> Callable[[Solution], float]:
    """Return the derivative of a functional along the branch."""

    def rate(solution: Solution) -> float:
        """d functional / d arclength."""
        problem = solution.problem
        row = functional.linearise(problem.system, solution.orbit, problem.free)
        return solution.tangent.rate_of(row)

    return rate


def called(what: str, functional: Functional, system: System, orbit: Orbit) -> object:
    """Return the value of a user's functional. Raises ValueError that names the functional that fails."""
    try:
        return functional(system, orbit)
    except (ArithmeticError, LookupError, TypeError, AttributeError) as error:
        why = f"{type(error).__name__}: {error}"
        raise ValueError(f"{what} failed with {why}; it must give a number for each orbit") from error


def finite(what: str, found: object, solution: Solution) -> float:
    """Return a finite number. Raises ValueError that says where there is none."""
    if not (isinstance(found, int | float | np.number) and math.isfinite(found)):
        place = f"{solution.problem.parameter} = {solution.value:.10g}"
        raise ValueError(f"{what} gave {found!r} at {place}; it must be a finite number")
    return float(found)
