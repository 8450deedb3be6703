"""Whether two solutions are the same orbit, within their errors and up to whole periods."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy

from periodic.correction.error import LEAST_SPAN
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.linear.unknowns import metric_weights
from periodic.orbit.orbit import FORCED, Orbit
from periodic.system import resets_of

SHIFTS = 64
"""How many phases are tried for the least distance of two autonomous orbits."""

KEPT = 30.0
"""How far an orbit may move when its mesh is changed, in units of its error estimate or of the tolerance."""

DISTINCT = 0.05
"""Orbits as far apart, in peaks to peak, are two."""


def same(solver: Solver, a: Solution, b: Solution, later: float = 0) -> bool:
    """Whether b, taken `later` excitation periods later, is the orbit a within its error."""
    part = min(KEPT * max(a.error.worst, solver.tolerance.orbit), DISTINCT)
    allowed = part * max(a.orbit.span(), LEAST_SPAN)
    return distance(solver.problem, a.orbit, b.orbit, FORCED * later) <= allowed


def distance(problem: Problem, a: Orbit, b: Orbit, later: float = 0.0) -> float:
    """Distance of a and b in the metric of continuation, b taken `later` (rad); on any meshes."""
    profile = b.state(a.mesh.nodes(a.phases) + later) - a.nodes
    for i, j in _impacts(problem, a, b, later):
        profile[i] = b.nodes[j] - a.nodes[i]
    units, free = problem.units(a), list(problem.free)
    jump = b.parameter[free] - a.parameter[free]
    apart = float(np.sum(((jump if isinstance(units, np.ndarray) else jump[:1]) / units) ** 2))
    return float(np.sqrt(np.einsum("j,jn,jn->", metric_weights(a), profile, profile) + apart))


def _impacts(problem: Problem, a: Orbit, b: Orbit, later: float) -> Iterator[tuple[int, int]]:
    """Yield the mesh points of a where the state jumps, each with that of the same impact of b.

    The least difference of their phases would compare states before and after the impact.
    """
    starts = {i: [i] if i else [0, len(a.nodes) - 1] for i in map(int, a.mesh.starts)}
    for start, event, phase in zip(starts, a.mesh.events, a.phases, strict=True):
        near = a.grid.width[[start - 1, start]].min()
        for other, place, node in zip(b.mesh.events, b.phases, b.mesh.starts, strict=True):
            apart = np.remainder(phase + later - place + b.mesh.period / 2, b.mesh.period) - b.mesh.period / 2
            if event == other and event.switch in resets_of(problem.system) and abs(apart) < near:
                yield from ((i, int(node)) for i in starts[start])


def closes(solver: Solver, start: Solution, new: Solution) -> bool:
    """Whether the branch comes back to its start on the way it left it.

    The same orbit a whole number of excitation periods later counts as the start again, an autonomous one
    from any phase on: nothing brings it back to that of the start. A branch that comes
    back the other way has passed through an orbit of fewer periods and goes on.
    """
    problem, begun = solver.problem, start.orbit
    for later in [_ahead(problem, begun, new.orbit)] if problem.autonomous else range(begun.periods):
        if same(solver, start, new, later):
            onward = new.tangent.restricted(new.orbit, begun, FORCED * later)
            return start.tangent.dot(onward, begun, problem.units(begun)) > 0
    return False


def repeats(solver: Solver, solution: Solution) -> bool:
    """Whether an orbit of several excitation periods comes back to itself after fewer."""
    return any(same(solver, solution, solution, later) for later in range(1, solution.orbit.periods))


def from_itself(solution: Solution) -> float:
    """Least distance of an orbit of several excitation periods from itself so many of them later."""
    orbit, problem = solution.orbit, solution.problem
    return min((distance(problem, orbit, orbit, FORCED * k) for k in range(1, orbit.periods)), default=np.inf)


def _ahead(problem: Problem, a: Orbit, b: Orbit) -> float:
    """By how much b is ahead of a, in units of 2 pi: where their distance is least."""

    def apart(later: float) -> float:
        return distance(problem, a, b, FORCED * later)

    step = a.periods / SHIFTS
    nearest = min((step * k for k in range(SHIFTS)), key=apart)
    around = (nearest - step, nearest + step)
    return float(
        scipy.optimize.minimize_scalar(apart, bounds=around, method="bounded", options={"xatol": 1e-10}).x
    )
