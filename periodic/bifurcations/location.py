"""Special points inside one continuation step, located on arclength constraints between its ends.

User points (UZ) and bounds (EP) are where the parameter takes a given value; they are located between folds,
where the parameter is monotone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from periodic.bifurcations.branchcrossing import crossing
from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.fold import FOLD, VERTICAL, has_fold, moves
from periodic.bifurcations.label import Label
from periodic.bifurcations.ledger import entry, gaps
from periodic.bifurcations.testfunction import PARABOLA_LEFT, Course, TestFunction
from periodic.bifurcations.torus import TORUS
from periodic.bifurcations.turningpoint import Found, is_one, named, shrinks, unstable
from periodic.bifurcations.withinstep import MINIMUM_TRIALS, RejectedError, WithinStep, second_change
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.refinement.adaptation import refined

SHORTER = 0.9
"""Factor by which a step that would end at a special point is shortened: the point lies in the next step."""

JUMP = 1e-3
"""Largest value of a user's function at its zero, as a part of the larger one at the ends: else it jumps."""

ALIGNED = 0.8
"""Least cosine between the tangents of a special equilibrium and of the step's base: else it is on another
branch."""


@dataclass(frozen=True)
class Sought:
    """Points to be located in a step: values of the parameter that get a point (UZ), the user's tests.

    since: the parameter of the last point, up to which values have been located. The base may differ from it
    by its error where it was solved again on a new mesh. course: the test functions' course before the step.
    final: whether the step ends where the pattern changes, and cannot be followed nearer to it.
    """

    values: Sequence[float]
    since: float
    tests: tuple[TestFunction, ...] = ()
    course: Course = field(default_factory=Course)
    final: bool = False


def special_points(solver: Solver, base: Solution, new: Solution, ds: float, sought: Sought) -> list[Found]:
    """Return the special points of a step in order along the branch.

    A bound (EP) ends the list, as does an equilibrium to which orbits shrink (HB). Raises RejectedError.
    """
    within = WithinStep(solver, base, {0.0: base, ds: new}, ds)
    from_fold = abs(base.tangent.parameter) < VERTICAL * abs(new.tangent.parameter)
    folds = [] if from_fold else _folds(within, new, ds, sought)
    begin = Found(Label.FOLD if from_fold else Label.NONE, 0.0, base)
    pieces = [begin, *folds, Found(Label.NONE, ds, new)]
    _check_ways(pieces)
    found = named_folds = [named(within, fold, new, ds) for fold in folds]
    for test in (*codim2.sought(new, bool(folds) or from_fold), *sought.tests):
        met = _where(within, new, ds, test, sought.course)
        found = found + [point for point in met if not any(is_one(point, fold, ds) for fold in named_folds)]
    found = _in_order(found + _at_values(within, pieces, sought))
    return _to_end(_in_order(found + _behind_saddle(within, new, ds, found)))


def with_peaks(found: list[Found], peaks: list[Found]) -> list[Found]:
    """Return special points and peaks in order along the branch, up to one at which it ends."""
    return _to_end(_in_order([*found, *peaks]))


def _to_end(found: list[Found]) -> list[Found]:
    """Those up to the first at which the branch ends."""
    final = [k for k, item in enumerate(found) if item.label is Label.END or item.shrunk]
    return found[: final[0] + 1] if final else found


def _in_order(found: list[Found]) -> list[Found]:
    """Those that have a label, in order along the branch."""
    return sorted((f for f in found if f.label is not Label.NONE), key=lambda item: item.distance)


def _behind_saddle(within: WithinStep, new: Solution, ds: float, found: list[Found]) -> list[Found]:
    """Locate NS that the ledger lacks: a neutral saddle within the step hides them.

    The product of all 1 - mu_i mu_j changes sign at both; at the saddle, real mu_i = 1/mu_j, none passes.
    """
    if unstable(within.base) == unstable(new) or TORUS not in codim2.sought(new, False):
        return []
    named = [entry(point.solution, point.label) for point in found]
    if not gaps([entry(within.base, Label.NONE), *named, entry(new, Label.NONE)], folds=False):
        return []
    between = _between_pair_and_saddle(within, new, ds)
    if between is None:
        return []
    return [point for span in ((0.0, between), (between, ds)) for point in _located(within, span, ds, TORUS)]


def _between_pair_and_saddle(within: WithinStep, new: Solution, ds: float) -> float | None:
    """Return a distance at which the test has another sign than at both ends, where their unstable
    multipliers are not as many."""
    (low, high), count, sign = (0.0, ds), unstable(within.base), within.base.once(TORUS.value)
    if sign * new.once(TORUS.value) <= 0:
        return None
    for _ in range(MINIMUM_TRIALS):
        middle = (low + high) / 2
        solution = within.at(middle)
        if sign * solution.once(TORUS.value) < 0:
            return middle
        low, high = (middle, high) if unstable(solution) == count else (low, middle)
    return None


def _at_values(within: WithinStep, pieces: list[Found], sought: Sought) -> list[Found]:
    """The points at requested values of the parameter, and at a bound."""
    problem, found = within.solver.problem, []
    starts = [sought.since, *(fold.solution.value for fold in pieces[1:-1])]
    for first, begin, end in zip(starts, pieces[:-1], pieces[1:], strict=True):
        last = end.solution.value
        bound = problem.high if last > first else problem.low
        for value, label in [*((v, Label.USER) for v in sought.values), (bound, Label.END)]:
            if first < value <= last or last <= value < first:
                found.append(_at_value(within, begin, end, value, label))
    return found


def _check_ways(pieces: list[Found]) -> None:
    """Reject a step whose end does not lie where the folds within it lead.

    Between folds the parameter goes the way of the tangent; an end on the other side is on another part of
    the branch.
    """
    for begin, end in zip(pieces[:-1], pieces[1:], strict=True):
        way = (end if begin.label is Label.FOLD else begin).solution.tangent.parameter
        change = end.solution.value - begin.solution.value
        if change * way < 0 and moves(begin.solution, end.solution) > 0:
            raise RejectedError("the step ends on another part of the branch")


def _folds(within: WithinStep, new: Solution, ds: float, sought: Sought) -> list[Found]:
    """Locate the folds within a step, those that are more than an error of the parameter.

    One that cannot be told from a change of pattern at the end is put there, or named with points beyond.
    """
    base = within.base
    if FOLD.value(base) * FOLD.value(new) < 0 and not has_fold(base, new, ds):
        return []
    if sought.final and FOLD.value(base) != 0 and FOLD.value(new) == 0:
        named_folds = base.tangent.parameter * new.tangent.parameter < 0
        return [Found(Label.FOLD, ds, new)] if named_folds else []
    return _where(within, new, ds, FOLD, sought.course)


def _where(within: WithinStep, new: Solution, ds: float, test: TestFunction, course: Course) -> list[Found]:
    """Locate where a test function changes sign within a step, if it does.

    Raises RejectedError where it vanishes at the step's end, having fallen to it; it is also 0 where it is
    not known.
    """
    base, value = within.base, test.value
    ends = [base.once(value), new.once(value)]
    if ends[0] * ends[1] < 0:
        return _located(within, (0.0, ds), ds, test)
    if ends[0] != 0 and ends[1] == 0 and 0 < value(within.at(SHORTER * ds)) / ends[0] < PARABOLA_LEFT:
        raise RejectedError("the step ends at a special point", SHORTER)
    if ends[0] * ends[1] == 0 or not (test.twice(base, new) or course.returns(test, base, new, ds)):
        return []
    between = sign_between(within, new, ds, test)
    if between is None:
        return []
    return [found for span in ((0.0, between), (between, ds)) for found in _located(within, span, ds, test)]


class Way(Protocol):
    """Solutions at distances from a base."""

    @property
    def base(self) -> Solution:
        """The solution at distance 0."""

    def at(self, distance: float) -> Solution:
        """Return the solution at a distance. Raises RejectedError where there is none."""


def sign_between(within: Way, new: Solution, ds: float, test: TestFunction) -> float | None:
    """Return a distance at which a test function has another sign than at both ends of a step, if any."""
    local = test.local or test.value
    sign = np.sign(local(within.base))

    def value(distance: float) -> float:
        return float(sign * local(within.at(distance)))

    ends = {0.0: value(0.0), ds: value(ds)}
    vertex = 1 / (1 + np.sqrt(ends[ds] / ends[0]))
    for place, expected in test.dips(within.base, new) or [(vertex, np.nan)]:
        if value(place * ds) > 0 and _confined(test, within.base, new, within.at(place * ds)):
            return None
        if (found := second_change(value, ends, place * ds, expected)) is not None:
            return found
    return None


def _confined(test: TestFunction, base: Solution, *others: Solution) -> bool:
    """Whether a test function is seen not to reach 0, by a base and each of other solutions."""
    return all(test.confined(base, other) for other in others)


def _located(within: WithinStep, span: tuple[float, float], ds: float, test: TestFunction) -> list[Found]:
    """Locate the zero of a test function between two distances from the base, on an accurate mesh."""
    solver, base, crossed = within.solver, within.base, test is not FOLD
    ends = [within.at(end) for end in span]
    distance, solution = _root(within, span, ds, test)
    named_folds = base.tangent.dot(solution.tangent, solution.orbit, solver.problem.units(solution.orbit))
    if solution.orbit.equilibrium and named_folds < ALIGNED:
        raise RejectedError("a special point of another branch was met")
    if not test.genuine(solution) or (test.name and _jumps(test.value, solution, ends)):
        return []
    if not crossed and shrinks(solution, *ends):
        return [Found(test.label, distance, solution)]  # an orbit of no size has no relative error
    return [refined_place(solver, distance, solution, ds, test)]


def refined_place(
    solver: Solver, distance: float, solution: Solution, ds: float, test: TestFunction
) -> Found:
    """Return the point of a test function's zero on a mesh that is right for it.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    distance : float
        Of the zero from the base of its step.
    solution : Solution
        The zero, on the mesh of the step.
    ds : float
        The length of the step.
    test : TestFunction
        The function.

    Returns
    -------
    Found
        The point; the zero is looked for again where the mesh is another one.

    Raises
    ------
    RejectedError
        Where it is not found again, or does not meet the tolerance.
    """
    better = _accepted(solver, refined(solver, solution))
    if better is not solution:
        if not solver.alike(solution, better):
            raise RejectedError("on another mesh a special point has other events")
        solution = _again(solver, better, ds, test)
    return Found(test.label, distance, solution, test.name)


def _root(
    within: WithinStep, span: tuple[float, float], ds: float, test: TestFunction
) -> tuple[float, Solution]:
    """Return distance and solution of the zero of a test function between two distances from the base."""
    ends = [within.at(end).once(test.value) for end in span]
    found = crossing(within, span, test) if test.singular and ends[0] * ends[1] < 0 else None
    if found is None and test.singular and within.base.orbit.equilibrium and ends[0] * ends[1] < 0:
        raise RejectedError("the step leads to another branch, which crosses this one")
    return found or within.root(span, test.placed, test.precision * ds, aside=test is not FOLD)


def _again(solver: Solver, near: Solution, ds: float, test: TestFunction) -> Solution:
    """Locate the zero of a test function about a solution near it."""
    around = WithinStep(solver, near, {0.0: near})
    for reach in (0.05 * ds, 0.5 * ds):
        ends = [test.placed(around.at(side)) for side in (-reach, reach)]
        if ends[0] * ends[1] < 0:
            return _root(around, (-reach, reach), ds, test)[1]
    raise RejectedError("a special point was not found again on a finer mesh")


def _jumps(value: Callable[[Solution], float], solution: Solution, ends: Sequence[Solution]) -> bool:
    """Whether a function does not vanish where it changes sign between two ends."""
    return abs(value(solution)) > JUMP * max(abs(value(end)) for end in ends)


def _accepted(solver: Solver, solution: Solution) -> Solution:
    """Return a solution that meets the tolerance; raise RejectedError for any other."""
    if not solution.ok:
        raise RejectedError(solution.outcome.value)
    if solution.error.motion > solver.tolerance.orbit:
        raise RejectedError("the error estimate of a special point exceeds the tolerance")
    return solution


def _at_value(within: WithinStep, begin: Found, end: Found, value: float, label: Label) -> Found:
    """Locate a parameter value in a monotone piece, then solve at exactly that value."""
    solver, ends = within.solver, (begin.distance, end.distance)
    distance, near = within.root(ends, lambda s: s.value - value, 1e-4 * (ends[1] - ends[0]))
    parameter = near.orbit.parameter.copy()
    parameter[solver.problem.index] = value
    sign = float(np.sign(near.tangent.parameter)) or 1.0
    exact = solver.at_parameter(replace(near.orbit, parameter=parameter), sign)
    return Found(label, distance, _accepted(solver, refined(solver, exact, fixed=True)))
