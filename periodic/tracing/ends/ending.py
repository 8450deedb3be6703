"""Ends of branches on which the parameter stands still: arclength steps get no further."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import takewhile

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

GROWN_BY = 1e2
"""How many times as small they were, where they grow without bound."""

LARGE = 1.0
"""Least span (scaled) from which on they do: a branch that begins at rest grows upright first."""


def reached(problem: Problem, points: Sequence[Point]) -> Stop | None:
    """Return why a branch ends at its last point, if it does."""
    longest = homoclinic.period(problem, points)
    if longest is not None:
        return Stop.after(Reason.HOMOCLINIC, longest)
    span = points[-1].orbit.span()
    if vanished(problem, points):
        return Stop.after(Reason.VANISHED, span)
    return Stop.after(Reason.UNBOUNDED, span) if unbounded(problem, points) else None


def vanished(problem: Problem, points: Sequence[Point]) -> bool:
    """Whether orbits have shrunk to rounding of their states while the parameter stood still.

    Orbits that only pass through a rest, or stay at rest from there on, do so as the parameter changes.
    """
    last = points[-1]
    span = last.orbit.span()
    if last.orbit.equilibrium or span > LEAST_MOTION * EPSILON * np.abs(last.orbit.nodes).max():
        return False
    return any(point.orbit.span() > COLLAPSED_BY * span for point in _alike(problem, points))


def unbounded(problem: Problem, points: Sequence[Point]) -> bool:
    """Whether large orbits have grown on while the parameter stood still.

    So do those of equations that become linear far out, as beyond a stop with a linear spring or backlash, at
    a parameter where a Floquet multiplier of that linear system is 1: sizes are as 1 / distance from it.
    """
    grown = points[-1].orbit.span() / GROWN_BY
    return grown > LARGE and any(LARGE < p.orbit.span() < grown for p in _alike(problem, points))


def _alike(problem: Problem, points: Sequence[Point]) -> Iterator[Point]:
    """Yield the last points of a branch, backwards, those with one parameter but for rounding."""
    still = LEAST_SLOPE * problem.scale
    return takewhile(lambda p: abs(p.parameter - points[-1].parameter) <= still, reversed(points))
