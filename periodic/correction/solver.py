"""Orbits of a problem by a discretisation: on an arclength constraint, or at a fixed parameter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.change import Held
from periodic.correction.discretisation import Discretisation
from periodic.correction.newton import Correction, NewtonSettings
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.correction.tolerance import Tolerance
from periodic.linear.unknowns import Increment, parameter_only, size_of
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array


class SpentError(Exception):
    """All the Newton iterations that a trace was allowed are spent; its text may say what on."""


@dataclass
class Work:
    """Newton iterations so far, failed and rejected ones included, of at most `most`."""

    most: float = float("inf")
    iterations: int = 0

    def add(self, iterations: int) -> None:
        """Count what was spent. Raises SpentError if that is more than there was."""
        self.iterations += iterations
        if self.iterations > self.most:
            raise SpentError


@dataclass(frozen=True)
class Solver:
    """A problem and how it is solved; `work` counts Newton iterations."""

    problem: Problem
    discretisation: Discretisation
    tolerance: Tolerance
    work: Work = field(default_factory=Work)

    def constraint(self, origin: Orbit, direction: Increment, distance: float) -> ArclengthConstraint:
        """Return the arclength constraint at a distance from an orbit along a direction."""
        scale, size = self.problem.units(origin), size_of(origin)
        return ArclengthConstraint(origin, direction, distance, scale, self.problem.index, size)

    def on(
        self, guess: Orbit, constraint: ArclengthConstraint | Held, newton: NewtonSettings | None = None
    ) -> Solution:
        """Solve from a guess on an arclength constraint, or a condition in its place, on the same mesh.

        The tangent points to the constraint's positive side; `newton` are settings other than the usual ones.
        """
        problem, method = self.problem, self.discretisation
        closing = [*problem.side_conditions(constraint.origin), constraint]
        settings = newton or self.tolerance.newton
        found = method.corrected(problem.system, guess, problem.free, closing, settings)
        self.work.add(found.iterations)
        if found.ok:
            found = method.accepted(problem.system, found)
        return Solution(problem, method, found, self._tangent(found, constraint))

    def _tangent(self, found: Correction, constraint: ArclengthConstraint | Held) -> Increment:
        """The unit kernel, along the constraint's direction; the direction where there is no kernel."""
        kernel, direction = found.kernel, constraint.direction
        if kernel is None or not found.ok:
            return direction or parameter_only(constraint.origin, self.problem.scale)
        scale, size = self.problem.units(found.orbit), size_of(found.orbit)
        length = np.sqrt(kernel.dot(kernel, found.orbit, scale, size))
        along = 1.0 if direction is None else kernel.dot(direction, found.orbit, scale, size)
        return kernel.scaled((np.sign(along) or 1.0) / length)

    def at_parameter(self, guess: Orbit, sign: float, newton: NewtonSettings | None = None) -> Solution:
        """Solve with the parameter fixed at the guess's value; the tangent points to `sign` times it."""
        across = parameter_only(guess, sign * self.problem.scale)
        found = self.on(guess, self.constraint(guess, across, 0.0), newton)
        if not found.ok:
            return found
        parameter = found.orbit.parameter.copy()
        parameter[self.problem.index] = self.problem.value(guess)  # Newton leaves it within rounding
        exact = replace(found.orbit, parameter=parameter)
        return replace(found, correction=replace(found.correction, orbit=exact))

    def alike(self, old: Solution, new: Solution) -> bool:
        """Whether an orbit has the events on a new mesh that it had."""
        method, system = self.discretisation, self.problem.system
        return method.pattern(system, new.orbit) == method.pattern(system, old.orbit)

    def transfers(self, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield guesses for an orbit on another mesh, the best first; none where event nodes coincide."""
        if mesh.segment_lengths(phases).all():
            yield from self.discretisation.transfer(self.problem.system, orbit, mesh, phases)
