"""Branches of autonomous orbits that end at a homoclinic or heteroclinic orbit: their periods grow forever.

The nearer the orbits pass to an equilibrium the longer they stay, T ~ -log|p - p*|, so that the parameter
stops changing long before the period does: arclength steps get no further.

References
----------
Kuznetsov, Elements of Applied Bifurcation Theory, 6.2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.fold import LEAST_SLOPE
from periodic.conditions.phase import PhaseCondition
from periodic.correction.problem import Problem
from periodic.results.point import Point

LONGER_PERIOD = 10.0
"""How many times as long orbits have become since the parameter changed by more than its error."""

LEAST_SPEED = 1e-3
"""Largest value of the least speed on such an orbit (peak to peak per rad): a canard is faster."""


def period(problem: Problem, points: Sequence[Point]) -> float | None:
    """Return the period of the branch's last point (s) where periods grow without bound, None elsewhere."""
    at = [k for k, condition in enumerate(problem.conditions) if isinstance(condition, PhaseCondition)]
    if len(at) != 1 or codim2.picked(problem) is not None:
        return None
    omega, last = problem.others[at[0]], points[-1]
    speeds = np.linalg.norm(last.orbit.node_rates, axis=1)
    if speeds.min() > LEAST_SPEED * last.orbit.span():
        return None
    longest = _period(last, omega)
    for point in reversed(points):
        blur = max(p.error.blur(p.parameter, problem.scale) for p in (point, last))
        if abs(point.parameter - last.parameter) > max(blur, LEAST_SLOPE * problem.scale):
            return None
        if longest > LONGER_PERIOD * _period(point, omega):
            return longest
    return None


def _period(point: Point, omega: int) -> float:
    return float(point.orbit.mesh.period / point.orbit.parameter[omega])
