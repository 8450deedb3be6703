"""The orbits of a branch at a value of its parameter, between the points that it has."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from periodic.bifurcations.label import Label
from periodic.checks import number, shown
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.results.branch import Branch
from periodic.results.point import Point
from periodic.results.stop import Reason
from periodic.system import System
from periodic.tracing.trace import trace
from periodic.tracing.watch import Watch


def points_at(
    system: System,
    branch: Branch,
    value: float,
    *,
    tol: float | Tolerance = Accuracy.STANDARD,
    determined: Mapping[str, Condition] | None = None,
    method: Discretisation | None = None,
) -> tuple[Point, ...]:
    """Return the points of a branch at a value of its parameter, one for each time that it passes it.

    Between two points of the branch it is traced anew from the nearer one to the value.

    Parameters
    ----------
    system : System
        The equations of the branch.
    branch : Branch
        A branch, as from `trace`.
    value : float
        The parameter (SI).
    tol, determined, method
        As in `trace`, and as the branch was traced.

    Returns
    -------
    tuple of Point
        In order along the branch; solved at the value itself, to the tolerance.

    Raises
    ------
    ValueError
        For a value that the branch does not pass.
    ArithmeticError
        Where the value is not reached from the points beside it, as where tol or method is another one.
    """
    if not isinstance(branch, Branch):
        raise ValueError(f"branch is {shown(branch)}; it must be a Branch")
    wanted = number("value", value)
    if not len(branch):
        raise ValueError(f"branch has no points; it ended with: {branch.stop}")
    low, high = branch.values.min(), branch.values.max()
    if not low <= wanted <= high:
        raise ValueError(f"value is {wanted:g}; the branch has {branch.parameter} from {low:g} to {high:g}")
    plain = Watch(peaks={})
    traced = partial(
        trace, system, branch.parameter, tol=tol, determined=determined, method=method, watch=plain
    )
    beside = itertools.pairwise([*branch.points, branch[-1]])
    each = (_between(traced, pair, wanted) for pair in beside)
    return tuple(point for point in each if point is not None)


def _between(traced: Callable[..., Branch], pair: tuple[Point, Point], wanted: float) -> Point | None:
    """The point at a value from the first of two points up to, but without, the second, if there is one.

    Of several points there, as a special one at a grazing, the last is taken.
    """
    here, there = pair
    if here.parameter == wanted and (there is here or there.parameter != wanted):
        return here
    if (here.parameter - wanted) * (there.parameter - wanted) >= 0:
        return None
    for near in sorted(pair, key=lambda point: abs(point.parameter - wanted)):
        way = traced((near.parameter, wanted), start=near.parameter, guess=near.orbit)
        if len(way) and way[-1].parameter == wanted and way.stop.reason is Reason.BOUND:
            return replace(way[-1], label=Label.NONE)
    raise ArithmeticError(
        f"{way.parameter} = {wanted:g} was not reached from the points at {here.parameter:g} and "
        f"{there.parameter:g}: {way.stop}"
    )
