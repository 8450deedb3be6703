"""Orbits found directly: collocation on uniform, adaptive and anchored meshes, shooting, harmonic balance.

All begin from the same neighbouring orbit, as continuation does: on the even mesh that is theirs, or on the
mesh that their tolerance asks for there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

import periodic as per
from periodic.anchors import AnchorSettings
from periodic.closure import Metric
from periodic.mesh import uniform
from periodic.methods.protocol import Method
from periodic.newton import Correction, Outcome
from periodic.orbit import transfer
from periodic.scheme import Array
from periodic.solve import Solved, Task, at_parameter, remesh, settle
from reports.trade.problems import Problem, nearby

INTERPOLATED = 100.0
"""By how much an orbit may miss a tolerance between mesh points: of shooting those are only interpolated."""

NEWTON = per.NewtonSettings(tolerance=1e-8, max_iterations=16)
"""The last step is smaller; what it leaves is of the order of its square."""

NO_ANCHORS = AnchorSettings(appear=1e3, vanish=1e3)
"""Excursions of a thousand rad do not come about."""

SLIMMING = 5
"""How many times the neighbouring orbit's mesh is made anew for a tolerance; each at most halves it."""

HALVINGS = 3
"""How often the way from the neighbouring orbit may be halved."""

NONE = np.zeros(0)


class FailedError(ArithmeticError):
    """A method did not find the orbit; the message says why."""


@dataclass(frozen=True)
class Even:
    """Collocation on `ntst` equal intervals: Newton from the neighbouring orbit and nothing else."""

    scheme: per.Scheme
    ntst: int

    def solve(self, problem: Problem) -> Correction:
        """Return the orbit. Raises FailedError."""
        guess = transfer(nearby(problem), uniform(self.scheme, self.ntst), NONE)
        return _converged(per.Collocation(), problem, guess)


@dataclass(frozen=True)
class Harmonics:
    """Harmonic balance with a fixed number of harmonics."""

    count: int

    def solve(self, problem: Problem) -> Correction:
        """Return the orbit. Raises FailedError."""
        method = per.HarmonicBalance(harmonics=self.count, most=self.count)
        guess = method.adopted(problem.system, per.MeshSettings(), nearby(problem), problem.values)
        return _converged(method, problem, guess)


@dataclass(frozen=True)
class Adaptive:
    """A method whose error estimate is to fall below its tolerance, on meshes that it chooses."""

    method: Method
    settings: per.Settings

    def solve(self, problem: Problem) -> Correction:
        """Return the orbit. Raises FailedError."""
        task, begin = self._task(problem), neighbour(self, problem)
        return self._accurate(task, _reached(task, begin, problem.values)).correction

    def _task(self, problem: Problem) -> Task:
        scale = abs(problem.bounds[1] - problem.bounds[0])
        return Task(problem.system, problem.index, Metric(scale), self.settings, self.method)

    def _accurate(self, task: Task, solved: Solved | Outcome) -> Solved:
        if isinstance(solved, Outcome):
            raise FailedError(solved.value)
        if solved.error.orbit > INTERPOLATED * self.settings.mesh.tolerance:
            raise FailedError(self.method.shortfall(task, solved))
        return solved


def _reached(task: Task, begin: per.Orbit, values: Array, halvings: int = HALVINGS) -> Solved | Outcome:
    """Solve at other parameters; where Newton fails, half way first, as continuation does."""
    solved = settle(task, at_parameter(task, replace(begin, parameter=values), 1.0), fixed=True)
    if isinstance(solved, Solved) or not halvings:
        return solved
    middle = _reached(task, begin, (begin.parameter + values) / 2, halvings - 1)
    return middle if isinstance(middle, Outcome) else _reached(task, middle.orbit, values, halvings - 1)


@cache
def neighbour(way: Adaptive, problem: Problem) -> per.Orbit:
    """Return the neighbouring orbit as the method has it at its tolerance: on a mesh of its own for it."""
    task, orbit = way._task(problem), nearby(problem)
    guess = way.method.adopted(problem.system, task.settings.mesh, orbit, orbit.parameter)
    solved = way._accurate(task, settle(task, at_parameter(task, guess, 1.0), fixed=True))
    limit = INTERPOLATED * way.settings.mesh.tolerance
    for _ in range(SLIMMING):
        slimmer = remesh(task, solved, fixed=True)
        if isinstance(slimmer, Outcome) or slimmer.error.orbit > limit or not slimmer.anchored:
            break
        solved = slimmer
    return solved.orbit


def settings_for(
    tolerance: float, scheme: per.Scheme, *, anchored: bool = True, newton: float | None = None
) -> per.Settings:
    """Return the settings of a tolerance as the dial has them; newton: Newton's, if not the dial's."""
    anchors = AnchorSettings(deepest=0.1 * tolerance) if anchored else NO_ANCHORS
    mesh = per.MeshSettings(tolerance=tolerance, scheme=scheme, anchors=anchors)
    limit = newton or max(1e-2 * tolerance, 1e-10) ** 0.75
    return per.Settings(mesh=mesh, newton=replace(NEWTON, tolerance=limit))


def shooting(tolerance: float) -> Adaptive:
    """Return single shooting whose integrator has a tolerance, interpolated as well as that allows."""
    scheme = per.Scheme(per.Family.RADAU, 6)
    return Adaptive(per.Shooting(tolerance=tolerance), settings_for(min(1e3 * tolerance, 0.1), scheme))


def _converged(method: Method, problem: Problem, guess: per.Orbit) -> Correction:
    found = method.correct(problem.system, replace(guess, parameter=problem.values), (), (), NEWTON)
    if found.outcome is not Outcome.CONVERGED:
        raise FailedError(found.outcome.value)
    return found
