"""Words that are read from the motion itself: where an orbit violates its own, or no row of the table fits.

A motion is followed through one period from a state of the orbit, event by event: what happens is its word,
and Newton starts from that motion. So a first orbit whose word was read too early gets the right one, and a
branch goes on beyond a change that no rewrite is for, as where several things happen at once.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.correction.identity import distance
from periodic.correction.newton import in_order
from periodic.correction.predictor import tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.events.impacts import tied
from periodic.linear.unknowns import size_of
from periodic.orbit.orbit import Orbit
from periodic.refinement.adaptation import refined
from periodic.system import System
from periodic.tracing.steps.patternchange import Crossed

MOST_READINGS = 5
"""How often the word of an orbit is read again."""

DISTANCES_BEYOND = (1.0, 1e-1, 1e-2, 1e-3, 1e-4)
"""How far ahead an orbit beyond a change is looked for, in first steps."""

BEFORE = (0, 3)
"""Periods through which the motion is followed before its word is read: a joint that is held all along, and
pulled past its limit, slips to another place, at which it is held again."""

FARTHEST = 2.0
"""How far from the base it may be, in the length of the step along the tangent."""


def worded(solver: Solver, guess: Orbit, sign: float) -> Solution:
    """Return the orbit near a motion at its parameters; while it violates its word, that is read again."""
    found = _fixed(solver, guess, sign)
    for _ in range(MOST_READINGS):
        if not found.ok or np.isfinite(found.error.motion):
            break
        changed = solver.discretisation.reworded(solver.problem.system, found.orbit)
        if changed is None:
            break
        found = _fixed(solver, changed, sign)
    return found


def reread(solver: Solver, base: Solution, first: float) -> Crossed | None:
    """Return an orbit a little ahead on a branch, with the word of the motion there; None if there is none.

    first: length of a first step.
    """
    sign = float(np.sign(base.tangent.parameter))
    if solver.problem.free != (solver.problem.index,) or sign == 0:
        return None
    each = (_read(solver, base, first, sign, before) for before in BEFORE)
    return next((found for found in each if found is not None), None)


def _read(solver: Solver, base: Solution, first: float, sign: float, before: int) -> Crossed | None:
    """The same after some periods of the motion."""
    problem, (low, high) = solver.problem, solver.problem.bounds
    for ds in (part * first for part in _distances(problem.system, base)):
        ahead = tangent(problem, base, ds)
        parameter = ahead.parameter.copy()
        parameter[problem.index] = float(np.clip(problem.value(ahead), low, high))
        near = ahead if in_order(ahead) else base.orbit
        changed = solver.discretisation.reworded(problem.system, replace(near, parameter=parameter), before)
        if changed is None:
            return None
        found = worded(solver, changed, sign)
        if not found.ok or found.error.motion > solver.tolerance.orbit:
            continue
        apart = distance(problem, base.orbit, found.orbit) / size_of(base.orbit)
        if apart <= FARTHEST * ds and found.tangent.parameter * sign > 0:
            return Crossed(found, apart, touches=False)
    return None


def _distances(system: System, base: Solution) -> tuple[float, ...]:
    """How far ahead is looked: nearer with impacts and where motions leave the orbit, perhaps for another."""
    leaves = (np.abs(base.spectrum.multipliers) > 1).any() and tied(system, base.orbit)
    return DISTANCES_BEYOND[2:] if leaves else DISTANCES_BEYOND


def _fixed(solver: Solver, guess: Orbit, sign: float) -> Solution:
    return refined(solver, solver.at_parameter(guess, sign), fixed=True)
