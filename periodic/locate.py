"""Special points inside one continuation step, located on planes between its two ends.

`periodic.events` has the test functions. A branch of doubled orbits turns where it meets the orbits it came
from: the same doubling (PD), seen from the other branch. So does one that leaves a symmetric branch (BP).
User points (UZ) and bounds (EP) are where the parameter takes a given value, looked for on each side of the
turns, where the parameter is monotone.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from periodic import codimension, events
from periodic.closure import Plane
from periodic.events import Test
from periodic.label import Label
from periodic.newton import Outcome
from periodic.orbit import Orbit
from periodic.solve import (
    Solved,
    Task,
    at_parameter,
    cubic,
    difference,
    from_itself,
    on_plane,
    predict,
    settle,
)

MERGED = 0.05
"""What a pitchfork leaves of an orbit's distance from its copies, as a part of that at the step's ends."""


STANDING = 1e-5
"""A branch that begins with so small a part of its later slope begins at a turn."""

SHORTER = 0.9
"""A step that would end at a special point is taken so much shorter: then it lies within the next."""

BESIDE = 1e-3
"""How far from a turn its multipliers are looked at, and what else is not it, as a part of the step."""

ASIDE = (1e-9, -1e-9, 1e-8, -1e-8, 1e-7, -1e-7)
"""Where an orbit stands for a root at which Newton fails, as parts of the stretch: branches cross there."""

ORBITS = 1e1
"""How many times as far that is of orbits, which have errors of their own."""

JUMP = 1e-3
"""What is left of a user's function where it vanishes, as a part of the larger value at its ends."""

TRIALS = 15
"""Most orbits solved for within a step to find a second change of sign."""

LEFT = 0.5
"""A function that is as a parabola predicts, and keeps this part of its least value, does not change sign."""

CONFIRMED = 0.1
"""How well, relatively, the parabola must predict it."""

DISTINCT = 0.1
"""A place to look at lies at least so far on the way from the least value to the next place known."""


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
    """A step that cannot be taken, or inside which a plane could not be solved on; the message says why.

    shorter: the part of it to be tried next; not a half, which from a step that leads to an orbit of no size
    leads there again and again.
    """

    def __init__(self, why: str, shorter: float = 0.6) -> None:
        super().__init__(why)
        self.shorter = shorter


class _NoOrbitError(RejectedError):
    """Newton failed at a distance from a step's base."""

    def __init__(self, why: str, distance: float) -> None:
        super().__init__(why)
        self.distance = distance


@dataclass(frozen=True)
class _Stretch:
    """Orbits on planes at given distances from a step's base, each solved for once.

    The guess is the cubic to the step's end, where there is one, then the base's tangent: orbits solved for
    close to a singular one have lost digits that a guess must not carry on.
    """

    task: Task
    base: Solved
    known: dict[float, Solved]
    end: float | None = None

    def at(self, distance: float) -> Solved:
        """Return the orbit at a distance. Raises RejectedError where there is none."""
        if distance not in self.known:
            self.known[distance] = self._solved(distance)
        return self.known[distance]

    def _solved(self, distance: float) -> Solved:
        task, base = self.task, self.base
        plane = Plane(base.orbit, base.tangent, distance, task.metric, task.index)
        newton, failure = replace(task.settings.newton, close=0.0), Outcome.TOO_MANY
        for guess in self._guesses(distance):
            solved = on_plane(task, guess, plane, newton)
            if isinstance(solved, Solved):
                return solved
            failure = solved
        raise _NoOrbitError(failure.value, distance)

    def _guesses(self, distance: float) -> Iterator[Orbit]:
        if self.end is not None:
            yield cubic(self.task, self.base, self.known[self.end], self.end, distance)
        yield predict(self.task, self.base.orbit, self.base.tangent, distance)


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
    stretch = _Stretch(task, base, {0.0: base, ds: new}, ds)
    from_turn = abs(base.tangent.parameter) < STANDING * abs(new.tangent.parameter)
    turns = [] if from_turn else _where(stretch, new, ds, TURN)
    begin = Found(Label.FOLD if from_turn else Label.NONE, 0.0, base)
    pieces = [begin, *turns, Found(Label.NONE, ds, new)]
    _check_ways(task, pieces)
    found = named = [_named(stretch, turn, new, ds) for turn in turns]
    for test in (*codimension.sought(task, bool(turns) or from_turn), *task.watch.tests()):
        met = _where(stretch, new, ds, test)
        found = found + [point for point in met if not any(_is_one(point, turn, ds) for turn in named)]
    starts = [since, *(_value(task, turn.solved) for turn in turns)]
    for first, begin, end in zip(starts, pieces[:-1], pieces[1:], strict=True):
        last = _value(task, end.solved)
        bound = bounds[1] if last > first else bounds[0]
        for value, label in [*((v, Label.USER) for v in user), (bound, Label.END)]:
            if first < value <= last or last <= value < first:
                found.append(_at_value(stretch, begin, end, value, label))
    found = sorted((f for f in found if f.label is not Label.NONE), key=lambda item: item.distance)
    final = [k for k, item in enumerate(found) if item.label is Label.END or item.shrunk]
    return found[: final[0] + 1] if final else found


def _turns_twice(base: Solved, new: Solved) -> bool:
    """Whether the parameter may turn and turn back within a step.

    Its slope is about a parabola of the way, of which the values at the ends and the mean are known.
    """
    task = base.task
    way = difference(task, base.orbit, new.orbit)
    mean = way.parameter / task.metric.dot(base.orbit, base.tangent, way)
    ends = np.array([base.tangent.parameter, new.tangent.parameter])
    sign = np.sign(ends[0])
    return bool(sign * (1.5 * mean - ends.mean() / 2) < LEFT * np.abs(ends).min())


TURN = replace(events.TURN, twice=_turns_twice)


def _is_one(point: Found, turn: Found, ds: float) -> bool:
    """Whether a special point is the turn of the branch, which has its name already."""
    return point.label is turn.label and abs(point.distance - turn.distance) < BESIDE * ds


def _check_ways(task: Task, pieces: list[Found]) -> None:
    """Reject a step whose end does not lie where the folds within it lead.

    Between folds the parameter goes the way of the tangent; an end on the other side is on another part of
    the branch.
    """
    for begin, end in zip(pieces[:-1], pieces[1:], strict=True):
        way = (end if begin.label is Label.FOLD else begin).solved.tangent.parameter
        change = _value(task, end.solved) - _value(task, begin.solved)
        if change * way < 0 and abs(change) > events.UPRIGHT * task.metric.scale:
            raise RejectedError("the step ends on another part of the branch")


def _value(task: Task, solved: Solved) -> float:
    return float(solved.orbit.parameter[task.index])


def _where(stretch: _Stretch, new: Solved, ds: float, test: Test) -> list[Found]:
    """Locate where a test function changes sign within a step, if it does.

    Raises RejectedError where it vanishes at the step's end, having fallen to it; it is also 0 where it is
    not known.
    """
    base = stretch.base

    def value(solved: Solved) -> float:
        return test.value(stretch.task, solved)

    ends = [value(solved) for solved in (base, new)]
    if ends[0] * ends[1] < 0:
        return _located(stretch, (0.0, ds), ds, test)
    if ends[0] != 0 and ends[1] == 0 and 0 < value(stretch.at(SHORTER * ds)) / ends[0] < LEFT:
        raise RejectedError("the step ends at a special point", SHORTER)
    if ends[0] * ends[1] == 0 or not test.twice(base, new):
        return []
    sign = np.sign(ends[0])
    between = _change(lambda distance: sign * value(stretch.at(distance)), ds, abs(ends[0]), abs(ends[1]))
    if between is None:
        return []
    return [found for span in ((0.0, between), (between, ds)) for found in _located(stretch, span, ds, test)]


def _change(value: Callable[[float], float], ds: float, begin: float, end: float) -> float | None:
    """Return a distance within a step at which a function, positive at both ends, is negative, if any.

    Parabolas lead to its minimum until one has predicted it.
    """
    known = {0.0: begin, ds: end}
    place, expected = ds / (1 + np.sqrt(end / begin)), np.nan  # where a parabola touches zero
    for _ in range(TRIALS):
        least = min(known.values())
        known[place] = found = value(place)
        if found < 0:
            return float(place)
        if abs(found - expected) < CONFIRMED * found and found > LEFT * least:
            return None
        place, expected = _lowest(known)
    return None


def _lowest(known: dict[float, float]) -> tuple[float, float]:
    """Return where to look for a function's minimum and what a parabola through its least values predicts.

    That is the parabola's vertex, or halfway to its neighbour where an end is the least.
    """
    at = sorted(known)
    least = at.index(min(at, key=lambda distance: known[distance]))
    near = at[max(0, min(least - 1, len(at) - 3)) :][:3]
    parabola = np.polynomial.Polynomial.fit(near, [known[distance] for distance in near], 2)
    if 0 < least < len(at) - 1:
        vertex, middle = float(parabola.deriv().roots()[0]), near[1]
        gap = (near[2] if vertex > middle else near[0]) - middle
        place = middle + gap * max((vertex - middle) / gap, DISTINCT)
    else:
        place = (at[least] + at[1 if least == 0 else -2]) / 2
    return place, float(parabola(place))


def _located(stretch: _Stretch, span: tuple[float, float], ds: float, test: Test) -> list[Found]:
    """Locate the zero of a test function between two distances from the base, on an accurate mesh."""
    task, base = stretch.task, stretch.base

    def value(solved: Solved) -> float:
        return test.value(task, solved)

    precision, crossed = test.precision * ds, test is not TURN
    distance, solved = _root(stretch, span, value, precision, aside=crossed)
    turned = task.metric.dot(solved.orbit, base.tangent, solved.tangent)
    if solved.orbit.equilibrium and turned < task.settings.step.turn:
        raise RejectedError("a special point of another branch was met")
    if not test.genuine(task, solved):
        return []
    if test.name and _jumps(value, solved, [stretch.at(end) for end in span]):
        return []
    if not crossed and _shrinks(task, solved, *(stretch.at(end) for end in span)):
        return [Found(test.label, distance, solved)]  # it has no size for its error to be a part of
    refined = _accepted(task, settle(task, solved))
    if refined is solved:
        return [Found(test.label, distance, solved, test.name)]
    around = _Stretch(task, refined, {0.0: refined})
    for reach in (0.05 * ds, 0.5 * ds):
        ends = [around.at(side) for side in (-reach, reach)]
        if value(ends[0]) * value(ends[1]) < 0:
            solved = _root(around, (-reach, reach), value, precision, aside=crossed)[1]
            return [Found(test.label, distance, solved, test.name)]
    raise RejectedError("a special point was not found again on a finer mesh")


def _jumps(value: Callable[[Solved], float], solved: Solved, ends: Sequence[Solved]) -> bool:
    """Whether a function does not vanish where it changes sign between two ends."""
    return abs(value(solved)) > JUMP * max(abs(value(end)) for end in ends)


def _named(stretch: _Stretch, turn: Found, new: Solved, ds: float) -> Found:
    """A turn of the branch by its name.

    PD where its orbit takes fewer periods than those of the step's ends: there it is as good as itself one or
    more excitation periods later. HB where an autonomous orbit has shrunk to an equilibrium: what
    follows are the same orbits half a period later. BP where a multiplier touches 1 without passing it: the
    branch leaves another there, which goes on. On a curve in two parameters it is at most a cusp. Raises
    RejectedError where a multiplier passes 1 and comes back within the step: a fold and a branch point.
    """
    task, base = stretch.task, stretch.base
    if codimension.picked(task) is not None:
        return replace(turn, label=codimension.turn(task, turn.solved, base, new))
    if _shrinks(task, turn.solved, base, new):
        return replace(turn, label=Label.HOPF)
    apart = [from_itself(task, solved) for solved in (turn.solved, base, new)]
    if apart[0] < MERGED * max(apart[1:]) < np.inf:
        return replace(turn, label=Label.DOUBLING)
    tests = (*task.method.passages, *task.method.branching)
    labels = [test.label for test in tests if test.touches(task, turn.solved, base, new)]
    if labels and task.method.branching and task.unit < 2 and _passes(stretch, turn, ds):
        raise RejectedError("the branch turns beside a branch point")
    return replace(turn, label=labels[0]) if labels else turn


def _passes(stretch: _Stretch, turn: Found, ds: float) -> bool:
    """Whether a multiplier passes 1 at a turn, seen from just before it and just after."""
    sides = [stretch.at(turn.distance + side * BESIDE * ds) for side in (-1, 1)]
    before, after = (events.branching(stretch.task, side) for side in sides)
    return before * after < 0


def _shrinks(task: Task, turn: Solved, *ends: Solved) -> bool:
    """Whether autonomous orbits shrink to an equilibrium at a turn of their branch."""
    return task.autonomous and turn.orbit.span() < MERGED * min(end.orbit.span() for end in ends)


def _accepted(task: Task, solved: Solved | Outcome) -> Solved:
    """Return a solution that meets the tolerance; raise RejectedError for any other."""
    if isinstance(solved, Outcome):
        raise RejectedError(solved.value)
    if solved.error.motion > task.settings.mesh.tolerance:
        raise RejectedError("the error estimate of a special point exceeds the tolerance")
    return solved


def _at_value(stretch: _Stretch, begin: Found, end: Found, value: float, label: Label) -> Found:
    """Locate a parameter value in a monotone piece, then solve at exactly that value."""
    task, ends = stretch.task, (begin.distance, end.distance)
    distance, near = _root(stretch, ends, lambda s: _value(task, s) - value, 1e-4 * (ends[1] - ends[0]))
    parameter = near.orbit.parameter.copy()
    parameter[task.index] = value
    guess = replace(near.orbit, parameter=parameter)
    exact = settle(task, at_parameter(task, guess, float(np.sign(near.tangent.parameter)) or 1.0), fixed=True)
    return Found(label, distance, _accepted(task, exact))


def _root(
    stretch: _Stretch,
    ends: tuple[float, float],
    test: Callable[[Solved], float],
    precision: float,
    *,
    aside: bool = False,
) -> tuple[float, Solved]:
    """Return distance and solution where `test` changes sign between two distances from the base.

    `aside` accepts a solution very near to it where there is none at the place itself.
    """

    def value(distance: float) -> float:
        return test(stretch.at(distance))

    at_ends = [value(end) for end in ends]
    if at_ends[0] * at_ends[1] > 0:  # it lies at an end, by less than the orbits' error
        nearest = ends[int(abs(at_ends[1]) < abs(at_ends[0]))]
        return nearest, stretch.at(nearest)
    try:
        root = scipy.optimize.brentq(value, *ends, xtol=precision, rtol=1e-12)
        return root, stretch.at(root)
    except _NoOrbitError as failed:
        if not aside:
            raise
        return _aside(stretch, ends, failed)


def _aside(stretch: _Stretch, ends: tuple[float, float], failed: _NoOrbitError) -> tuple[float, Solved]:
    """Return the solution nearest to where there was none; raise what failed if there is none near."""
    length = (ends[1] - ends[0]) * (1 if stretch.base.orbit.equilibrium else ORBITS)
    for part in ASIDE:
        distance = failed.distance + part * length
        if min(ends) <= distance <= max(ends):
            with contextlib.suppress(_NoOrbitError):
                return distance, stretch.at(distance)
    raise failed
