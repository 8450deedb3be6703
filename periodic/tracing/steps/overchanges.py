"""Steps over changes of the word at which no level is grazed, however many, taken at once.

Where events of different surfaces pass each other, where friction begins to stick as it reverses, or slips
amid a stick, multipliers do not jump and no point is to be located. A step along the tangent leads to an
orbit with the word that it has there, and is judged as any other. Where only the order of events changes the
tangent tells the word, else the motion from a predicted state. Where a level is grazed, or a special point
may have been passed, the step is left to those that stop there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.location import sign_between
from periodic.bifurcations.testfunction import Course, TestFunction
from periodic.bifurcations.withinstep import RejectedError
from periodic.correction.newton import in_order
from periodic.correction.predictor import at_fixed_phases, tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.orbit.orbit import Orbit
from periodic.refinement.adaptation import refined
from periodic.tracing.steps.foresight import Foresight
from periodic.tracing.steps.stepbounds import bound_ratios
from periodic.tracing.steps.stepsize import ArclengthControl

PARTS = (1.0, 0.5, 0.25)
"""Parts of the step that are tried in turn."""


@dataclass(frozen=True)
class Over:
    """The end of a step over changes, its length, and how near the step comes to its bounds."""

    new: Solution
    ds: float
    bound_ratio: float


def over_changes(
    foresight: Foresight, control: ArclengthControl, base: Solution, ds: float, course: Course
) -> Over | None:
    """Return the end of a step in which the word changes without grazing, if there is one.

    Parameters
    ----------
    foresight : Foresight
        What tells changes of pattern ahead, of the solver.
    control : ArclengthControl
        The bounds of a step.
    base : Solution
        Where it begins, with its tangent.
    ds : float
        Its length along the tangent, at the most.
    course : Course
        The test functions' course before it.

    Returns
    -------
    Over or None
        None where the step is to be taken in parts.
    """
    problem = foresight.solver.problem
    if problem.free != (problem.index,) or not base.orbit.mesh.events:
        return None
    way = _Way(foresight, control, base, {0.0: base})
    for part in PARTS:
        if not way.changes(part * ds):
            return None
        over = way.over(part * ds, course)
        if over is not None:
            return over
    return None


@dataclass
class _Way:
    """Orbits ahead of a base at parameters along its tangent, with the words that they have there.

    read: whether a word may be read from a motion, which takes as long as a step: once, and again where it
    has led to an orbit that is only too far off.
    """

    foresight: Foresight
    control: ArclengthControl
    base: Solution
    known: dict[float, Solution]
    read: bool = True

    @property
    def solver(self) -> Solver:
        """The problem and how it is solved."""
        return self.foresight.solver

    def changes(self, distance: float) -> bool:
        """Whether the word changes within a distance, and not by grazing as far as is foreseen."""
        if not in_order(tangent(self.solver.problem, self.base, distance)):
            return True
        change = self.foresight.change(self.base, distance)
        return change is not None and not change.grazes

    def over(self, ds: float, course: Course) -> Over | None:
        """The end of a step of one length, if it is as it should be."""
        for found in self._each(ds, self._words(ds)):
            new = self._accurate(found)
            if new is not None:
                return self._judged(new, ds, course)
        return None

    def _judged(self, new: Solution, ds: float, course: Course) -> Over | None:
        """The step to an orbit, if it keeps the bounds of a step and passes no special point."""
        ratios = list(bound_ratios(self.base, new, ds, self.control, self.solver.tolerance.orbit))
        if not all(ratio.size <= 1 for ratio in ratios):
            self.read = True  # its word may be that of an orbit less far off
            return None
        self.known[ds] = new
        try:
            if any(self._passed(test, new, ds, course) for test in codim2.sought(new, folded=False)):
                return None
        except RejectedError:
            return None
        return Over(new, ds, max(ratio.ahead for ratio in ratios))

    def at(self, distance: float) -> Solution:
        """Return the orbit at a distance, with the word of the base where it can. Raises RejectedError."""
        if distance not in self.known:
            guess = tangent(self.solver.problem, self.base, distance)
            guesses = chain([guess] if in_order(guess) else [], self._words(distance))
            new = next(self._each(distance, guesses), None)
            if new is None:
                raise RejectedError("no orbit was found within a step over changes")
            self.known[distance] = new
        return self.known[distance]

    def _each(self, distance: float, guesses: Iterable[Orbit]) -> Iterator[Solution]:
        """Yield the orbits near guesses from which the branch goes on the same way."""
        newton = self.solver.tolerance.newton
        patient = replace(newton, max_iterations=min(self.control.patience, newton.max_iterations))
        each = (self.solver.at_parameter(guess, self._sign, patient) for guess in guesses)
        return (new for new in each if new.ok and new.tangent.parameter * self._sign > 0)

    @property
    def _sign(self) -> float:
        return float(np.sign(self.base.tangent.parameter))

    def _accurate(self, new: Solution) -> Solution | None:
        """The orbit to the tolerance; None where its word is another one, as if an excursion is too brief."""
        events = Counter(new.orbit.mesh.events)
        if np.isfinite(new.error.motion):
            new = refined(self.solver, new, fixed=True)
        kept = new.ok and Counter(new.orbit.mesh.events) == events
        return new if kept and new.error.curable <= self.solver.tolerance.orbit else None

    def _words(self, distance: float) -> Iterator[Orbit]:
        """Yield guesses of the orbit at a distance with another word than the base's."""
        solver, problem, base = self.solver, self.solver.problem, self.base
        guess, method = tangent(problem, base, distance), solver.discretisation
        if not problem.low < problem.value(guess) < problem.high:
            return
        ahead = at_fixed_phases(problem, base, distance)
        if not in_order(guess):
            found = method.reordered(problem.system, ahead, guess.phases)
            yield from () if found is None else solver.transfers(ahead, *found)
        if self.read:
            self.read = False
            found = method.rewritten(problem.system, ahead)
            yield from () if found is None else solver.transfers(ahead, *found)

    def _passed(self, test: TestFunction, new: Solution, ds: float, course: Course) -> bool:
        """Whether a special point lies between the base and another orbit."""
        ends = self.base.once(test.value), new.once(test.value)
        if ends[0] * ends[1] <= 0:
            return ends[0] * ends[1] < 0
        if not (test.twice(self.base, new) or course.returns(test, self.base, new, ds)):
            return False
        return sign_between(self, new, ds, test) is not None
