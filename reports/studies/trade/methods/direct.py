"""Orbits found directly: collocation on uniform, adaptive and anchored meshes, shooting, harmonic balance.

All begin from the same neighbouring orbit, as continuation does: on the even mesh that is theirs, or on the
mesh that their tolerance asks for there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

import periodic as per
from periodic.correction.newton import Correction, correct
from periodic.correction.solver import Solver
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Array
from periodic.refinement.adaptation import refined, remeshed
from reports.studies.trade.methods.problems import Problem, nearby

INTERPOLATED = 100.0
"""By how much an orbit may miss a tolerance between mesh points: of shooting those are only interpolated."""

NEWTON = per.NewtonSettings(tolerance=1e-8, max_iterations=16)
"""The last step is smaller; what it leaves is of the order of its square."""

NO_EVENTS = per.KinkSettings(appear=1e3, vanish=1e3)
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
        guess = method.guess(problem.system, problem.values, nearby(problem))
        return _converged(method, problem, guess)


@dataclass(frozen=True)
class Adaptive:
    """A method whose error estimate is to fall below its tolerance, on meshes that it chooses."""

    method: per.extend.Discretisation
    tol: per.Tolerance

    def solve(self, problem: Problem) -> Correction:
        """Return the orbit. Raises FailedError."""
        begin = neighbour(self, problem)
        return self._accurate(_reached(self._solver(problem), begin, problem.values)).correction

    def _solver(self, problem: Problem) -> Solver:
        asked = per.Problem(problem.system, problem.parameter, problem.bounds)
        return Solver(asked, self.method.at(self.tol.orbit), self.tol)

    def _accurate(self, solution: per.extend.Solution) -> per.extend.Solution:
        if not solution.ok:
            raise FailedError(solution.outcome.value)
        if solution.error.orbit > INTERPOLATED * self.tol.orbit:
            raise FailedError(solution.refinement.shortfall)
        return solution


def _reached(
    solver: Solver, begin: per.Orbit, values: Array, halvings: int = HALVINGS
) -> per.extend.Solution:
    """Solve at other parameters; where Newton fails, half way first, as continuation does."""
    found = refined(solver, solver.at_parameter(replace(begin, parameter=values), 1.0), fixed=True)
    if found.ok or not halvings:
        return found
    middle = _reached(solver, begin, (begin.parameter + values) / 2, halvings - 1)
    return _reached(solver, middle.orbit, values, halvings - 1) if middle.ok else middle


@cache
def neighbour(way: Adaptive, problem: Problem) -> per.Orbit:
    """Return the neighbouring orbit as the method has it at its tolerance: on a mesh of its own for it."""
    solver, orbit = way._solver(problem), nearby(problem)
    guess = solver.discretisation.guess(problem.system, orbit.parameter, orbit)
    found = way._accurate(refined(solver, solver.at_parameter(guess, 1.0), fixed=True))
    limit = INTERPOLATED * way.tol.orbit
    for _ in range(SLIMMING):
        slimmer = remeshed(solver, found, fixed=True)
        if not slimmer.ok or slimmer.error.orbit > limit or not slimmer.refinement.fits:
            break
        found = slimmer
    return found.orbit


def tolerance(orbit: float, newton: float | None = None, most: int = NEWTON.max_iterations) -> per.Tolerance:
    """Return a tolerance of orbits with Newton's as the dial has it, or another one, and its iterations."""
    limit = newton or max(1e-2 * orbit, 1e-10) ** 0.75
    return per.Tolerance(orbit=orbit, newton=replace(NEWTON, tolerance=limit, max_iterations=most))


def shooting(integrator: float) -> Adaptive:
    """Return single shooting whose integrator has a tolerance, interpolated as well as that allows."""
    scheme = per.Scheme(per.Family.RADAU, 6)
    method = per.Shooting(tolerance=integrator, scheme=scheme)
    return Adaptive(method, tolerance(min(1e3 * integrator, 0.1)))


def _converged(method: per.extend.Discretisation, problem: Problem, guess: per.Orbit) -> Correction:
    at = replace(guess, parameter=problem.values)
    found = correct(method.linearise, problem.system, at, settings=NEWTON)
    if found.ok:
        found = method.accepted(problem.system, found)
    if not found.ok:
        raise FailedError(found.outcome.value)
    return found
