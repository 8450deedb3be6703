"""Special points inside one continuation step, located on planes between its two ends.

`periodic.events` has the test functions. A branch of doubled orbits turns where it meets the orbits it came
from: the same doubling (PD), seen from the other branch. So does one that leaves a symmetric branch (BP).
User points (UZ) and bounds (EP) are where the parameter takes a given value, looked for on each side of the
turns, where the parameter is monotone.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import optimize

from periodic import codimension, events
from periodic.closure import Plane
from periodic.events import Test
from periodic.label import Label
from periodic.newton import Outcome
from periodic.solve import Solved, Task, at_parameter, from_itself, on_plane, predict, settle

MERGED = 0.05
"""What a pitchfork leaves of an orbit's distance from its copies, as a part of that at the step's ends."""


STANDING = 1e-5
"""A branch that begins with so small a part of its later slope begins at a turn."""

BESIDE = 1e-3
"""How far from a turn its multipliers are looked at, as a part of the step."""

ASIDE = (1e-9, -1e-9, 1e-8, -1e-8, 1e-7, -1e-7)
"""Where an orbit stands for a root at which Newton fails, as parts of the stretch: branches cross there."""

ORBITS = 1e3
"""How many times as far that is of orbits, which have errors of their own."""

JUMP = 1e-3
"""What is left of a user's function where it vanishes, as a part of the larger value at its ends."""

TRIALS = 15
"""Most orbits solved for within a step to find a second change of sign."""


@dataclass(frozen=True)
class Found:
    """A special point at `distance` from the step's base; `name` is the user's of an event or limit."""

    label: Label
    distance: float
    solved: Solved
    name: str = ""

    @property
    def shrunk(self) -> bool:
        """Whether a branch of orbits ends at an equilibrium there."""
        return self.label is Label.HOPF and not self.solved.orbit.equilibrium


class RejectedError(Exception):
    """A step that cannot be taken, or inside which a plane could not be solved on; the message says why."""


class _NoOrbitError(RejectedError):
    """Newton failed at a distance from a step's base."""

    def __init__(self, why: str, distance: float) -> None:
        super().__init__(why)
        self.distance = distance


def special_points(
    task: Task,
    base: Solved,
    new: Solved,
    ds: float,
    bounds: tuple[float, float],
    user: Sequence[float],
    since: float,
) -> list[Found]:
    """Return the special points of a step in order along the branch.

    A bound (EP) ends the list, as does an equilibrium to which orbits shrink (HB). `since` is the parameter
    up to which values have been looked for: that of the last point, from which the base may differ by its
    error where it was solved again on a new mesh. Raises RejectedError.
    """
    from_turn = abs(base.tangent.parameter) < STANDING * abs(new.tangent.parameter)
    turns = [] if from_turn else _where(task, base, new, ds, events.TURN)
    begin = Found(Label.FOLD if from_turn else Label.NONE, 0.0, base)
    pieces = [begin, *turns, Found(Label.NONE, ds, new)]
    _check_ways(task, pieces)
    found = [_named(task, turn, base, new, ds) for turn in turns]
    for test in (*codimension.sought(task, bool(turns) or from_turn), *task.watch.tests()):
        found += _where(task, base, new, ds, test)
    starts = [since, *(_value(task, turn.solved) for turn in turns)]
    for first, begin, end in zip(starts, pieces[:-1], pieces[1:], strict=True):
        last = _value(task, end.solved)
        bound = bounds[1] if last > first else bounds[0]
        for value, label in [*((v, Label.USER) for v in user), (bound, Label.END)]:
            if first < value <= last or last <= value < first:
                found.append(_at_value(task, base, begin, end, value, label))
    found = sorted((f for f in found if f.label is not Label.NONE), key=lambda item: item.distance)
    final = [k for k, item in enumerate(found) if item.label is Label.END or item.shrunk]
    return found[: final[0] + 1] if final else found


def _check_ways(task: Task, pieces: list[Found]) -> None:
    """Reject a step whose end does not lie where the folds within it lead.

    Between folds the parameter goes the way of the tangent; an end on the other side is on another part of
    the branch.
    """
    for begin, end in zip(pieces[:-1], pieces[1:], strict=True):
        way = (end if begin.label is Label.FOLD else begin).solved.tangent.parameter
        if (_value(task, end.solved) - _value(task, begin.solved)) * way < 0:
            raise RejectedError("the step ends on another part of the branch")


def _value(task: Task, solved: Solved) -> float:
    return float(solved.orbit.parameter[task.index])


def _where(task: Task, base: Solved, new: Solved, ds: float, test: Test) -> list[Found]:
    """Locate where a test function changes sign within a step, if it does."""
    ends = [test.value(task, solved) for solved in (base, new)]
    if ends[0] * ends[1] < 0:
        return _located(task, base, (0.0, ds), ds, test)
    if ends[0] * ends[1] == 0 or not test.twice(base, new):
        return []
    between = _change(task, base, ds, lambda solved: np.sign(ends[0]) * test.value(task, solved))
    if between is None:
        return []
    spans = ((0.0, between), (between, ds))
    return [found for span in spans for found in _located(task, base, span, ds, test)]


def _change(task: Task, base: Solved, ds: float, value: Callable[[Solved], float]) -> float | None:
    """Return a distance within a step at which a function, positive at both ends, is negative, if any."""
    found: list[float] = []

    def positive(distance: float) -> float:
        result = value(_at_distance(task, base, distance))
        if result < 0:
            found.append(distance)
            raise StopIteration
        return result

    with contextlib.suppress(StopIteration):
        optimize.minimize_scalar(
            positive, bounds=(0.0, ds), method="bounded", options={"maxiter": TRIALS, "xatol": 0.0}
        )
    return found[0] if found else None


def _located(task: Task, base: Solved, span: tuple[float, float], ds: float, test: Test) -> list[Found]:
    """Locate the zero of a test function between two distances from the base, on an accurate mesh."""

    def value(solved: Solved) -> float:
        return test.value(task, solved)

    precision, crossed = test.precision * ds, test is not events.TURN
    distance, solved = _root(task, base, span, value, precision, aside=crossed)
    turned = task.metric.dot(solved.orbit, base.tangent, solved.tangent)
    if solved.orbit.equilibrium and turned < task.settings.step.turn:
        raise RejectedError("a special point of another branch was met")
    if not test.genuine(task, solved):
        return []
    if test.name and _jumps(value, solved, [_at_distance(task, base, end) for end in span]):
        return []
    if not crossed and _shrinks(task, solved, *(_at_distance(task, base, end) for end in span)):
        return [Found(test.label, distance, solved)]  # it has no size for its error to be a part of
    refined = _accepted(task, settle(task, solved))
    if refined is solved:
        return [Found(test.label, distance, solved, test.name)]
    for reach in (0.05 * ds, 0.5 * ds):
        ends = [_at_distance(task, refined, side) for side in (-reach, reach)]
        if value(ends[0]) * value(ends[1]) < 0:
            solved = _root(task, refined, (-reach, reach), value, precision, aside=crossed)[1]
            return [Found(test.label, distance, solved, test.name)]
    raise RejectedError("a special point was not found again on a finer mesh")


def _jumps(value: Callable[[Solved], float], solved: Solved, ends: Sequence[Solved]) -> bool:
    """Whether a function does not vanish where it changes sign between two ends."""
    return abs(value(solved)) > JUMP * max(abs(value(end)) for end in ends)


def _named(task: Task, turn: Found, base: Solved, new: Solved, ds: float) -> Found:
    """A turn of the branch by its name.

    PD where its orbit takes fewer periods than those of the step's ends: there it is as good as itself one or
    more excitation periods later. HB where an autonomous orbit has shrunk to an equilibrium: what
    follows are the same orbits half a period later. BP where a multiplier touches 1 without passing it: the
    branch leaves another there, which goes on. On a curve in two parameters it is at most a cusp. Raises
    RejectedError where a multiplier passes 1 and comes back within the step: a fold and a branch point.
    """
    if codimension.picked(task) is not None:
        return replace(turn, label=codimension.turn(task, turn.solved, base, new))
    if _shrinks(task, turn.solved, base, new):
        return replace(turn, label=Label.HOPF)
    apart = [from_itself(task, solved) for solved in (turn.solved, base, new)]
    if apart[0] < MERGED * max(apart[1:]) < np.inf:
        return replace(turn, label=Label.DOUBLING)
    tests = (*task.method.passages, *task.method.branching)
    labels = [test.label for test in tests if test.touches(task, turn.solved, base, new)]
    if labels and task.method.branching and task.unit < 2 and _passes(task, turn, base, ds):
        raise RejectedError("the branch turns beside a branch point")
    return replace(turn, label=labels[0]) if labels else turn


def _passes(task: Task, turn: Found, base: Solved, ds: float) -> bool:
    """Whether a multiplier passes 1 at a turn, seen from just before it and just after."""
    sides = [_at_distance(task, base, turn.distance + side * BESIDE * ds) for side in (-1, 1)]
    return events.branching(task, sides[0]) * events.branching(task, sides[1]) < 0


def _shrinks(task: Task, turn: Solved, *ends: Solved) -> bool:
    """Whether autonomous orbits shrink to an equilibrium at a turn of their branch."""
    return task.autonomous and turn.orbit.span() < MERGED * min(end.orbit.span() for end in ends)


def _accepted(task: Task, solved: Solved | Outcome) -> Solved:
    """Return a solution that meets the tolerance; raise RejectedError for any other."""
    if isinstance(solved, Outcome):
        raise RejectedError(solved.value)
    if solved.error.orbit > task.settings.mesh.tolerance:
        raise RejectedError("the error estimate of a special point exceeds the tolerance")
    return solved


def _at_value(task: Task, base: Solved, begin: Found, end: Found, value: float, label: Label) -> Found:
    """Locate a parameter value in a monotone piece, then solve at exactly that value."""
    ends = (begin.distance, end.distance)
    distance, near = _root(task, base, ends, lambda s: _value(task, s) - value, 1e-4 * (ends[1] - ends[0]))
    parameter = near.orbit.parameter.copy()
    parameter[task.index] = value
    guess = replace(near.orbit, parameter=parameter)
    exact = settle(task, at_parameter(task, guess, float(np.sign(near.tangent.parameter)) or 1.0), fixed=True)
    return Found(label, distance, _accepted(task, exact))


def _root(
    task: Task,
    base: Solved,
    ends: tuple[float, float],
    test: Callable[[Solved], float],
    precision: float,
    *,
    aside: bool = False,
) -> tuple[float, Solved]:
    """Return distance and solution where `test` changes sign between two distances from the base.

    `aside` accepts a solution very near to it where there is none at the place itself.
    """
    solutions: dict[float, Solved] = {}

    def value(distance: float) -> float:
        solutions[distance] = _at_distance(task, base, distance)
        return test(solutions[distance])

    at_ends = [value(end) for end in ends]
    if at_ends[0] * at_ends[1] > 0:  # it lies at an end, by less than the orbits' error
        nearest = ends[int(abs(at_ends[1]) < abs(at_ends[0]))]
        return nearest, solutions[nearest]
    try:
        root = optimize.brentq(value, *ends, xtol=precision, rtol=1e-12)
        return root, solutions[root] if root in solutions else _at_distance(task, base, root)
    except _NoOrbitError as failed:
        if not aside:
            raise
        return _aside(task, base, ends, failed)


def _aside(
    task: Task, base: Solved, ends: tuple[float, float], failed: _NoOrbitError
) -> tuple[float, Solved]:
    """Return the solution nearest to where there was none; raise what failed if there is none near."""
    stretch = (ends[1] - ends[0]) * (1 if base.orbit.equilibrium else ORBITS)
    for part in ASIDE:
        distance = failed.distance + part * stretch
        if min(ends) <= distance <= max(ends):
            with contextlib.suppress(_NoOrbitError):
                return distance, _at_distance(task, base, distance)
    raise failed


def _at_distance(task: Task, base: Solved, distance: float) -> Solved:
    guess = predict(task, base.orbit, base.tangent, distance)
    solved = on_plane(task, guess, Plane(base.orbit, base.tangent, distance, task.metric, task.index))
    if isinstance(solved, Outcome):
        raise _NoOrbitError(solved.value, distance)
    return solved
