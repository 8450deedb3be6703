"""Words read from a simulated motion: where an orbit violates its own word, or no row of the table fits.

A motion is integrated through one period from a state of the orbit. Its events are the word, and Newton's
method starts from that motion. So a first orbit whose word was read too early gets the right one, and a
branch goes on beyond a change without a rewrite, as where several events coincide.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from periodic.bifurcations.turningpoint import at_once
from periodic.correction.identity import distance
from periodic.correction.newton import in_order
from periodic.correction.predictor import at_fixed_phases, tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.events.impacts import tied
from periodic.linear.unknowns import size_of
from periodic.orbit.orbit import Orbit
from periodic.refinement.adaptation import refined
from periodic.system import System
from periodic.tracing.follow import Follow
from periodic.tracing.heldplaces import off_limits
from periodic.tracing.settling import settled_or_none
from periodic.tracing.steps.patternchange import Crossed
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.steps.wayacross import way_and_tangent

MOST_READINGS = 5
"""Largest number of times that the word of an orbit is read again."""

DISTANCES_BEYOND = (1.0, 1e-1, 1e-2, 1e-3, 1e-4)
"""Distances ahead at which an orbit beyond a change is sought, in first steps."""

BEFORE = (0, 3)
"""Periods through which the motion is followed before its word is read: a joint that is held all along, and
pulled past its limit, slips to another place, at which it is held again."""

FARTHEST = 2.0
"""Largest distance from the base of the orbit found ahead, in lengths of the step along the tangent."""

NEARER = 0.25
"""Part of the step with which the search is repeated where the orbit found is farther away."""


def worded(solver: Solver, guess: Orbit, sign: float) -> Solution:
    """Return the orbit found from a motion at its parameters; a word that it violates is read again."""
    found = _fixed(solver, guess, sign)
    for _ in range(MOST_READINGS):
        if not found.ok or np.isfinite(found.error.motion):
            break
        changed = solver.discretisation.reworded(solver.problem.system, found.orbit)
        if changed is None:
            break
        found = _fixed(solver, changed, sign)
    return found


def reread(
    solver: Solver, base: Solution, control: ArclengthControl, follow: Follow | None, other: bool = False
) -> Crossed | None:
    """Return an orbit a little ahead on a branch, with the word of the motion there; None if there is none.

    control: lengths of steps. follow: follows branches in the places of joints, if these may be. other:
    whether its word must differ from that of the base, as steps of the same word may come closer and closer
    to a change.
    """
    sign = float(np.sign(base.tangent.parameter))
    if solver.problem.free != (solver.problem.index,) or sign == 0:
        return None
    if (moved := off_limits(solver, base, sign, worded, follow, control.ds_max)) is not base:
        return Crossed(moved, distance(solver.problem, base.orbit, moved.orbit) / size_of(base.orbit), False)
    search, near = _Search(solver, base, sign, other), _distances(solver.problem.system, base)
    first = control.ds
    each = (search.found(first, partial(search.reworded, before=before), near) for before in BEFORE)
    found = next((crossed for crossed in each if crossed is not None), None)
    return found or search.found(first, search.settled, near[1:4])


Reading = Callable[[Orbit], Iterator[Orbit]]
"""Yields motions near an orbit, with their own words."""


@dataclass(frozen=True)
class _Search:
    """A search for orbits a little ahead of a base on its branch, where the parameter changes as `sign`."""

    solver: Solver
    base: Solution
    sign: float
    other: bool

    def found(self, first: float, read: Reading, parts: Sequence[float]) -> Crossed | None:
        """Return an orbit ahead, with the word that is read from a motion near it, if there is one."""
        for ds in (part * first for part in parts):
            for found in self._each(ds, read):
                if self._ahead_on_branch(found, ds, read):
                    return found
        return None

    def _each(self, ds: float, read: Reading) -> Iterator[Crossed]:
        """Yield the orbits near the motions that are read."""
        each = (self._solved(guess) for guess in read(self._ahead(ds)))
        return (found for found in each if found is not None)

    def _ahead_on_branch(self, found: Crossed, ds: float, read: Reading) -> bool:
        """Whether an orbit found ahead is one of the branch: as far off as the step, or going on another way.

        One with other unstable multipliers may be that of another branch, to which the motion went from an
        unstable orbit. Then a shorter step does not lead nearer. Or a fold lies between: then the branch goes
        back there as the parameter goes on.
        """
        if found.distance <= FARTHEST * ds:
            alike = not at_once(self.base, found.solution)
            return alike or (self._goes_on(found.solution) and self._nearer(found, ds, read))
        return read == self.settled and self._nearer(found, ds, read)

    def _goes_on(self, found: Solution) -> bool:
        """Whether the branch leads away from the base at an orbit found ahead."""
        (way, tangent_there), orbit = way_and_tangent(self.base, found), self.base.orbit
        return way.dot(tangent_there, orbit, self.solver.problem.units(orbit), size_of(orbit)) > 0

    def _nearer(self, found: Crossed, ds: float, read: Reading) -> bool:
        """Whether a shorter step leads to an orbit as much nearer."""
        nearer = next(self._each(NEARER * ds, read), None)
        return nearer is not None and nearer.distance <= FARTHEST * NEARER * found.distance

    def _ahead(self, ds: float) -> Orbit:
        """The base, a step along its tangent; its phases stay where event nodes would cross."""
        problem, base = self.solver.problem, self.base
        far = _as_far(base, ds)
        ahead = tangent(problem, base, far)
        ahead = ahead if in_order(ahead) else at_fixed_phases(problem, base, far)
        parameter = ahead.parameter.copy()
        parameter[problem.index] = float(np.clip(problem.value(ahead), *problem.bounds))
        return replace(ahead, parameter=parameter)

    def reworded(self, near: Orbit, before: int) -> Iterator[Orbit]:
        """Yield the motion from a state of an orbit after some periods."""
        changed = self.solver.discretisation.reworded(self.solver.problem.system, near, before)
        yield from () if changed is None else (changed,)

    def settled(self, near: Orbit) -> Iterator[Orbit]:
        """Yield the motion to which a simulation from an orbit settles, and the same settled further."""
        method, system = self.solver.discretisation, self.solver.problem.system
        if method.settles(system):
            yield from settled_or_none(method, system, near)

    def _solved(self, guess: Orbit) -> Crossed | None:
        """The orbit near a guess, with its distance from the base, if the branch goes on there."""
        found, base = worded(self.solver, guess, self.sign), self.base.orbit
        if not found.ok or found.error.motion > self.solver.tolerance.orbit:
            return None
        apart = distance(self.solver.problem, base, found.orbit) / size_of(base)
        if self.other and same_word(base, found.orbit):
            return None
        onward = found.tangent.parameter * self.sign > 0
        return Crossed(found, apart, grazes=False) if onward else None


def _as_far(base: Solution, ds: float) -> float:
    """The step along a tangent that is a distance in states and parameter alone.

    Lengths of excursions count relative to themselves: where one is all but gone it is all that changes.
    """
    problem, orbit = base.problem, base.orbit
    way = replace(base.tangent, phases=np.zeros_like(base.tangent.phases))
    return ds / float(np.sqrt(way.dot(way, orbit, problem.units(orbit), size_of(orbit))))


def same_word(one: Orbit, other: Orbit) -> bool:
    """Whether two orbits have the same event nodes in the same order, from wherever they are counted."""
    ours, theirs = one.mesh.events, other.mesh.events
    turned = (theirs[k:] + theirs[:k] for k in range(max(len(theirs), 1)))
    return one.mesh.modes == other.mesh.modes and ours in turned


def _distances(system: System, base: Solution) -> tuple[float, ...]:
    """Distances ahead: only short ones from unstable orbits with impacts, which simulated motions leave."""
    leaves = (np.abs(base.spectrum.multipliers) > 1).any() and tied(system, base.orbit)
    return DISTANCES_BEYOND[2:] if leaves else DISTANCES_BEYOND


def _fixed(solver: Solver, guess: Orbit, sign: float) -> Solution:
    return refined(solver, solver.at_parameter(guess, sign), fixed=True)
