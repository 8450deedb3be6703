"""Pseudo-arclength continuation of periodic orbits in one parameter, as a generator of points.

Each step solves on the plane across the tangent; special points inside it are located on planes between.
A step is rejected where Newton fails, where its end is not where its two tangents lead (a jump to another
branch), where the tangent turns too much, where the multipliers pass a resonance unresolved, where an anchor
is past the end of its excursion, or where the error estimate exceeds the tolerance on a mesh made for the new
orbit.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from periodic import codimension
from periodic.checkpoint import Checkpoint
from periodic.closure import Metric, Plane
from periodic.label import Label
from periodic.locate import Found, RejectedError, special_points
from periodic.mesh import Mesh
from periodic.newton import Outcome, at_fixed_phase
from periodic.orbit import Orbit
from periodic.point import Point, describe
from periodic.solve import (
    Solved,
    Task,
    at_parameter,
    carried,
    closes,
    difference,
    is_settled,
    on_plane,
    predict,
    remesh,
    repeats,
    same,
    settle,
)
from periodic.stop import Reason, Stop
from periodic.switching import away

LARGE = 0.5
"""The mesh is made anew where the error estimate reaches this part of the tolerance."""

WINDOW = 1 / 20
"""... where it falls below this part, and a mesh of SMALLER times as many intervals would do."""

SMALLER = 0.8

ADAPT_EVERY = 10
"""... and every so many steps."""

MESHES = 5
"""How many new meshes are tried for one step."""

BENT = 0.1
"""Largest distance of a step's end from the arc that its two tangents make, as a part of the step."""

NOISE = 10.0
"""What the orbits' own errors may add to that distance, in tolerances."""

PATIENCE = 9
"""Newton iterations that a step may take; one that takes more is too long."""

AIM = 0.8
"""The part of what a step may turn and bend that the next one aims at."""

COLLAPSED = 0.1
"""An orbit that is so much smaller than its guess is not what was guessed."""

ELSEWHERE = (1.5, 2.0, 3.0, 0.5, 0.25)
"""Where a branch to the first orbit is begun if Newton does not find it, in units of its parameter."""


@dataclass(frozen=True)
class State:
    """Where a run stands: its last solution, the first, the next step's size, and what it has counted.

    kept: how many of its points belong to steps that were completed.
    """

    begun: Solved
    last: Solved
    sign: int
    ds: float
    steps: int
    since_remesh: int
    left: bool
    met: dict[str, int]
    kept: int


NEARLY = 1e-2
"""How near to where the method's reach ends a branch is followed, in first steps."""

LOOSE = 1e-2
"""Tolerance of the way to a first orbit that is beyond the method's reach."""


class BeyondError(RejectedError):
    """A step to an orbit that the method's finest mesh does not resolve."""


@dataclass
class Run:
    """A continuation under way: its points, where it stands and why it stopped.

    `search` allows a first orbit that Newton does not find to be approached from elsewhere. `ended` is where
    a run stood that had come to its end before.
    """

    task: Task
    bounds: tuple[float, float]
    user: Sequence[float] = ()
    search: bool = True
    stop: Stop | None = None
    collected: list[Point] = field(default_factory=list, repr=False)
    state: State | None = field(default=None, repr=False)
    ended: Checkpoint | None = field(default=None, repr=False)
    _since_remesh: int = field(default=0, repr=False)
    _count: dict[str, int] = field(default_factory=dict, repr=False)
    _shortfall: str = field(default="", repr=False)

    def points(self, start: Orbit, sign: int) -> Iterator[Point]:
        """Yield points from a start orbit, first towards `sign` times the parameter, until `stop` is set."""
        task = self.task
        base = self._first(start, float(sign))
        if isinstance(base, Outcome):
            beyond = self._shortfall
            self.stop = Stop.inaccurate(beyond) if beyond else Stop.no_start(base.value)
            return
        if base.error.motion > task.settings.mesh.tolerance:
            self.stop = Stop.inaccurate(task.method.shortfall(task, base))
            return
        if repeats(task, base):
            raise ValueError(
                f"guess takes {base.orbit.periods} excitation periods, but its orbit repeats itself sooner; "
                f"it must be sampled over as many as it takes"
            )
        task.watch.checked(task.system, base.orbit)
        yield self._emitted(base, Label.END)
        if _value(task, base) in self.user:
            yield self._emitted(base, Label.USER)
        self.state = State(base, base, sign, task.settings.step.ds, 0, 0, False, {}, len(self.collected))
        yield from self._onward(base)

    def resumed(self, start: Orbit, points: list[Point], checkpoint: Checkpoint) -> Iterator[Point]:
        """Yield the points that follow those of an interrupted run, which began at `start`."""
        task, c = self.task, checkpoint
        self.stop, last = None, points[-1].orbit
        begun = self._first(start, float(c.sign))
        again = on_plane(task, last, Plane(last, c.tangent, 0.0, task.metric, task.index))
        for found in (begun, again):
            if isinstance(found, Outcome):
                self.stop = Stop.no_start(found.value)
                return
        assert isinstance(begun, Solved) and isinstance(again, Solved)
        # Newton has moved it by rounding; what follows shall be just what would have followed.
        correction = replace(again.correction, orbit=last, fundamental=c.fundamental)
        again = replace(again, correction=correction, tangent=c.tangent)
        self.state = State(begun, again, c.sign, c.ds, c.steps, c.since_remesh, c.left, c.met, len(points))
        self._since_remesh, self._count = c.since_remesh, dict(c.met)
        yield from self._onward(self._prepared(again) if c.steps else again)

    @property
    def checkpoint(self) -> Checkpoint | None:
        """What it takes to go on after the last completed step."""
        s = self.state
        if s is None:
            return self.ended
        done = self.stop is not None and not self.stop.reason.resumable
        numbers = (s.ds, s.steps, s.since_remesh, s.left, s.met, done)
        return Checkpoint(s.sign, s.last.tangent, s.last.correction.fundamental, *numbers)

    def _onward(self, base: Solved) -> Iterator[Point]:
        """Take steps from a base, which is the last solution on a mesh for the next one."""
        assert self.state is not None
        while self.state.steps + 1 < self.task.settings.step.max_points:
            taken = self._taken(base)
            if isinstance(taken, Stop):
                self.stop = taken
                yield self._emitted(base, Label.FAILED)
                return
            new, further, specials = taken
            for special in specials:
                yield from self._met(special)
                if self.stop is not None:
                    return
            self._completed(new, further)
            yield self.collected[-1]
            base = self._prepared(new)
        self.stop = Stop.max_points(self.task.settings.step.max_points)

    def _taken(self, base: Solved) -> tuple[Solved, float, list[Found]] | Stop:
        """Take one step, as long as can be; return its end, the next one's length, its special points."""
        assert self.state is not None
        ds, since = self.state.ds, _value(self.task, self.state.last)
        sought = self._sought(_value(self.task, self.state.begun))
        longest = np.inf  # the next one is no longer where a longer one has just failed
        while True:
            try:
                base, new, strain = self._step(base, ds)
                found = special_points(self.task, base, new, ds, self.bounds, sought, since)
                return new, min(self._next_size(ds, new, strain), longest), found
            except RejectedError as rejected:
                longest = ds = ds * rejected.shorter
                beyond, step = isinstance(rejected, BeyondError), self.task.settings.step
                if not ds >= (max(step.ds_min, NEARLY * step.ds) if beyond else step.ds_min):
                    return Stop.inaccurate(str(rejected)) if beyond else Stop.small_step(str(rejected))

    def _met(self, special: Found) -> Iterator[Point]:
        """Yield a special point, and set `stop` where the branch ends there."""
        assert self.state is not None
        state, label, own = self.state, special.label, bool(special.name)
        if label is Label.USER and not own:
            if state.left and closes(self.task, state.begun, special.solved):
                self.stop = Stop.closed(state.steps + 1)
                label = Label.END
            elif _value(self.task, special.solved) not in self.user:
                return
        if label is Label.END and self.stop is None:
            value = _value(self.task, special.solved)
            self.stop = Stop.limit(special.name) if own else Stop.bound(self.bounds, value)
        name = special.name if label is Label.USER and own else label.value
        if special.shrunk:
            self.stop = Stop.equilibrium(state.steps + 1)
        self._count[name] = self._count.get(name, 0) + 1
        if self.stop is None and self._count[name] == self.task.watch.stop.get(name):
            self.stop = Stop.asked(name, self._count[name])
        yield self._emitted(special.solved, label, special.name if own else "")

    def _emitted(self, solved: Solved, label: Label, event: str = "") -> Point:
        point = describe(self.task, solved, label, event)
        self.collected.append(point)
        return point

    def _completed(self, new: Solved, ds: float) -> None:
        """Keep a step: its end becomes the last solution, from which the next goes ds."""
        assert self.state is not None
        self._emitted(new, Label.NONE)
        self.state = replace(
            self.state,
            last=new,
            ds=ds,
            steps=self.state.steps + 1,
            since_remesh=self._since_remesh,
            left=self.state.left or not same(self.task, self.state.begun, new),
            met=dict(self._count),
            kept=len(self.collected),
        )

    def _sought(self, begin: float) -> Sequence[float]:
        """Values at which the branch gets a point: the user's, and where it may meet its own start."""
        inside = self.bounds[0] < begin < self.bounds[1]
        return sorted({*self.user, begin}) if inside else self.user

    def _first(self, start: Orbit, sign: float) -> Solved | Outcome:
        """Find the first orbit: from the guess itself, else along a branch that comes from elsewhere."""
        task = self.task
        first = settle(task, at_parameter(task, start, sign), fixed=True)
        if isinstance(first, Solved) and not self._collapsed(start, first):
            return first
        if not self.search:
            return self._at_turn(start, sign, first)
        found = self._by_others(start, sign)
        if isinstance(found, Solved):
            return found
        for factor in ELSEWHERE:
            orbit = self._approached(start, factor)
            if orbit is not None or self._shortfall:
                return first if orbit is None else settle(task, at_parameter(task, orbit, sign), fixed=True)
        return first

    def _by_others(self, start: Orbit, sign: float) -> Solved | Outcome:
        """Find the first orbit by that of another scheme: Newton's way from a rest is a matter of luck."""
        task, mesh = self.task, self.task.settings.mesh
        found: Solved | Outcome = Outcome.TOO_MANY
        for scheme in task.method.schemes:
            loosely = replace(mesh, scheme=scheme, tolerance=max(LOOSE, mesh.tolerance))
            other = replace(task, settings=replace(task.settings, mesh=loosely))
            guess = task.method.adopted(task.system, loosely, start, start.parameter)
            found = settle(other, at_parameter(other, guess, sign), fixed=True)
            if isinstance(found, Solved):
                own = task.method.adopted(task.system, mesh, found.orbit, start.parameter)
                return settle(task, at_parameter(task, own, sign), fixed=True)
        return found

    def _collapsed(self, start: Orbit, first: Solved) -> bool:
        """Whether an autonomous orbit shrank to an equilibrium: there are orbits of all sizes, or none."""
        return self.task.autonomous and first.orbit.span() < COLLAPSED * start.span()

    def _at_turn(self, start: Orbit, sign: float, first: Solved | Outcome) -> Solved | Outcome:
        """Find an orbit at a turn of the branch, where the parameter cannot be held."""
        failed = first if isinstance(first, Outcome) else Outcome.COLLAPSED
        try:
            across = away(self.task.system, start, 1, self.task.autonomous).scaled(sign)
        except (FloatingPointError, np.linalg.LinAlgError):
            return failed
        plane = Plane(start, across, 0.0, self.task.metric, self.task.index)
        found = settle(self.task, on_plane(self.task, start, plane))
        return found if isinstance(found, Solved) else failed

    def _approached(self, start: Orbit, factor: float) -> Orbit | None:
        """Trace from `factor` times the wanted parameter to it; None where the branch does not get there."""
        task, wanted = self.task, float(start.parameter[self.task.index])
        parameter = start.parameter.copy()
        parameter[task.index] = far = factor * wanted
        elsewhere = replace(start, parameter=parameter)
        sign = float(np.sign(wanted - far))
        first = settle(task, at_parameter(task, elsewhere, sign), fixed=True)
        if isinstance(first, Outcome) or far == wanted:
            return None
        bounds = (min(wanted, far), max(wanted, far))
        nearer = replace(task, metric=Metric(abs(wanted - far)))
        orbit, stop = _followed(nearer, bounds, first.orbit, int(sign))
        if stop.reason is Reason.INACCURATE and orbit is not None:
            self._shortfall = f"at {orbit.parameter[task.index]:.6g}, on the way there, {stop.detail}"
            mesh = replace(task.settings.mesh, tolerance=max(LOOSE, task.settings.mesh.tolerance))
            loose = replace(nearer, settings=replace(task.settings, mesh=mesh))
            orbit, _ = _followed(loose, bounds, orbit, int(sign))
        return orbit if orbit is not None and orbit.parameter[task.index] == wanted else None

    def _next_size(self, ds: float, new: Solved, strain: float) -> float:
        iterations, step = new.correction.iterations, self.task.settings.step
        factor = 2.0 if iterations <= 3 else 1.5 if iterations <= 4 else 1.2 if iterations <= 5 else 1.0
        factor = min(factor if iterations <= 6 else 0.7, AIM / max(strain, AIM / 2))
        return float(np.clip(ds * _rounded(factor), step.ds_min, step.ds_max))

    def _step(self, base: Solved, ds: float) -> tuple[Solved, Solved, float]:
        """Take one step; return base and new solution on one mesh, and the strain. Raises RejectedError.

        The mesh is made anew up to MESHES times, while it changes; where then only the multipliers' error
        still exceeds its bound the point stands, and tells it.
        """
        task, tolerance = self.task, self.task.settings.mesh.tolerance
        for left in reversed(range(MESHES + 1)):
            new, strain = self._attempt(base, ds)
            if new.error.worst <= tolerance:
                return base, new, strain
            if self._collapsed(base.orbit, new):
                raise RejectedError("the orbit shrinks to nothing in one step")
            mesh = task.method.mesh_for(task, new)
            if left == 0 or mesh.matches(base.orbit.mesh):
                break
            base = self._on_mesh(base, mesh)
        if new.error.motion > tolerance:
            if task.method.exhausted(task.settings.mesh, new.orbit):
                raise BeyondError(task.method.shortfall(task, new))
            raise RejectedError("the error estimate exceeds the tolerance")
        return base, new, strain

    def _attempt(self, base: Solved, ds: float) -> tuple[Solved, float]:
        """Solve a step away; return the solution and the step's strain. Raises RejectedError."""
        task = self.task
        guess = predict(task, base.orbit, base.tangent, ds)
        plane = Plane(base.orbit, base.tangent, ds, task.metric, task.index)
        newton = task.settings.newton
        new = on_plane(
            task, guess, plane, replace(newton, max_iterations=min(PATIENCE, newton.max_iterations))
        )
        if isinstance(new, Outcome):
            raise RejectedError(new.value)
        furthest = 0.0
        for strain, ahead, why in self._strains(base, new, ds):
            if not strain <= 1:
                raise RejectedError(why, _rounded(np.clip(AIM / strain, 0.25, 0.75)))
            furthest = max(furthest, ahead)
        return new, furthest

    def _strains(self, base: Solved, new: Solved, ds: float) -> Iterator[tuple[float, float, str]]:
        """How far a step goes, about linear in its length, how far one as long would go next, and why not
        beyond 1.
        """
        task = self.task
        cosine = task.metric.dot(new.orbit, base.tangent, new.tangent)
        angle = float(np.arccos(np.clip(cosine, -1, 1)) / np.arccos(task.settings.step.turn))
        yield angle, angle, "the branch turns too sharply for the step"
        floor = NOISE * task.settings.mesh.tolerance * base.orbit.span()
        bend = float(np.sqrt(max(self._bend(base, new, ds) - floor, 0.0) / (BENT * ds)))
        yield bend, bend, "the step does not follow its tangents"
        turn = task.method.turned(base.correction, new.correction)
        yield turn.strain, turn.ahead, "the multipliers turn too far past 1 for the step"
        motion = codimension.alignment(task, base, new)
        angle = float(np.arccos(np.clip(motion, -1, 1)) / np.arccos(task.settings.step.turn))
        yield angle, angle, "the critical motion turns too far for the step"

    def _bend(self, base: Solved, new: Solved, ds: float) -> float:
        """How far the step's end lies from where the mean of the two tangents leads."""
        metric, way = self.task.metric, difference(self.task, base.orbit, new.orbit)
        nodes = way.nodes - ds * (base.tangent.nodes + new.tangent.nodes) / 2
        phases = way.phases - ds * (base.tangent.phases + new.tangent.phases) / 2
        parameter = way.parameter - ds * (base.tangent.parameter + new.tangent.parameter) / 2
        bend = replace(way, profile=at_fixed_phase(base.orbit, nodes, phases), parameter=parameter)
        return float(np.sqrt(metric.dot(base.orbit, bend, bend)))

    def _on_mesh(self, base: Solved, mesh: Mesh) -> Solved:
        """Solve the base again on a mesh that suits the new orbit, with the base's own anchors."""
        moved = carried(self.task, base, mesh, base.orbit.phases, base.tangent)
        if isinstance(moved, Outcome):
            raise RejectedError(f"the mesh could not be adapted: {moved.value}")
        return moved

    def _prepared(self, new: Solved) -> Solved:
        """Give the next step its mesh: right anchors, an error estimate inside its window."""
        task = self.task
        tolerance = task.settings.mesh.tolerance
        self._since_remesh += 1
        due = self._since_remesh >= ADAPT_EVERY or new.error.worst >= LARGE * tolerance
        if new.anchored and not due and not self._too_fine(new):
            return new
        better = remesh(task, new)
        if isinstance(better, Solved) and not is_settled(task, better):
            better = settle(task, better)
        if isinstance(better, Outcome) or better.error.motion > tolerance:
            return new
        self._since_remesh = 0
        return better

    def _too_fine(self, new: Solved) -> bool:
        """Whether a far smaller mesh would do."""
        mesh = self.task.settings.mesh
        if new.error.worst >= WINDOW * mesh.tolerance:
            return False
        return self.task.method.mesh_for(self.task, new).ntst <= SMALLER * new.orbit.mesh.ntst


def _followed(task: Task, bounds: tuple[float, float], start: Orbit, sign: int) -> tuple[Orbit | None, Stop]:
    """Follow a branch; return its last orbit and why it ends."""
    run = Run(task, bounds, search=False)
    points = list(run.points(start, sign))
    assert run.stop is not None
    return (points[-1].orbit if points else None), run.stop


def _rounded(factor: float) -> float:
    """A factor in whole hundredths, so that rounding in an orbit does not change the steps that follow."""
    return float(np.floor(100 * factor)) / 100


def _value(task: Task, solved: Solved) -> float:
    return float(solved.orbit.parameter[task.index])
