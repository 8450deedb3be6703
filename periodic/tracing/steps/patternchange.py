"""Steps that end at a change of the pattern of an orbit's events, and how the branch goes on beyond it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.turningpoint import at_once
from periodic.correction.change import Beyond, Change, Held
from periodic.correction.condition import SideCondition
from periodic.correction.identity import distance
from periodic.correction.outcome import Outcome
from periodic.correction.predictor import spaced, tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.events.thresholds import NOISE
from periodic.linear.unknowns import size_of
from periodic.orbit.orbit import Orbit
from periodic.system.precision import CONVERGED

FARTHEST_AHEAD = 1.2
"""A change of pattern that lies within so many steps is where the step ends."""

CHANGE_ITERATIONS = 8
"""Most Newton iterations towards a change that may not exist: 2 to 5 suffice where it does."""

FARTHEST_BEYOND = 0.02
"""Distance of the orbits on either side of a change, in the metric of continuation, at the most,"""

ACROSS = 2.0
"""... or so many lengths of the last step, in which the distance of two events has been at least halved:
beyond, events that have changed places are as far apart again."""

MESHES_BEYOND = 4
"""How often the mesh of the orbit beyond a change is made anew."""

CHANGES_IN_A_STEP = 8
"""Most changes of the pattern that are tried as the first one in a step."""


@dataclass(frozen=True)
class Reached:
    """The end of a step at a change of pattern, and how far that is along the base's tangent."""

    end: Solution
    ds: float
    change: Change


def standing(base: Solution, change: Change | None) -> Reached | None:
    """Return the base itself as the end of a step, where a switch grazes that would cross in the step."""
    if change is None or not change.strict or change.part > CONVERGED:
        return None
    return Reached(base, 0.0, change)


def reached(solver: Solver, base: Solution, near: Orbit | None, ds: float, change: Change) -> Reached | None:
    """Return the orbit at a change of pattern within a step, if one is found; `near` is a guess of it."""
    method, system = solver.discretisation, solver.problem.system
    for _ in range(CHANGES_IN_A_STEP):
        guess = (
            near if near is not None else spaced(base.orbit, tangent(solver.problem, base, change.part * ds))
        )
        found = _held(solver, guess, Held(base.orbit, change.condition, base.tangent), CHANGE_ITERATIONS)
        if not found.ok and change.otherwise is not None:
            change, near = change.otherwise, None
            continue
        if not found.ok:
            return None
        along = progress(solver, base, found.orbit)
        if change.strict and -CONVERGED < along <= 0.0:  # at the base, but for Newton's error
            along = abs(along) or CONVERGED * ds
        if not (0.0 if change.strict else CONVERGED * ds) < along <= FARTHEST_AHEAD * ds:
            return None
        if _comes_back(found, change, along <= CONVERGED * ds):
            return None
        earlier = method.change(system, base.orbit, found.orbit)
        if earlier is None or (not change.strict and not earlier.strict):
            return Reached(found, along, change)
        change, near = earlier, found.orbit
    return None


def _comes_back(found: Solution, change: Change, at_base: bool) -> bool:
    """Whether the branch comes back there from orbits that violate their word: the change began before.

    at_base: whether the change lies where the step begins. Extrema do not come and go within a step, but one
    that grazes at its beginning may leave its level there.
    """
    row = change.condition.linearise(found.problem.system, found.orbit, found.problem.free)
    if not change.strict or (row.stages is not None and not at_base):
        return False
    return found.tangent.rate_of(row) > 0


def _held(solver: Solver, guess: Orbit, held: Held, most: int | None = None) -> Solution:
    """Solve on a condition so closely that rounding decides on which side of its level a switch is."""
    newton = solver.tolerance.newton
    most = min(most or newton.max_iterations, newton.max_iterations)
    close = replace(newton, tolerance=min(CONVERGED, newton.tolerance), close=0.0, max_iterations=most)
    found = solver.on(guess, held, close)
    return found.failed(Outcome.UNDETERMINED) if found.ok and undetermined(found) else found


def undetermined(solution: Solution) -> bool:
    """Return whether along a solution's tangent only event nodes move: no states, and no parameter.

    A joint passes and stops again then without having moved: no excursion begins so. Along a branch states
    change with the phases of an excursion at a rate about as large as its size, but for rounding.
    """
    problem, orbit, tangent = solution.problem, solution.orbit, solution.tangent
    if not len(orbit.phases):
        return False
    states = float(np.abs(tangent.profile).max()) / size_of(orbit)
    parameters = float(np.abs(tangent.parameters / problem.units(orbit)).max())
    return max(states, parameters) <= NOISE * float(np.abs(tangent.phases).max())


def progress(solver: Solver, base: Solution, orbit: Orbit) -> float:
    """How far an orbit on the base's mesh lies along its tangent."""
    problem, constraint = solver.problem, solver.constraint(base.orbit, base.tangent, 0.0)
    row = constraint.linearise(problem.system, orbit, problem.free)
    return row.value / constraint.rate(base.tangent)


@dataclass(frozen=True)
class Crossed:
    """The orbit beyond a change of pattern, its distance from the one before, and whether it grazes.

    labels: the special points between the two, which cannot be told from the change; they lie `within` so
    much of the parameter from it.
    """

    solution: Solution
    distance: float
    grazes: bool
    labels: Sequence[Label] = ()
    within: float = 0.0


def crossed(solver: Solver, at: Reached) -> Crossed | None:
    """Return an orbit beyond a change of pattern, the first whose branch goes on the same way.

    Beside a special point that a small excursion brings with it, the excursion is made smaller: behind an
    elastic stop multipliers change fast from the grazing on, but do not jump, and the point lies beyond.
    Where all of them turn back in the parameter there is a fold in between, and where one lies behind the
    change there are two: then none is returned as long as the branch can be followed nearer to the change,
    and in the end the nearest.
    """
    nearest: Crossed | None = None
    onward: Crossed | None = None
    for way in at.change.beyond(solver.problem.system, at.end.orbit):
        folded = nearest is not None and not _folded_twice(at.end, nearest.solution)
        if way.spare and (folded or onward is not None):
            break
        found = _along(solver, at, way)
        if found is None:
            continue
        if not _onward(at.end, found.solution):
            nearest = min(nearest or found, found, key=lambda each: each.distance)
        elif onward is None or len(found.labels) < len(onward.labels):
            onward = found
        else:
            onward = replace(onward, within=min(found.within, onward.within))
        if onward is not None and not (onward.labels and at.change.grazes):
            break
    return onward or (nearest if at.change.final else None)


def _folded_twice(before: Solution, after: Solution) -> bool:
    """Whether the branch turns back and on again between two orbits."""
    return bool(before.tangent.parameter * after.tangent.parameter > 0)


def _onward(before: Solution, after: Solution) -> bool:
    """Whether the parameter goes on from one orbit to another as it does at both, but for their errors."""
    way, blur = before.tangent.parameter, max(s.error.motion * abs(s.value) for s in (before, after))
    ahead = (after.value - before.value) * np.sign(way)
    return bool(after.tangent.parameter * way > 0 and ahead >= -blur)


def _along(solver: Solver, at: Reached, way: Beyond) -> Crossed | None:
    """The orbit beyond a change on one way, if there is one near."""
    problem, old = solver.problem, at.end.orbit
    moved = old if way.parameter is None else replace(old, parameter=way.parameter)
    for guess in solver.transfers(moved, way.mesh, way.phases):
        new = _accurate(solver, _held(solver, guess, Held(guess, way.condition)), way.condition)
        if not new.ok or np.isinf(new.error.motion):  # it violates its word
            continue
        if solver.discretisation.change(problem.system, new.orbit, new.orbit) is not None:
            continue
        apart = distance(problem, old, new.orbit) / size_of(old)
        swaps = not (at.change.grazes or way.grazes)  # beside grazing a fold may be near
        if (
            apart <= (max(FARTHEST_BEYOND, ACROSS * at.ds) if swaps else FARTHEST_BEYOND)
            and problem.low <= new.value <= problem.high
        ):
            return Crossed(new, apart, way.grazes, at_once(at.end, new), abs(new.value - at.end.value))
    return None


def _accurate(solver: Solver, found: Solution, condition: SideCondition) -> Solution:
    """Return the solution on meshes made for it, as long as it misses the tolerance.

    Multipliers depend on the depth of an excursion, which is far smaller than the orbit itself.
    """
    for _ in range(MESHES_BEYOND):
        if not found.ok or found.error.curable <= solver.tolerance.orbit:
            break
        mesh = found.refinement.refined()
        if mesh.matches(found.orbit.mesh):
            break
        guesses = solver.transfers(found.orbit, mesh, found.orbit.phases)
        finer = (_held(solver, guess, Held(guess, condition)) for guess in guesses)
        better = next((solution for solution in finer if solution.ok), None)
        if better is None:
            break
        found = better
    return found
