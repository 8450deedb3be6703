"""Which measurement would tell what data do not: of all motions of their responses the most telling one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from periodic.conditions.functionals import Amplitude, PhaseLag, Smooth
from periodic.conditions.sensitivity import Changes
from periodic.decisions.fitting.measured import SIGMA, Measured
from periodic.decisions.responses.words import called
from periodic.results.branch import Branch
from periodic.results.point import Point
from periodic.system import System

MOST_POINTS = 40
"""Points of each branch that are looked at."""

TELLING = 3.0
"""By how many of its standard deviations a number must change along a direction to tell it."""


def proposal(system: System, tests: Sequence[tuple[Measured, Branch]], direction: Mapping[str, float]) -> str:
    """Return where a direction (SI changes by name) changes a motion most, in words; empty if nowhere.

    Amplitudes and phases of the first harmonic of all outputs are compared, each over a hundredth of its
    largest value along the branch (of phases over a hundredth of a radian), normal to the branch.
    """
    best, said = 0.0, ""
    for test, branch in tests:
        step = max(1, len(branch) // MOST_POINTS)
        points = list(branch)[::step]
        for functional in _functionals(system):
            sigma = _sigma(system, functional, points)
            for point in points:
                change = _change(system, test, point, functional, direction, sigma)
                if change > best:
                    best = change
                    said = f"{called(functional)} near {branch.parameter} = {point.parameter:.4g}"
    return said if best >= TELLING else ""


def _functionals(system: System) -> Iterator[Smooth]:
    states = {state.name for state in system.states}
    for output in system.outputs:
        if output.name in states:
            yield Amplitude(output.name)
            yield PhaseLag(output.name)


def _sigma(system: System, functional: Smooth, points: Sequence[Point]) -> float:
    if getattr(functional, "angle", False):
        return SIGMA
    largest = max(abs(float(functional(system, point.orbit))) for point in points)
    return SIGMA * (largest or 1.0)


def _change(
    system: System,
    test: Measured,
    point: Point,
    functional: Smooth,
    direction: Mapping[str, float],
    sigma: float,
) -> float:
    """How many standard deviations a motion moves away from the branch along a direction."""
    try:
        rates = Changes.of(system, point.orbit, test.response.determined).rates(functional)
    except (ArithmeticError, ValueError):  # at a fold, and where nothing moves, nothing can be told
        return 0.0
    moved = sum(rates[name] * change for name, change in direction.items() if name in rates) / sigma
    steep = rates[test.response.parameter] / sigma * float(np.median(test.place_sigmas))
    found = abs(moved) / np.hypot(1.0, steep)
    return float(found) if np.isfinite(found) else 0.0
