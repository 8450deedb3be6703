"""The crossing of two branches: located from both sides, never at the point itself.

There the equations are singular and Newton's iteration fails, or leads to the other branch; but each branch
is smooth. So orbits are solved for on either side, nearer in each round but never at the crossing, and the
one between them follows from the cubic through the nearest two and their tangents.
"""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.testfunction import TestFunction
from periodic.bifurcations.withinstep import RejectedError, WithinStep
from periodic.correction.newton import Correction
from periodic.correction.outcome import FAILURES, Outcome
from periodic.correction.predictor import cubic
from periodic.correction.solution import Between, Solution
from periodic.linear.root import root
from periodic.linear.unknowns import Increment, size_of
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array

BRACKETS = (1 / 8, 1 / 64, 1 / 256, 1 / 512)
"""Distance from the crossing at which orbits are solved for in each round, as parts of the interval."""


def crossing(
    within: WithinStep, ends: tuple[float, float], test: TestFunction
) -> tuple[float, Solution] | None:
    """Return distance and solution where a test function changes sign between two distances from the base.

    None where the branch cannot be followed to it.
    """
    known = {end: within.at(end).once(test.value) for end in ends}
    place, length = _root(known, *ends), ends[1] - ends[0]
    for part in BRACKETS:
        sides = place - part * length, place + part * length
        try:
            known |= {side: within.at(side, nearest=True).once(test.value) for side in sides}
        except RejectedError:
            return None
        if known[sides[0]] * known[sides[1]] >= 0:
            return None
        place = _root(known, *sides)
    try:
        found = _between(within, sides, place, ends)
    except FAILURES:
        return None
    return (place, found) if found.ok else None


def _root(known: dict[float, float], low: float, high: float) -> float:
    """The root between two places of the polynomial through the values at the nearest four."""
    middle, reach = (low + high) / 2, (high - low) / 2
    at = sorted(known, key=lambda place: abs(place - middle))[:4]
    scaled = (np.array(at) - middle) / reach
    powers = np.linalg.solve(np.vander(scaled, increasing=True), [known[place] for place in at])
    return middle + reach * root(np.polynomial.Polynomial(powers), -1.0, 1.0, 0.0)


def _between(
    within: WithinStep, sides: tuple[float, float], place: float, ends: tuple[float, float]
) -> Solution:
    """The cubic between two solutions, without a correction, with the errors at its ends. Raises FAILURES."""
    solver = within.solver
    problem, method = solver.problem, solver.discretisation
    (low, high), (a, b) = sides, (within.at(side) for side in sides)
    orbit = cubic(solver, a, b, high - low, place - low, within.base)
    part = (place - low) / (high - low)
    direction = a.tangent.scaled(1 - part) + b.tangent.scaled(part)
    operator = method.linearise(problem.system, orbit, problem.free)
    small = operator.residual <= solver.tolerance.newton.tolerance
    outcome = Outcome.CONVERGED if small else Outcome.TOO_MANY
    ended = (outcome, 0, 0.0, operator.residual, operator.fundamental, direction, operator)
    found = Correction(orbit, *ended)
    accepted = method.accepted(problem.system, found) if found.ok else found
    beside = max((within.at(end) for end in ends), key=lambda solution: solution.error.worst)
    return Between(problem, method, accepted, _unit(direction, orbit, problem.units(orbit)), beside)


def _unit(direction: Increment, orbit: Orbit, scale: float | Array) -> Increment:
    return direction.scaled(1 / float(np.sqrt(direction.dot(direction, orbit, scale, size_of(orbit)))))
