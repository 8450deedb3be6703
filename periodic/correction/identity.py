"""Whether two solutions are the same orbit, within their errors and up to whole periods."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy

from periodic.correction.error import AT_WORST
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.linear.unknowns import metric_weights
from periodic.orbit.mesh import wrapped
from periodic.orbit.orbit import FORCED, LEAST_SPAN, Orbit
from periodic.orbit.scheme import Array
from periodic.system import resets_of

SHIFTS = 64
"""How many phases are tried for the least distance of two autonomous orbits."""

TWO_ORBITS = 0.05
"""Orbits as far apart, in peaks to peak, are two."""

TWO_IMPACTS = 0.05
"""Impacts farther apart (rad) are two."""


def same(solver: Solver, a: Solution, b: Solution, later: float = 0) -> bool:
    """Whether b, taken `later` excitation periods later, is the orbit a within its error."""
    part = min(AT_WORST * max(a.error.worst, solver.tolerance.orbit), TWO_ORBITS)
    allowed = part * max(a.orbit.span(), LEAST_SPAN)
    return distance(solver.problem, a.orbit, b.orbit, FORCED * later) <= allowed


def distance(problem: Problem, a: Orbit, b: Orbit, later: float = 0.0) -> float:
    """Distance of a and b in the metric of continuation, b taken `later` (rad); on any meshes.

    Between impacts that both have, b is shifted so that these coincide: else a small difference of phase
    would compare states before and after an impact. Shifts count too, a radian as much as a's amplitude.
    """
    tau, shared = a.mesh.nodes(a.phases), list(_impacts(problem, a, b, later))
    shift = _interpolated(tau, a, shared)
    profile = b.state(tau + later + shift) - a.nodes
    for impact in shared:
        profile[impact.starts] = b.nodes[impact.other] - a.nodes[impact.starts]
    units, free = problem.units(a), list(problem.free)
    jump = b.parameter[free] - a.parameter[free]
    apart = float(np.sum(((jump if isinstance(units, np.ndarray) else jump[:1]) / units) ** 2))
    apart += sum((impact.shift * max(a.span(), LEAST_SPAN) / 2) ** 2 for impact in shared)
    return float(np.sqrt(np.einsum("j,jn,jn->", metric_weights(a), profile, profile) + apart))


@dataclass(frozen=True)
class Shared:
    """An impact of two orbits: mesh points in the first, that in the second, phase, shift to the second."""

    starts: list[int]
    other: int
    phase: float
    shift: float


def _impacts(problem: Problem, a: Orbit, b: Orbit, later: float) -> Iterator[Shared]:
    """Yield the impacts of a that b has within half the way to another impact at the same switch."""
    period, resets = a.mesh.period, resets_of(problem.system)
    for start, event, phase in zip(a.mesh.starts, a.mesh.events, a.phases, strict=True):
        if event.switch not in resets:
            continue
        own = zip(a.mesh.events, a.phases, strict=True)
        alike = [p for e, p in own if e.switch == event.switch and p != phase]
        near = min([TWO_IMPACTS, *(abs(wrapped(p - phase, period)) / 2 for p in alike)])
        each = zip(b.mesh.events, b.phases, b.mesh.starts, strict=True)
        theirs = [(p, j) for e, p, j in each if e.switch == event.switch]
        others = [(wrapped(p - phase - later, b.mesh.period), int(j)) for p, j in theirs]
        shift, other = min(others, key=lambda found: abs(found[0]), default=(np.inf, 0))
        if abs(shift) < near:
            starts = [int(start)] if start else [0, len(a.nodes) - 1]
            yield Shared(starts, other, float(phase), shift)


def _interpolated(tau: Array, a: Orbit, shared: list[Shared]) -> Array:
    """Shift of b at phases of a, interpolated between the impacts of both."""
    if not shared:
        return np.zeros_like(tau)
    phases, shifts = np.array([(impact.phase, impact.shift) for impact in shared]).T
    return np.asarray(np.interp(tau, phases, shifts, period=a.mesh.period))


def closes(solver: Solver, start: Solution, new: Solution) -> bool:
    """Whether the branch comes back to its start in the direction in which it left it.

    The start shifted by whole excitation periods counts as the start, an autonomous one shifted by any phase,
    as nothing fixes its phase. A branch that comes back in the other direction has passed through an orbit of
    fewer periods and goes on.
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
    """Least distance of an orbit of several excitation periods from itself, shifted by fewer of them."""
    orbit, problem = solution.orbit, solution.problem
    return min((distance(problem, orbit, orbit, FORCED * k) for k in range(1, orbit.periods)), default=np.inf)


def _ahead(problem: Problem, a: Orbit, b: Orbit) -> float:
    """Shift of b, in units of 2 pi, for which its distance from a is least."""

    def apart(later: float) -> float:
        return distance(problem, a, b, FORCED * later)

    step = a.periods / SHIFTS
    nearest = min((step * k for k in range(SHIFTS)), key=apart)
    around = (nearest - step, nearest + step)
    return float(
        scipy.optimize.minimize_scalar(apart, bounds=around, method="bounded", options={"xatol": 1e-10}).x
    )
