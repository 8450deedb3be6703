"""An orbit to a tolerance: its mesh and event nodes changed until both are right, solved on each new mesh."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from periodic.correction.identity import distance, same
from periodic.correction.outcome import Outcome
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array

MOST_MESHES = 12
"""How often the mesh is made anew for one orbit."""


MISSED_KINK = 1e-3
"""How far, in peaks to peak, an orbit may be from the one it replaces that passed a kink unseen."""


def refined(solver: Solver, solution: Solution, *, fixed: bool = False) -> Solution:
    """Refine the mesh until error estimate and event nodes are right; the solution on the last mesh.

    `fixed` keeps the parameter; else the solution stays on the constraint normal to its tangent. The
    error estimate may still exceed the tolerance.
    """
    for _ in range(MOST_MESHES):
        if not solution.ok or is_refined(solver, solution):
            return solution
        new = remeshed(solver, solution, fixed=fixed)
        if not new.ok:
            right = solution.error.curable <= solver.tolerance.orbit and _sees(solver, solution)
            return solution if right else new
        solution = new
    return solution


def is_refined(solver: Solver, solution: Solution) -> bool:
    """Whether error estimate and event nodes are as they should be, or cannot be bettered."""
    exhausted = solution.refinement.exhausted
    return solution.refinement.fits and (solution.error.curable <= solver.tolerance.orbit or exhausted)


def remeshed(solver: Solver, solution: Solution, *, fixed: bool = False) -> Solution:
    """Solve again on a mesh made for this orbit, the first of the method's that succeeds, if it has any."""
    choices = solution.refinement.meshes()
    return _first_of((_on_mesh(solver, solution, *choice, fixed) for choice in choices), solution)


def _on_mesh(solver: Solver, solution: Solution, mesh: Mesh, phases: Array, fixed: bool) -> Solution:
    if not fixed:
        return carried(solver, solution, mesh, phases)
    sign = float(np.sign(solution.tangent.parameter)) or 1.0
    guesses = solver.transfers(solution.orbit, mesh, phases)
    attempts = (_unmoved(solver, solution, solver.at_parameter(guess, sign)) for guess in guesses)
    return _first_of(attempts, solution.failed(Outcome.MOVED))


def carried(solver: Solver, solution: Solution, mesh: Mesh, phases: Array) -> Solution:
    """Solve for an orbit again on another mesh, on the arclength constraint normal to its tangent."""
    old, along = solution.orbit, solution.tangent

    def attempt(guess: Orbit) -> Solution:
        constraint = solver.constraint(guess, along.restricted(old, guess), 0.0)
        return _unmoved(solver, solution, solver.on(guess, constraint))

    guesses = solver.transfers(old, mesh, phases)
    return _first_of((attempt(guess) for guess in guesses), solution.failed(Outcome.MOVED))


def _unmoved(solver: Solver, old: Solution, new: Solution) -> Solution:
    """Return the new solution if it is the old orbit within its error, or near one that missed a kink."""
    if not new.ok or same(solver, old, new):
        return new
    apart = distance(solver.problem, old.orbit, new.orbit)
    near = apart <= MISSED_KINK * old.orbit.span() and not _sees(solver, old) and _sees(solver, new)
    return new if near else new.failed(Outcome.MOVED)


def _sees(solver: Solver, solution: Solution) -> bool:
    """Whether an orbit passes no kink unseen: else it is no orbit of the system."""
    return solver.discretisation.pattern(solver.problem.system, solution.orbit) is not None


def _first_of(attempts: Iterable[Solution], otherwise: Solution) -> Solution:
    """Return the first solution, or the first failure if all fail; `otherwise` if there are no attempts."""
    failure: Solution | None = None
    for attempt in attempts:
        if attempt.ok:
            return attempt
        failure = failure or attempt
    return failure or otherwise
