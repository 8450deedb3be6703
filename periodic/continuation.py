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

from periodic.closure import Metric, Plane
from periodic.locate import RejectedError, special_points
from periodic.mesh import Mesh
from periodic.newton import Outcome
from periodic.orbit import Orbit
from periodic.point import Label, Point, describe
from periodic.solve import (
    Solved,
    Task,
    at_parameter,
    carried,
    closes,
    is_settled,
    on_plane,
    parameter_direction,
    predict,
    remesh,
    repeats,
    same,
    settle,
)
from periodic.stop import Reason, Stop
from periodic.switching import away

WINDOW = 1 / 60
"""The mesh is made anew where the error estimate falls below this part of the tolerance."""

ADAPT_EVERY = 4
"""... and every so many steps."""

MESHES = 3
"""How many new meshes are tried for one step."""

BENT = 0.1
"""Largest distance of a step's end from the arc that its two tangents make, as a part of the step."""

NOISE = 10.0
"""What the orbits' own errors may add to that distance, in tolerances."""

ELSEWHERE = (1.5, 2.0, 3.0, 0.5, 0.25)
"""Where a branch to the first orbit is begun if Newton does not find it, in units of its parameter."""


NEARLY = 1e-2
"""How near to where the method's reach ends a branch is followed, in first steps."""

LOOSE = 1e-2
"""Tolerance of the way to a first orbit that is beyond the method's reach."""


class BeyondError(RejectedError):
    """A step to an orbit that the method's finest mesh does not resolve."""


@dataclass
class Run:
    """A continuation under way: where it stands and why it stopped.

    `search` allows a first orbit that Newton does not find to be approached from elsewhere.
    """

    task: Task
    bounds: tuple[float, float]
    user: Sequence[float] = ()
    search: bool = True
    stop: Stop | None = None
    _since_remesh: int = field(default=0, repr=False)
    _shortfall: str = field(default="", repr=False)

    def points(self, start: Orbit, sign: int) -> Iterator[Point]:
        """Yield points from a start orbit, first towards `sign` times the parameter, until `stop` is set."""
        task, step = self.task, self.task.settings.step
        base = self._first(start, float(sign))
        if isinstance(base, Outcome):
            self.stop = Stop.no_start(self._shortfall or base.value)
            return
        if base.error.orbit > task.settings.mesh.tolerance:
            self.stop = Stop.inaccurate(task.method.shortfall(task, base))
            return
        if repeats(task, base):
            raise ValueError(
                f"guess takes {base.orbit.periods} excitation periods, but its orbit repeats itself sooner; "
                f"it must be sampled over as many as it takes"
            )
        yield describe(task, base, Label.END)
        if _value(task, base) in self.user:
            yield describe(task, base, Label.USER)
        ds, count, since = step.ds, 1, _value(task, base)
        begun, left, sought = base, False, self._sought(since)
        while count < step.max_points:
            try:
                base, new = self._step(base, ds)
                specials = special_points(task, base, new, ds, self.bounds, sought, since)
            except RejectedError as rejected:
                ds /= 2
                beyond = isinstance(rejected, BeyondError)
                if ds < (max(step.ds_min, NEARLY * step.ds) if beyond else step.ds_min):
                    self.stop = Stop.inaccurate(str(rejected)) if beyond else Stop.small_step(str(rejected))
                    yield describe(task, base, Label.FAILED)
                    return
                continue
            for special in specials:
                if left and special.label is Label.USER and closes(task, begun, special.solved):
                    self.stop = Stop.closed(count)
                    yield describe(task, special.solved, Label.END)
                    return
                if special.label is not Label.USER or _value(task, special.solved) in self.user:
                    yield describe(task, special.solved, special.label)
            if any(s.label is Label.END for s in specials):
                self.stop = Stop.bound(self.bounds, specials[-1].solved.orbit.parameter[task.index])
                return
            yield describe(task, new, Label.NONE)
            count, since, left = count + 1, _value(task, new), left or not same(task, begun, new)
            ds = self._next_size(ds, new)
            base = self._prepared(new)
        self.stop = Stop.max_points(step.max_points)

    def _sought(self, begin: float) -> Sequence[float]:
        """Values at which the branch gets a point: the user's, and where it may meet its own start."""
        inside = self.bounds[0] < begin < self.bounds[1]
        return sorted({*self.user, begin}) if inside else self.user

    def _first(self, start: Orbit, sign: float) -> Solved | Outcome:
        """Find the first orbit: from the guess itself, else along a branch that comes from elsewhere."""
        task = self.task
        first = settle(task, at_parameter(task, start, sign), fixed=True)
        if isinstance(first, Solved):
            return first
        if not self.search:
            return self._at_turn(start, sign, first)
        for factor in ELSEWHERE:
            orbit = self._approached(start, factor)
            if orbit is not None or self._shortfall:
                return first if orbit is None else settle(task, at_parameter(task, orbit, sign), fixed=True)
        return first

    def _at_turn(self, start: Orbit, sign: float, failed: Outcome) -> Solved | Outcome:
        """Find an orbit at a turn of the branch, where the parameter cannot be held."""
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

    def _next_size(self, ds: float, new: Solved) -> float:
        iterations, step = new.correction.iterations, self.task.settings.step
        factor = 1.5 if iterations <= 4 else 1.2 if iterations <= 5 else 1.0 if iterations <= 6 else 0.7
        return float(np.clip(ds * factor, step.ds_min, step.ds_max))

    def _step(self, base: Solved, ds: float) -> tuple[Solved, Solved]:
        """Take one step; return base and new solution on one mesh. Raises RejectedError.

        The mesh is made anew up to MESHES times, while it changes; where then only the multipliers' error
        still exceeds its bound the point stands, and tells it.
        """
        task, tolerance = self.task, self.task.settings.mesh.tolerance
        for left in reversed(range(MESHES + 1)):
            new = self._attempt(base, ds)
            if new.error.worst <= tolerance:
                return base, new
            mesh = task.method.mesh_for(task, new)
            if left == 0 or mesh.matches(base.orbit.mesh):
                break
            base = self._on_mesh(base, mesh)
        if new.error.orbit > tolerance:
            if task.method.exhausted(task.settings.mesh, new.orbit):
                raise BeyondError(task.method.shortfall(task, new))
            raise RejectedError("the error estimate exceeds the tolerance")
        return base, new

    def _attempt(self, base: Solved, ds: float) -> Solved:
        task = self.task
        guess = predict(task, base.orbit, base.tangent, ds)
        new = on_plane(task, guess, Plane(base.orbit, base.tangent, ds, task.metric, task.index))
        if isinstance(new, Outcome):
            raise RejectedError(new.value)
        if task.metric.dot(new.orbit, base.tangent, new.tangent) < task.settings.step.turn:
            raise RejectedError("the branch turns too sharply for the step")
        floor = NOISE * task.settings.mesh.tolerance * base.orbit.span()
        if self._bend(base, new, ds) > BENT * ds + floor:
            raise RejectedError("the step does not follow its tangents")
        if not task.method.resolved(base.correction, new.correction):
            raise RejectedError("the multipliers turn too far past 1 for the step")
        return new

    def _bend(self, base: Solved, new: Solved, ds: float) -> float:
        """How far the step's end lies from where the mean of the two tangents leads."""
        a, b = base.orbit, new.orbit
        mean = (base.tangent.profile + new.tangent.profile) / 2
        profile = b.state(a.mesh.nodes(a.phases)) - a.nodes - ds * mean
        slope = (base.tangent.parameter + new.tangent.parameter) / 2
        jump = float(b.parameter[self.task.index] - a.parameter[self.task.index]) - ds * slope
        difference = replace(parameter_direction(a, self.task.metric), profile=profile, parameter=jump)
        return float(np.sqrt(self.task.metric.dot(a, difference, difference)))

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
        due = self._since_remesh >= ADAPT_EVERY or not WINDOW * tolerance < new.error.worst < 0.7 * tolerance
        if new.anchored and not due:
            return new
        better = remesh(task, new)
        if isinstance(better, Solved) and not is_settled(task, better):
            better = settle(task, better)
        if isinstance(better, Outcome) or better.error.orbit > tolerance:
            return new
        self._since_remesh = 0
        return better


def _followed(task: Task, bounds: tuple[float, float], start: Orbit, sign: int) -> tuple[Orbit | None, Stop]:
    """Follow a branch; return its last orbit and why it ends."""
    run = Run(task, bounds, search=False)
    points = list(run.points(start, sign))
    assert run.stop is not None
    return (points[-1].orbit if points else None), run.stop


def _value(task: Task, solved: Solved) -> float:
    return float(solved.orbit.parameter[task.index])
