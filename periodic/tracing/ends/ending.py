"""Ends of branches on which the parameter stands still: arclength steps get no further."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from periodic.bifurcations.fold import LEAST_SLOPE
from periodic.correction.problem import Problem
from periodic.results.point import Point
from periodic.results.stop import Reason, Stop
from periodic.system.precision import EPSILON
from periodic.tracing.ends import homoclinic

LEAST_MOTION = 1e2
"""Span of an orbit, in units of rounding of its states, up to which it does not move."""

COLLAPSED_BY = 1e2
"""How many times as large orbits were when the parameter was the same but for rounding."""


def reached(problem: Problem, points: Sequence[Point]) -> Stop | None:
    """Return why a branch ends at its last point, if it does."""
    longest = homoclinic.period(problem, points)
    if longest is not None:
        return Stop.after(Reason.HOMOCLINIC, longest)
    return Stop.after(Reason.VANISHED, points[-1].orbit.span()) if vanished(problem, points) else None


def vanished(problem: Problem, points: Sequence[Point]) -> bool:
    """Whether orbits have shrunk to rounding of their states while the parameter stood still.

    Orbits that only pass through a rest, or stay at rest from there on, do so as the parameter changes.
    """
    last = points[-1]
    span = last.orbit.span()
    if last.orbit.equilibrium or span > LEAST_MOTION * EPSILON * np.abs(last.orbit.nodes).max():
        return False
    for point in reversed(points):
        if abs(point.parameter - last.parameter) > LEAST_SLOPE * problem.scale:
            return False
        if point.orbit.span() > COLLAPSED_BY * span:
            return True
    return False
