"""One orbit to a tolerance: Newton, error estimate, new mesh and anchors, until all are right."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np
from scipy import optimize

from periodic import anchors
from periodic.accuracy import LEAST_SPAN, ErrorEstimate
from periodic.anchors import Crossing
from periodic.closure import Condition, Direction, Metric, PhaseCondition, Plane, closures
from periodic.mesh import Mesh
from periodic.methods.protocol import Method
from periodic.newton import Correction, Outcome, moved
from periodic.orbit import FORCED, Orbit
from periodic.scheme import Array
from periodic.settings import Settings
from periodic.system import System
from periodic.watch import Watch

ROUNDS = 8


SHIFTS = 64
"""How many phases are tried for the least distance of two autonomous orbits."""

KEPT = 30.0
"""How far an orbit may move when its mesh is changed, in units of its error estimate or of the tolerance."""


@dataclass
class Work:
    """What has been spent so far: Newton iterations, failed and rejected ones included."""

    iterations: int = 0


@dataclass(frozen=True)
class Task:
    """What is solved: a system, the continuation parameter's index, the metric, the settings, the method.

    `others` are the indices of further free parameters, `conditions` what determines them, one for each;
    `watch` is what else is looked for.
    """

    system: System
    index: int
    metric: Metric
    settings: Settings
    method: Method
    work: Work = field(default_factory=Work)
    others: tuple[int, ...] = ()
    conditions: tuple[Condition, ...] = ()
    watch: Watch = field(default_factory=Watch)

    @property
    def free(self) -> tuple[int, ...]:
        """Indices of all free parameters, the continuation parameter first."""
        return (self.index, *self.others)

    @property
    def unit(self) -> int:
        """How many multipliers of the orbits are 1 whatever the parameters."""
        return max((c.unit for c in self.conditions if isinstance(c, PhaseCondition)), default=0)

    @property
    def autonomous(self) -> bool:
        """Whether the orbits have a multiplier that is 1 whatever the parameters."""
        return self.unit > 0


@dataclass(frozen=True)
class Solved:
    """An orbit with its tangent, its error estimate and the crossings its mesh should be tied to."""

    correction: Correction
    tangent: Direction
    error: ErrorEstimate
    wanted: list[Crossing]

    @property
    def orbit(self) -> Orbit:
        """The orbit itself."""
        return self.correction.orbit

    @property
    def anchored(self) -> bool:
        """Whether the mesh is tied to just the crossings it should be."""
        return anchors.fits(self.wanted, self.orbit)


def parameter_direction(orbit: Orbit, metric: Metric, others: int = 0) -> Direction:
    """The direction in which only the parameter changes; a plane across it fixes the parameter."""
    zero = np.zeros_like(orbit.nodes)
    return Direction(
        zero,
        np.zeros_like(orbit.stages),
        np.zeros_like(orbit.algebraic),
        np.zeros_like(orbit.phases),
        zero,
        metric.scale,
        np.zeros(others),
    )


def on_plane(task: Task, guess: Orbit, plane: Plane) -> Solved | Outcome:
    """Solve on a plane from a guess on the same mesh; the tangent points to the plane's positive side."""
    closing = [*closures(task.conditions, task.others, plane.origin), plane]
    result = task.method.correct(task.system, guess, task.free, closing, task.settings.newton)
    task.work.iterations += result.iterations
    if result.outcome is not Outcome.CONVERGED:
        return result.outcome
    if not task.method.genuine(task.system, result.orbit):
        return Outcome.ANCHORS_CROSSED
    result, tangent = replace(result, unit=task.unit), result.kernel
    assert tangent is not None
    length = np.sqrt(task.metric.dot(result.orbit, tangent, tangent))
    sign = np.sign(task.metric.dot(result.orbit, tangent, plane.direction)) or 1.0
    tangent = tangent.scaled(sign / length)
    origin = Plane(result.orbit, tangent, 0.0, task.metric, task.index)
    error = task.method.estimate(task, result, origin)
    return Solved(result, tangent, error, task.method.wanted(task, result.orbit, error))


def at_parameter(task: Task, guess: Orbit, sign: float) -> Solved | Outcome:
    """Solve with the parameter fixed at the guess's value; the tangent points to `sign` times it."""
    across = parameter_direction(guess, task.metric).scaled(sign)
    solved = on_plane(task, guess, Plane(guess, across, 0.0, task.metric, task.index))
    if isinstance(solved, Outcome):
        return solved
    parameter = solved.orbit.parameter.copy()
    parameter[task.index] = guess.parameter[task.index]  # Newton leaves it within rounding
    exact = replace(solved.orbit, parameter=parameter)
    return replace(solved, correction=replace(solved.correction, orbit=exact))


def settle(task: Task, solved: Solved | Outcome, *, fixed: bool = False) -> Solved | Outcome:
    """Change mesh and anchors until both are right for a solution and solve again on each new mesh.

    `fixed` keeps the parameter; else the solution stays on the plane across its tangent. Returns the
    solution on the last mesh; its error estimate may still exceed the tolerance.
    """
    for _ in range(ROUNDS):
        if isinstance(solved, Outcome) or is_settled(task, solved):
            return solved
        new = remesh(task, solved, fixed=fixed)
        if isinstance(new, Outcome):
            return solved if solved.error.worst <= task.settings.mesh.tolerance else new
        solved = new
    return solved


def is_settled(task: Task, solved: Solved) -> bool:
    """Whether error estimate and anchors are as they should be, or cannot be bettered."""
    mesh = task.settings.mesh
    exhausted = task.method.exhausted(mesh, solved.orbit)
    return solved.anchored and (solved.error.worst <= mesh.tolerance or exhausted)


def remesh(task: Task, solved: Solved, *, fixed: bool = False) -> Solved | Outcome:
    """Solve again on a mesh made for this orbit, the first of the method's that succeeds, if it has any."""
    choices = task.method.meshes(task, solved)
    attempts = (_remeshed(task, solved, mesh, phases, fixed) for mesh, phases in choices)
    return _first_of(attempts, otherwise=solved)


def _remeshed(task: Task, solved: Solved, mesh: Mesh, phases: Array, fixed: bool) -> Solved | Outcome:
    if not fixed:
        return carried(task, solved, mesh, phases, solved.tangent)
    sign = float(np.sign(solved.tangent.parameter)) or 1.0
    guesses = task.method.guesses(task, solved.orbit, mesh, phases)
    return _first_of(_unmoved(task, solved, at_parameter(task, guess, sign)) for guess in guesses)


def carried(task: Task, solved: Solved, mesh: Mesh, phases: Array, direction: Direction) -> Solved | Outcome:
    """Solve for an orbit again on another mesh, on the plane across `direction` (given on the old mesh)."""
    old = solved.orbit

    def attempt(guess: Orbit) -> Solved | Outcome:
        plane = Plane(guess, on_mesh(direction, old, guess), 0.0, task.metric, task.index)
        return _unmoved(task, solved, on_plane(task, guess, plane))

    return _first_of(attempt(guess) for guess in task.method.guesses(task, old, mesh, phases))


def _unmoved(task: Task, old: Solved, new: Solved | Outcome) -> Solved | Outcome:
    """Return the new solution if it is the old orbit within its error."""
    if isinstance(new, Solved) and not same(task, old, new):
        return Outcome.MOVED
    return new


def _first_of(
    attempts: Iterable[Solved | Outcome], otherwise: Solved | Outcome = Outcome.MOVED
) -> Solved | Outcome:
    """Return the first solution, or the first failure if there is none; `otherwise` of no attempts."""
    failures: list[Outcome] = []
    for attempt in attempts:
        if isinstance(attempt, Solved):
            return attempt
        failures.append(attempt)
    return failures[0] if failures else otherwise


def closes(task: Task, start: Solved, new: Solved) -> bool:
    """Whether the branch comes back to its start on the way it left it.

    The same orbit a whole number of excitation periods later counts as the start again, an autonomous one
    from any phase on: nothing brings it back to that of the start. A branch that comes
    back the other way has passed through an orbit of fewer periods and goes on.
    """
    for later in [_ahead(task, start.orbit, new.orbit)] if task.autonomous else range(start.orbit.periods):
        if same(task, start, new, later):
            onward = on_mesh(new.tangent, new.orbit, start.orbit, FORCED * later)
            return task.metric.dot(start.orbit, start.tangent, onward) > 0
    return False


def repeats(task: Task, solved: Solved) -> bool:
    """Whether an orbit of several excitation periods comes back to itself after fewer."""
    return any(same(task, solved, solved, later) for later in range(1, solved.orbit.periods))


def from_itself(task: Task, solved: Solved) -> float:
    """Least distance of an orbit of several excitation periods from itself so many of them later."""
    orbit = solved.orbit
    return min((distance(task, orbit, orbit, FORCED * k) for k in range(1, orbit.periods)), default=np.inf)


def _ahead(task: Task, a: Orbit, b: Orbit) -> float:
    """By how much b is ahead of a, in units of 2 pi: where their distance is least."""

    def apart(later: float) -> float:
        return distance(task, a, b, FORCED * later)

    step = a.periods / SHIFTS
    nearest = min((step * k for k in range(SHIFTS)), key=apart)
    around = (nearest - step, nearest + step)
    return float(optimize.minimize_scalar(apart, bounds=around, method="bounded", options={"xatol": 1e-10}).x)


def same(task: Task, a: Solved, b: Solved, later: float = 0) -> bool:
    """Whether b, taken `later` excitation periods later, is the orbit a within its error."""
    allowed = KEPT * max(a.error.worst, task.settings.mesh.tolerance) * max(a.orbit.span(), LEAST_SPAN)
    return distance(task, a.orbit, b.orbit, FORCED * later) <= allowed


def distance(task: Task, a: Orbit, b: Orbit, later: float = 0.0) -> float:
    """Distance of a and b in the task's metric, b taken `later` (rad); they may have different meshes."""
    profile = b.state(a.mesh.nodes(a.phases) + later) - a.nodes
    jump = float(b.parameter[task.index] - a.parameter[task.index])
    difference = replace(parameter_direction(a, task.metric), profile=profile, parameter=jump)
    return float(np.sqrt(task.metric.dot(a, difference, difference)))


def on_mesh(direction: Direction, old: Orbit, new: Orbit, later: float = 0.0) -> Direction:
    """The direction's profile `later` (rad) than the mesh points of another mesh: all that a plane needs."""
    at, where = old.mesh.nodes(old.phases), new.mesh.nodes(new.phases) + later
    wrapped = at[0] + np.mod(where - at[0], old.mesh.period)
    profile = np.stack([np.interp(wrapped, at, column) for column in direction.profile.T], axis=1)
    base = parameter_direction(new, Metric(1.0))
    return replace(base, profile=profile, parameter=direction.parameter)


def predict(task: Task, orbit: Orbit, direction: Direction, ds: float) -> Orbit:
    """Return the orbit moved by ds along a direction."""
    return along(task.system, task.free, orbit, direction, ds)


def along(system: System, free: tuple[int, ...], orbit: Orbit, direction: Direction, ds: float) -> Orbit:
    """Return an orbit and its free parameters moved by ds along a direction."""
    parameter = orbit.parameter.copy()
    parameter[list(free)] += ds * np.append(direction.parameter, direction.others)
    return replace(
        orbit,
        nodes=orbit.nodes + ds * direction.nodes,
        stages=orbit.stages + ds * direction.stages,
        algebraic=moved(system, orbit.algebraic, ds * direction.algebraic),
        phases=orbit.phases + ds * direction.phases,
        parameter=parameter,
    )
