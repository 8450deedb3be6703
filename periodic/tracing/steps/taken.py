"""The step that a branch takes from an orbit: as long as can be, with what lies inside it.

A step that fails a check is shortened and tried again. It is also rejected where not every change of its
stability is accounted for by a special point inside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.label import Label
from periodic.bifurcations.ledger import Entry, Gap, entry, gaps
from periodic.bifurcations.location import Sought, special_points, with_peaks
from periodic.bifurcations.testfunction import Course, TestFunction, margins
from periodic.bifurcations.turningpoint import Found
from periodic.bifurcations.withinstep import RejectedError
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.refinement.adaptation import carried
from periodic.results.point import Point
from periodic.results.stop import Reason, Stop
from periodic.tracing.state import State
from periodic.tracing.steps.foresight import Foresight
from periodic.tracing.steps.overchanges import over_changes
from periodic.tracing.steps.patternchange import Reached, standing
from periodic.tracing.steps.peaklocation import peaks
from periodic.tracing.steps.stepper import BeyondError, Stepper, WordError
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.steps.watchedswings import WatchedSwings

NEARLY = 1e-2
"""Least step, in parts of the first one, with which a branch is followed towards orbits that the method does
not resolve, or towards a change that no special point accounts for."""


@dataclass(frozen=True)
class Step:
    """A step that was taken: its end, the length of the next one, the special points inside it, the course
    of the test functions, the change of pattern at which it ends, if any, and how long it was to be."""

    end: Solution
    further: float
    special: list[Found]
    course: Course
    change: Reached | None = None
    wanted: float = 0.0

    @property
    def label(self) -> Label:
        """The label of its end: GRAZING where a switch grazes its level there."""
        return Label.GRAZING if self.change is not None and self.change.change.grazes else Label.NONE


@dataclass(frozen=True)
class Refused:
    """Why even the shortest step was rejected. unread: a word is violated that the motion may tell."""

    stop: Stop
    unread: bool


@dataclass(frozen=True)
class Steps:
    """How steps are taken, and their ends prepared for the next one.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    control : ArclengthControl
        Step control.
    tests : tuple of TestFunction
        The user's events.
    user : sequence of float
        Values of the parameter that get a point (UZ).
    swings : WatchedSwings
        The peak to peaks that are watched.
    """

    solver: Solver
    control: ArclengthControl
    tests: tuple[TestFunction, ...]
    user: Sequence[float]
    swings: WatchedSwings = field(default_factory=WatchedSwings)

    def take(self, state: State, base: Solution, behind: Sequence[Point], worded: bool) -> Step | Refused:
        """Take one step, as long as can be.

        Parameters
        ----------
        state : State
            Where the branch stands.
        base : Solution
            Its last solution, on a mesh for the step.
        behind : sequence of Point
            The points so far, that solution last.
        worded : bool
            Whether to stop at once at an orbit that violates its word, which may be read from its motion.

        Returns
        -------
        Step or Refused
            Refused where even the shortest step is rejected.
        """
        ds, begin, origin = state.ds, state.begun.value, base
        control = self.control.down_to(state.least)
        sought = Sought(self._values(begin), state.last.value, self.tests, state.course)
        at_grazing = standing(base, self._foresight.change(base, ds)) if state.steps == 0 else None
        if at_grazing is not None:
            return Step(base, ds, [], Course(), at_grazing)
        over = self._over_changes(base, ds, sought, behind[-1])
        if over is not None:
            return over
        longest = np.inf  # the next step is no longer where a longer one has just failed
        while True:
            try:
                tried = self._stepper.step(base, ds)
                base, new, length = tried.base, tried.new, tried.ds
                final = tried.change is not None and tried.change.change.final
                self._check_measures(behind, new, length)
                found = special_points(self.solver, base, new, length, replace(sought, final=final))
                found = self._with_peaks(behind[-1], base, new, length, found)
                self._check_balance(origin, new, found, length)
                further = min(
                    control.next_size(length, new.correction.iterations, tried.bound_ratio), longest
                )
                return Step(new, further, found, self._course(base, length), tried.change, ds)
            except RejectedError as rejected:
                beyond = isinstance(rejected, BeyondError)
                unread = worded and isinstance(rejected, WordError)
                least = max(control.ds_min, NEARLY * control.ds) if beyond else control.ds_min
                failed, longest = ds, ds * rejected.shorter
                ds = longest
                if unread or not ds >= least:
                    ahead = None if unread or beyond else self._just_ahead(base, failed, sought)
                    if ahead is not None:
                        return ahead
                    reason = Reason.INACCURATE if beyond else Reason.SMALL_STEP
                    return Refused(Stop(reason, str(rejected)), unread)

    def _just_ahead(self, base: Solution, failed: float, sought: Sought) -> Step | None:
        """A step to a change a little farther than the shortest one, which failed, if nothing is on the way.

        Newton, which fails so near to the change, could not locate it.
        """
        at = self._stepper.just_ahead(base, failed)
        if at is None or not self._plain(base, at.end, sought):
            return None
        return Step(at.end, self.control.ds, [], self._course(base, at.ds), at, self.control.ds)

    def _check_measures(self, behind: Sequence[Point], new: Solution, ds: float) -> None:
        """Reject a step longer than watched measures allow, unless it is short already."""
        if ds <= NEARLY * self.control.ds:
            return
        ratio = self.swings.ratio(behind, new, ds)
        if ratio > 1:
            raise RejectedError("a measure bends too much for the step", self.control.shorter(ratio))
        if self.swings.turns_twice(behind[-1], new, ds):
            raise RejectedError("a measure has a peak and a trough in the step")

    def _with_peaks(
        self, before: Point, base: Solution, new: Solution, ds: float, found: list[Found]
    ) -> list[Found]:
        """The special points of a step with those at which a watched measure is stationary.

        Where they cannot be located the step is rejected, unless it is short already. One that would be known
        worse than the tolerance and the step's end, as so near a grazing that rounding counts, is left out.
        """
        tests = self.swings.stationary(before, new, ds)
        if not tests or any(point.shrunk for point in found):
            return found
        try:
            turned = any(point.label in (Label.BRANCH, Label.END) for point in found)
            located = peaks(self.solver, base, new, ds, tests, corners=not turned)
        except RejectedError:
            if ds > NEARLY * self.control.ds:
                raise
            return found
        worst = max(self.solver.tolerance.orbit, new.error.worst)
        return with_peaks(found, [peak for peak in located if peak.solution.error.worst <= worst])

    def _over_changes(self, base: Solution, ds: float, sought: Sought, before: Point) -> Step | None:
        """A step in which the word changes and nothing is to be located, if it is one."""
        if sought.tests:
            return None
        over = over_changes(self._foresight, self.control, base, ds, sought.course)
        if over is None or not self._plain(base, over.new, sought):
            return None
        if self.swings.stationary(before, over.new, over.ds):
            return None
        further = self.control.next_size(over.ds, over.new.correction.iterations, over.bound_ratio)
        return Step(over.new, further, [], self._course(base, over.ds))

    def _plain(self, base: Solution, new: Solution, sought: Sought) -> bool:
        """Whether nothing is to be located between two orbits: no event, value, bound, or ledger gap."""
        problem = self.solver.problem
        if not problem.low <= new.value <= problem.high:
            return False
        if sought.tests or any((v - sought.since) * (v - new.value) <= 0 for v in sought.values):
            return False
        return not self.unaccounted([entry(base, Label.NONE), entry(new, Label.NONE)])

    def _course(self, base: Solution, length: float) -> Course:
        """The course of the test functions over a step."""
        return Course(length, margins(base, (*codim2.along(base), *self.tests)))

    def _check_balance(self, base: Solution, new: Solution, found: list[Found], ds: float) -> None:
        """Reject a step of which not every change is accounted for, unless it is short already.

        Changes count from the base as it was, not from the base on the mesh of the step's end.
        """
        ends = any(point.label is Label.END or point.shrunk for point in found)
        if ends or ds <= NEARLY * self.control.ds:
            return
        points = [entry(point.solution, point.label) for point in found]
        unaccounted = self.unaccounted([entry(base, Label.NONE), *points, entry(new, Label.NONE)])
        if unaccounted:
            raise RejectedError(unaccounted[0].why)

    def unaccounted(self, ledger: Sequence[Entry]) -> list[Gap]:
        """Return the changes between points in order along the branch that no labelled point accounts for."""
        return gaps(ledger, folds=codim2.picked(self.solver.problem) is None)

    def _values(self, begin: float) -> Sequence[float]:
        """Values at which the branch gets a point: the user's, and where it may meet its own start."""
        problem = self.solver.problem
        return sorted({*self.user, begin}) if problem.low < begin < problem.high else self.user

    def prepared(self, new: Solution, due: bool) -> Solution:
        """Return the last solution on a mesh for the next step, a new one where `due` or where it helps."""
        better = self._stepper.remeshed(new, due)
        if better is new or self.unaccounted([entry(found, Label.NONE) for found in (new, better)]):
            return new  # on another mesh it may have passed a special point that lies as near
        return better

    def eased(self, base: Solution) -> Solution | None:
        """Return a base on a mesh without the event nodes that its method can do without, if there is one.

        Where elements exchange their ranks, a node of a mild kink is no crossing beyond, and Newton fails.
        """
        choice = self.solver.discretisation.eased(base.orbit)
        found = None if choice is None else carried(self.solver, base, *choice)
        return found if found is not None and found.ok else None

    @cached_property
    def _stepper(self) -> Stepper:
        return Stepper(self.solver, self.control, self._foresight)

    @cached_property
    def _foresight(self) -> Foresight:
        return Foresight(self.solver)
