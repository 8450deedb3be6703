"""Steps in which several events change places, taken at once.

Where events of different surfaces meet and pass each other nothing touches a level, and the branch goes on
without a kink unless both act on one motion. A step along the tangent in which only the order of events
changes leads to an orbit with the word in its new order, and is judged as any other. Where another row of
the table applies, or a special point may have been passed, the step is left to those that stop there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from periodic.bifurcations.location import sign_between
from periodic.bifurcations.testfunction import Course, TestFunction
from periodic.bifurcations.twoparameter import codim2
from periodic.bifurcations.withinstep import RejectedError
from periodic.correction.newton import in_order
from periodic.correction.predictor import at_fixed_phases, tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.orbit.orbit import Orbit
from periodic.refinement.adaptation import refined
from periodic.tracing.steps.stepbounds import bound_ratios
from periodic.tracing.steps.stepsize import ArclengthControl

PARTS = (1.0, 0.5, 0.25)
"""Parts of the step that are tried in turn."""


@dataclass(frozen=True)
class Over:
    """The end of a step over swaps, its length, and how near the step comes to its bounds."""

    new: Solution
    ds: float
    bound_ratio: float


def over_swaps(
    solver: Solver, control: ArclengthControl, base: Solution, ds: float, course: Course
) -> Over | None:
    """Return the end of a step in which events change places and nothing else happens, if there is one.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
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
    if solver.problem.free != (solver.problem.index,) or not base.orbit.mesh.events:
        return None
    way = _Way(solver, control, base)
    return next((over for over in (way.over(part * ds, course) for part in PARTS) if over is not None), None)


@dataclass(frozen=True)
class _Way:
    """Orbits ahead of a base at parameters along its tangent, their events in the order that it has there."""

    solver: Solver
    control: ArclengthControl
    base: Solution
    known: dict[float, Solution] = field(default_factory=dict)

    def over(self, ds: float, course: Course) -> Over | None:
        """The end of a step of one length, if it is as it should be."""
        if not self._swaps(ds):
            return None
        try:
            new = self._accurate(self.at(ds))
            ratios = list(bound_ratios(self.base, new, ds, self.control, self.solver.tolerance.orbit))
            if not all(ratio.size <= 1 for ratio in ratios):
                return None
            if any(self._passed(test, new, ds, course) for test in codim2.sought(new, folded=False)):
                return None
        except RejectedError:
            return None
        return Over(new, ds, max(ratio.ahead for ratio in ratios))

    def at(self, distance: float) -> Solution:
        """Return the orbit at a distance. Raises RejectedError where there is none."""
        if distance not in self.known:
            self.known[distance] = self._solved(distance)
        return self.known[distance]

    def _swaps(self, distance: float) -> bool:
        """Whether events have changed places at a distance."""
        orbit = self.base.orbit
        return bool(
            (orbit.mesh.segment_lengths(orbit.phases + distance * self.base.tangent.phases) <= 0).any()
        )

    def _solved(self, distance: float) -> Solution:
        newton = self.solver.tolerance.newton
        patient = replace(newton, max_iterations=min(self.control.patience, newton.max_iterations))
        guesses = self._guesses(distance)
        each = (self.solver.at_parameter(guess, self._sign, patient) for guess in guesses)
        new = next((new for new in each if new.ok), None)
        if new is None or new.tangent.parameter * self._sign <= 0:
            raise RejectedError("no orbit was found on which only the order of events has changed")
        return new

    @property
    def _sign(self) -> float:
        return float(np.sign(self.base.tangent.parameter))

    def _accurate(self, new: Solution) -> Solution:
        """The orbit to the tolerance. Raises RejectedError where its word is another one."""
        if np.isfinite(new.error.motion):
            new = refined(self.solver, new, fixed=True)
        if not new.ok or not new.error.curable <= self.solver.tolerance.orbit:
            raise RejectedError("the orbit does not meet the tolerance, or violates its word")
        return new

    def _guesses(self, distance: float) -> Iterator[Orbit]:
        """Yield guesses of the orbit at a distance."""
        solver, problem, base = self.solver, self.solver.problem, self.base
        guess = tangent(problem, base, distance)
        if not problem.low < problem.value(guess) < problem.high:
            return
        if in_order(guess):
            yield guess
            return
        ahead = at_fixed_phases(problem, base, distance)
        found = solver.discretisation.reordered(problem.system, ahead, guess.phases)
        if found is not None:
            yield from solver.transfers(ahead, *found)

    def _passed(self, test: TestFunction, new: Solution, ds: float, course: Course) -> bool:
        """Whether a special point lies between the base and another orbit."""
        ends = self.base.once(test.value), new.once(test.value)
        if ends[0] * ends[1] <= 0:
            return ends[0] * ends[1] < 0
        if not (test.twice(self.base, new) or course.returns(test, self.base, new, ds)):
            return False
        return sign_between(self, new, ds, test) is not None
