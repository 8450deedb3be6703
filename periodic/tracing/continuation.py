"""Pseudo-arclength continuation of periodic orbits in one parameter, as a generator of points.

Each step solves on an arclength constraint, and special points inside it are located on further ones
(`steps/taken.py`). Here its points are collected, and the branch is led on where a pattern of events changes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import Course
from periodic.bifurcations.turningpoint import Found, at_once
from periodic.correction.error import unit_of
from periodic.correction.identity import closes, repeats, same
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver, SpentError
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.results.checkpoint import Checkpoint
from periodic.results.point import Point, describe
from periodic.results.stop import Reason, Stop
from periodic.tracing.ends import ending
from periodic.tracing.ends.retraced import retraced
from periodic.tracing.eventsfrommotion import reread
from periodic.tracing.start import Start
from periodic.tracing.state import State
from periodic.tracing.steps.patternchange import Reached, crossed
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.steps.taken import NEARLY, Refused, Step, Steps
from periodic.tracing.steps.watchedswings import WatchedSwings
from periodic.tracing.watch import Watch


class RepeatsError(ValueError):
    """The orbit of a guess of several excitation periods repeats itself sooner."""


@dataclass
class Continuation:
    """A continuation under way: iterate it for its points, `stop` then says why it ended.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    start : Orbit
        The guess of the first orbit, in the discretisation's representation.
    sign : int
        The direction of its first step: 1 or -1 times the parameter.
    control : ArclengthControl
        Step control.
    watch : Watch
        What is watched.
    user : sequence of float
        Values of the parameter that get a point (UZ).
    search : bool
        Whether a first orbit that Newton does not find may be approached from elsewhere.
    nested : bool
        Whether it is followed from within another one: it follows none itself, in the places of joints.
    stop : Stop, optional
        Why it ended; None while it is under way.
    collected : list of Point
        Its points so far.
    state : State, optional
        Where it stands after the last completed step; None before the first orbit is found.
    ended : Checkpoint, optional
        Where the interrupted run that it resumes stood.
    """

    solver: Solver = field(repr=False)
    start: Orbit
    sign: int
    control: ArclengthControl = field(default_factory=ArclengthControl, repr=False)
    watch: Watch = field(default_factory=Watch, repr=False)
    user: Sequence[float] = field(default=(), repr=False)
    search: bool = field(default=True, repr=False)
    nested: bool = field(default=False, repr=False)
    stop: Stop | None = None
    collected: list[Point] = field(default_factory=list, repr=False)
    state: State | None = field(default=None, repr=False)
    ended: Checkpoint | None = field(default=None, repr=False)
    _running: Iterator[Point] | None = field(default=None, init=False, repr=False)
    _since_remesh: int = field(default=0, init=False, repr=False)
    _count: dict[str, int] = field(default_factory=dict, init=False, repr=False)

    def __iter__(self) -> Continuation:
        return self

    def __next__(self) -> Point:
        """Return the next point; `stop` says why there is none.

        After an interrupt it goes on from the last completed step.
        """
        if self._running is None:
            self._running = self._points()
        try:
            point = next(self._running)
            if self.watch.progress is not None:
                self.watch.progress(point)
        except BaseException:
            self._running = None
            raise
        return point

    def _points(self) -> Iterator[Point]:
        """Yield points, first towards `sign` times the parameter, until `stop` is set."""
        if self.stop is not None and not self.stop.reason.resumable:
            return
        try:
            yield from self._begun() if self.state is None else self._again(self.state)
        except SpentError as spent:
            self.cut(Stop.max_newton(self.solver.work.most, str(spent)))

    @property
    def kept(self) -> int:
        """How many of its points belong to steps that were completed."""
        return len(self.collected) if self.state is None else self.state.kept

    def cut(self, stop: Stop) -> None:
        """End the run, without the points of a step that was not completed.

        Parameters
        ----------
        stop : Stop
            Why.
        """
        del self.collected[self.kept :]
        self.stop = stop

    def _begun(self) -> Iterator[Point]:
        """Yield points from the first orbit on."""
        solver, found = self.solver, Start(self.solver, self._follow, self.search)
        base = found.found(self.start, float(self.sign))
        if not base.ok:
            beyond = found.shortfall
            self.stop = (
                Stop(Reason.INACCURATE, beyond)
                if beyond
                else Stop(Reason.NO_START, found.why_not(base.outcome, self.start.parameter))
            )
            return
        if base.error.motion > solver.tolerance.orbit:
            self.stop = Stop(Reason.INACCURATE, base.refinement.shortfall)
            return
        if repeats(solver, base):
            raise RepeatsError(
                f"guess takes {base.orbit.periods} excitation periods, but its orbit repeats itself sooner; "
                f"it must be sampled over as many as it takes"
            )
        self.watch.check(solver.problem.full, base.orbit)
        yield self._emitted(base, Label.END)
        if base.value in self.user:
            yield self._emitted(base, Label.USER)
        ds, least = self.control.ds, self.control.ds_min
        self.state = State(base, base, self.sign, ds, 0, 0, False, {}, len(self.collected), least)
        yield from self._onward(base)

    def _again(self, state: State) -> Iterator[Point]:
        """Yield the points that follow the last completed step."""
        self.stop = None
        del self.collected[state.kept :]
        self._since_remesh, self._count = state.since_remesh, dict(state.met)
        yield from self._onward(self._prepared(state.last) if state.steps else state.last)

    def resumed(self, points: list[Point], checkpoint: Checkpoint) -> Iterator[Point]:
        """Yield the points that follow those of an interrupted run with the same start.

        Parameters
        ----------
        points : list of Point
            The points of that run.
        checkpoint : Checkpoint
            Where it stood.

        Yields
        ------
        Point
            Those that follow.
        """
        c, last = checkpoint, self.solver.problem.restrict(points[-1].orbit)
        self.stop, self.collected = None, points
        try:
            begun = Start(self.solver, self._follow, self.search).found(self.start, float(c.sign))
            again = self.solver.on(last, self.solver.constraint(last, c.tangent, 0.0))
        except SpentError:
            self.cut(Stop.max_newton(self.solver.work.most))
            return
        for found in (begun, again):
            if not found.ok:
                self.stop = Stop(Reason.NO_START, found.outcome.value)
                return
        # Newton has changed the orbit by rounding: the one kept is put back, so that the same points follow.
        correction = replace(again.correction, orbit=last, fundamental=c.fundamental)
        again = replace(again, correction=correction, tangent=c.tangent)
        least = min(self.control.ds_min, NEARLY * c.ds)
        self.state = State(
            begun, again, c.sign, c.ds, c.steps, c.since_remesh, c.left, c.met, len(points), least, c.course
        )
        yield from self

    @property
    def checkpoint(self) -> Checkpoint | None:
        """The data from which the run can go on after the last completed step."""
        s = self.state
        if s is None:
            return self.ended
        done = self.stop is not None and not self.stop.reason.resumable
        numbers = (s.ds, s.steps, s.since_remesh, s.left, s.met, done, s.course)
        return Checkpoint(s.sign, s.last.tangent, s.last.correction.fundamental, *numbers)

    def _follow(self, solver: Solver, start: Orbit, sign: int, most: int | None) -> tuple[Orbit | None, Stop]:
        """Follow a branch in so many steps at most; return its last orbit and why it ends."""
        control = self.control if most is None else replace(self.control, max_points=most)
        solver = replace(solver, problem=replace(solver.problem, wider=None))
        run = Continuation(solver, start, sign, control, search=False, nested=True)
        points = list(run)
        assert run.stop is not None
        return (points[-1].orbit if points else None), run.stop

    def _onward(self, base: Solution) -> Iterator[Point]:
        """Take steps from a base, which is the last solution on a mesh for the next one."""
        assert self.state is not None
        while self.state.steps + 1 < self.control.max_points:
            behind = self.collected
            step = self._steps.take(self.state, base, behind, worded=True)
            if isinstance(step, Refused) and (eased := self._steps.eased(base)) is not None:
                step = self._steps.take(self.state, eased, behind, worded=True)
            if isinstance(step, Refused) and self._reread(self.state.last):
                yield self.collected[-1]
                if self.stop is not None:
                    return
                base = self._prepared(self.state.last)
                continue
            if isinstance(step, Refused) and step.unread:
                step = self._steps.take(self.state, base, behind, worded=False)
            if isinstance(step, Refused):
                self.stop = step.stop
                yield self._emitted(base, Label.FAILED)
                return
            for special in step.special:
                yield from self._met(special)
                if self.stop is not None:
                    return
            self._completed(step)
            if self.stop is None:
                self.stop = self._ended(step.end)
                if self.stop is not None:
                    self.collected[-1] = replace(self.collected[-1], label=Label.END)
            yield self.collected[-1]
            if self.stop is None and step.change is not None:
                yield from self._crossed(step.change, step.wanted)
            if self.stop is not None:
                return
            base = self._prepared(self.state.last)
        self.stop = Stop.after(Reason.MAX_POINTS, self.control.max_points)

    def _ended(self, new: Solution) -> Stop | None:
        """Why the branch ends at its last point, if it does."""
        points = self.collected
        return ending.reached(self.solver.problem, points) or retraced(self.solver, points, new)

    def _met(self, special: Found) -> Iterator[Point]:
        """Yield a special point, and set `stop` where the branch ends there."""
        assert self.state is not None
        state, label, own = self.state, special.label, bool(special.name)
        if label is Label.USER and not own:
            if state.left and closes(self.solver, state.begun, special.solution):
                self.stop = Stop.after(Reason.CLOSED, state.steps + 1)
                label = Label.END
            elif special.solution.value not in self.user:
                return
        if label is Label.END and self.stop is None:
            bounds = self.solver.problem.low, self.solver.problem.high
            self.stop = (
                Stop(Reason.BOUND, special.name)
                if own
                else Stop.bound(bounds, special.solution.value, state.begun.value)
            )
        name = special.name if label in (Label.USER, Label.PEAK) and own else label.value
        if special.shrunk:
            self.stop = Stop.after(Reason.EQUILIBRIUM, state.steps + 1)
        self._counted(name)
        yield self._emitted(special.solution, label, special.name if own else "", special.within)

    def _counted(self, name: str) -> None:
        """Count a label or event, and set `stop` where the branch shall end at it."""
        self._count[name] = self._count.get(name, 0) + 1
        if self.stop is None and self._count[name] == self.watch.stop.get(name):
            self.stop = Stop.asked(name, self._count[name])

    def _emitted(self, solution: Solution, label: Label, event: str = "", within: float = 0.0) -> Point:
        problem = self.solver.problem
        columns = self.watch.measured(problem.full, problem.expand(solution.orbit))
        point = describe(solution, label, event, columns)
        error = max(point.error.parameter, within / unit_of(solution.value, problem.scale))
        point = replace(point, error=replace(point.error, parameter=error))
        self.collected.append(point)
        return point

    def _crossed(self, at: Reached, wanted: float) -> Iterator[Point]:
        """Yield the orbit beyond a change of pattern, from which the branch goes on.

        wanted: the intended length of the step that met the change. After a change without grazing the next
        step may be as long.
        """
        assert self.state is not None
        found = crossed(self.solver, at)
        labels = () if found is None else found.labels
        if labels and found is not None and not (found.grazes or at.change.grazes or at.change.final):
            found = None  # nearer to the change it shows whether they lie at it, or before or after it
        if found is not None:
            at_grazing = found.solution if found.grazes else at.end
            named = [Found(label, 0.0, at_grazing, within=found.within) for label in labels]
            for special in [] if found.grazes else named:
                yield from self._met(special)
            self._emitted(found.solution, Label.GRAZING if found.grazes else Label.NONE)
            if found.grazes:
                self._counted(Label.GRAZING)
            ds = self.control.ds if found.grazes or at.change.grazes else max(found.distance, wanted)
            kept, last = len(self.collected), found.solution
            least = min(self.control.ds_min, NEARLY * ds)
            self.state = replace(self.state, last=last, ds=ds, kept=kept, least=least, course=Course())
            yield self.collected[-1]
            for special in named if found.grazes else []:
                yield from self._met(special)
        elif at.change.last:
            self.stop = Stop(Reason.SMALL_STEP, f"{at.change.name}, beyond which the motion is another one")
        elif (at.change.strict or (at.change.final and not at.change.nearer)) and self._reread(
            at.end, other=True
        ):
            yield self.collected[-1]
        elif at.change.strict or (at.change.final and codim2.picked(self.solver.problem) is not None):
            self.stop = Stop(Reason.SMALL_STEP, f"{at.change.name}, and no orbit was found beyond it")
        else:
            self.state = replace(self.state, ds=max(self.state.ds, wanted))

    def _reread(self, base: Solution, other: bool = False) -> bool:
        """Go on beyond a change without a rewrite, to an orbit whose word is read from its motion, if any.

        other: whether it must be another word.
        """
        assert self.state is not None
        follow = None if self.nested else self._follow
        found = reread(self.solver, base, self.control, follow, other)
        if found is None:
            return False
        bounds, value = (self.solver.problem.low, self.solver.problem.high), found.solution.value
        self.stop = None
        for label in at_once(base, found.solution):
            self._counted(label.value)
            self._emitted(found.solution, label)
        ends = value in bounds  # it is sought no farther off
        self._emitted(found.solution, Label.END if ends else Label.NONE)
        if ends and self.stop is None:
            self.stop = Stop.bound(bounds, value, self.state.begun.value)
        ds = min(max(found.distance, self.control.ds_min), self.control.ds)
        kept, last = len(self.collected), found.solution
        self.state = replace(
            self.state, last=last, ds=ds, kept=kept, steps=self.state.steps + 1, course=Course()
        )
        return True

    def _completed(self, step: Step) -> None:
        """Keep a step: its end becomes the last solution."""
        assert self.state is not None
        new = step.end
        self._emitted(new, step.label)
        if step.label:
            self._counted(step.label)
        self.state = replace(
            self.state,
            last=new,
            ds=step.further,
            least=min(self.control.ds_min, max(self.state.least, NEARLY * step.further)),
            steps=self.state.steps + 1,
            since_remesh=self._since_remesh,
            left=self.state.left or not same(self.solver, self.state.begun, new),
            met=dict(self._count),
            kept=len(self.collected),
            course=step.course,
        )

    def _prepared(self, new: Solution) -> Solution:
        """The last solution on a mesh for the next step."""
        self._since_remesh += 1
        if self.collected[-1].label is Label.GRAZING:  # on another mesh it may be past the grazing
            return new
        better = self._steps.prepared(new, self._since_remesh >= self.control.remesh_every)
        if better is not new:
            self._since_remesh = 0
        return better

    @cached_property
    def _steps(self) -> Steps:
        watch, solver = self.watch, self.solver
        tests = {} if self.nested else watch.swings(solver.problem)
        least = {q.name: LEAST_SPAN * q.scale for q in solver.problem.full.outputs}
        swings = WatchedSwings(tests, solver.tolerance.orbit, least)
        return Steps(solver, self.control, watch.tests(), self.user, swings)
