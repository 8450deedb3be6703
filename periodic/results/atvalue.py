"""The points of a branch at a value of its parameter, between those that it has."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

from periodic.bifurcations.label import Label
from periodic.checks import number
from periodic.orbit.orbit import Orbit
from periodic.results.point import Point
from periodic.results.stop import Reason, Stop


class TracedLike(Protocol):
    """What is used of a branch."""

    @property
    def parameter(self) -> str: ...
    @property
    def points(self) -> Sequence[Point]: ...
    @property
    def stop(self) -> Stop: ...


class Onwards(Protocol):
    """Traces a branch from an orbit at one value of its parameter to another value."""

    def __call__(self, bounds: tuple[float, float], *, start: float, guess: Orbit) -> TracedLike:
        """Return the way from bounds[0], the start, to bounds[1]."""
        ...


def points_at_value(branch: TracedLike, onwards: Onwards, value: float) -> tuple[Point, ...]:
    """Return the points of a branch at a value of its parameter, one for each time that it passes it.

    Parameters
    ----------
    branch : Branch
        The branch.
    onwards : callable
        Traces from the nearer of two points to the value between them.
    value : float
        The parameter (SI).

    Returns
    -------
    tuple of Point
        In order along the branch.

    Raises
    ------
    ValueError
        For a value that the branch does not pass.
    ArithmeticError
        Where the value is not reached from the points beside it.
    """
    wanted = number("value", value)
    if not branch.points:
        raise ValueError(f"branch has no points; it ended with: {branch.stop}")
    values = [point.parameter for point in branch.points]
    low, high = min(values), max(values)
    if not low <= wanted <= high:
        raise ValueError(f"value is {wanted:g}; the branch has {branch.parameter} from {low:g} to {high:g}")
    beside = itertools.pairwise([*branch.points, branch.points[-1]])
    each = (_between(onwards, pair, wanted) for pair in beside)
    return tuple(point for point in each if point is not None)


def _between(onwards: Onwards, pair: tuple[Point, Point], wanted: float) -> Point | None:
    """The point at a value from the first of two points up to, but without, the second, if there is one.

    Of several points there, as a special one at a grazing, the last is taken.
    """
    here, there = pair
    if here.parameter == wanted and (there is here or there.parameter != wanted):
        return here
    if (here.parameter - wanted) * (there.parameter - wanted) >= 0:
        return None
    for near in sorted(pair, key=lambda point: abs(point.parameter - wanted)):
        way = onwards((near.parameter, wanted), start=near.parameter, guess=near.orbit)
        if way.points and way.points[-1].parameter == wanted and way.stop.reason is Reason.BOUND:
            return replace(way.points[-1], label=Label.NONE)
    raise ArithmeticError(
        f"{way.parameter} = {wanted:g} was not reached from the points at {here.parameter:g} and "
        f"{there.parameter:g}: {way.stop}"
    )
