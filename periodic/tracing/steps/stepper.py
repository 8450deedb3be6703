"""One step of a continuation: its end on a mesh made for it, or why it is rejected; the mesh of the next.

A step is rejected where Newton fails, where its end is not where its two tangents lead (a jump to another
branch), where the tangent turns by too much, where an orbit violates the word of its event nodes, or where
the error estimate exceeds the tolerance on a mesh made for the new orbit.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from periodic.bifurcations.withinstep import RejectedError
from periodic.correction.identity import distance
from periodic.correction.newton import NewtonSettings
from periodic.correction.predictor import cubic, spaced
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.orbit.mesh import Mesh
from periodic.refinement.adaptation import carried, is_refined, refined, remeshed
from periodic.tracing.collapse import collapsed
from periodic.tracing.steps.foresight import LOOKED, Foresight
from periodic.tracing.steps.patternchange import Reached, reached
from periodic.tracing.steps.stepbounds import bound_ratios
from periodic.tracing.steps.stepsize import ArclengthControl

MIDDLE = 0.02
"""Distance of the middle of a step of equilibria from the cubic through its ends, as a part of the step."""

FARTHER = 2.0
"""Where even the shortest step fails a change is sought so many steps ahead. An excursion whose length is as
the square root of the way left has lost less than a third of it half way to where it ends; Newton hardly
converges beyond."""


class WordError(RejectedError):
    """A step to an orbit that violates its word."""


class BeyondError(RejectedError):
    """A step to an orbit that the method's finest mesh does not resolve."""


@dataclass(frozen=True)
class Attempt:
    """A step that was tried: the base on the mesh of its end, the end, its length, and the largest ratio to a
    bound that is expected of a next step of that length."""

    base: Solution
    new: Solution
    ds: float
    bound_ratio: float
    change: Reached | None


@dataclass(frozen=True)
class Stepper:
    """How steps are taken.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    control : ArclengthControl
        Step control.
    foresight : Foresight
        What tells where the tangent leads, and changes of pattern ahead.
    """

    solver: Solver
    control: ArclengthControl
    foresight: Foresight

    def step(self, base: Solution, ds: float) -> Attempt:
        """Take one step.

        The mesh is made anew up to `meshes` times, while it changes; where then only the multipliers' error
        exceeds its bound, the step is accepted and the point says so.

        Parameters
        ----------
        base : Solution
            Where it begins, with its tangent.
        ds : float
            Its length in arclength.

        Returns
        -------
        Attempt
            The step; shorter where the pattern of events changes within it.

        Raises
        ------
        RejectedError
            Where it leads to no orbit, or to one that fails a check.
        """
        tolerance = self.solver.tolerance.orbit
        for left in reversed(range(self.control.meshes + 1)):
            tried = self._attempt(base, ds)
            new = tried.new
            if new.error.curable <= tolerance:
                return tried
            if not new.refinement.mendable:
                raise WordError(new.refinement.shortfall)
            if collapsed(base.orbit, new):
                raise RejectedError("the orbit shrinks to nothing in one step")
            mesh = new.refinement.refined()
            if left == 0 or mesh.matches(base.orbit.mesh):
                break
            base = self._on_mesh(base, mesh)
        if new.error.motion > tolerance:
            if new.refinement.exhausted:
                raise BeyondError(new.refinement.shortfall)
            raise RejectedError("the error estimate exceeds the tolerance")
        return tried

    def _attempt(self, base: Solution, ds: float) -> Attempt:
        """Solve a step away, or where the pattern of events changes before that. Raises RejectedError."""
        solver, control = self.solver, self.control
        new, change = self._end(base, ds)
        length = ds if change is None else change.ds
        furthest = 0.0
        for ratio in bound_ratios(base, new, length, control, solver.tolerance.orbit):
            if not ratio.size <= 1:
                raise RejectedError(ratio.why, control.shorter(ratio.size))
            furthest = max(furthest, ratio.ahead)
        if new.orbit.equilibrium:
            self._check_middle(base, new, length)
        return Attempt(base, new, length, furthest, change)

    def _check_middle(self, base: Solution, new: Solution, ds: float) -> None:
        """Reject a step of equilibria round a corner where branches cross: its middle is off the cubic."""
        solver, near = self.solver, cubic(self.solver, base, new, ds, ds / 2)
        middle = solver.on(near, solver.constraint(base.orbit, base.tangent, ds / 2), self._patient)
        if not middle.ok or distance(solver.problem, near, middle.orbit) > MIDDLE * ds:
            raise RejectedError("the step does not follow its branch")

    def _end(self, base: Solution, ds: float) -> tuple[Solution, Reached | None]:
        """The end of a step, and the change of pattern that it ends at, foreseen or found."""
        solver, system, method = self.solver, self.solver.problem.system, self.solver.discretisation
        ahead = ds if self.control.ds_max >= LOOKED else self.foresight.reach(base, ds)
        foreseen = self.foresight.change(base, ahead)
        if foreseen is not None:
            at = reached(solver, base, None, ahead, foreseen)
            if at is not None:
                return at.end, at
        guess = spaced(base.orbit, self.foresight.guess(base, ds))
        new = solver.on(guess, solver.constraint(base.orbit, base.tangent, ds), self._patient)
        if not new.ok:
            where = f", where {foreseen.name}" if foreseen is not None and foreseen.strict else ""
            raise RejectedError(f"{new.outcome.value}{where}")
        found = method.change(system, base.orbit, new.orbit)
        if found is None or not found.strict:
            return new, None
        at = reached(solver, base, new.orbit, ds, found)
        if at is None:
            raise RejectedError(f"{found.name} within the step")
        return at.end, at

    def just_ahead(self, base: Solution, ds: float) -> Reached | None:
        """Return the change of pattern that lies a little farther than the shortest step, which failed.

        Parameters
        ----------
        base : Solution
            Where the step begins, with its tangent.
        ds : float
            The length of the step.

        Returns
        -------
        Reached or None
            The end of a step at the change; None where there is none.
        """
        farther = self.foresight.change(base, FARTHER * ds)
        return None if farther is None else reached(self.solver, base, None, FARTHER * ds, farther)

    @cached_property
    def _patient(self) -> NewtonSettings:
        """Newton's settings for the end of a step."""
        newton = self.solver.tolerance.newton
        return replace(newton, max_iterations=min(self.control.patience, newton.max_iterations))

    def _on_mesh(self, base: Solution, mesh: Mesh) -> Solution:
        """Solve the base again on the mesh made for the new orbit, with the base's own event nodes."""
        moved = carried(self.solver, base, mesh, base.orbit.phases)
        if not moved.ok:
            raise RejectedError(f"the mesh could not be adapted: {moved.outcome.value}")
        if not self.solver.alike(base, moved):
            raise RejectedError("on another mesh the orbit has other events")
        return moved

    def remeshed(self, new: Solution, due: bool) -> Solution:
        """Return a solution on the mesh of the next step: its event nodes, an error within bounds.

        Parameters
        ----------
        new : Solution
            The end of a step.
        due : bool
            Whether it is time for a new mesh whatever its error.

        Returns
        -------
        Solution
            The same one where no other mesh is wanted, or none is better.
        """
        solver, tolerance = self.solver, self.solver.tolerance.orbit
        due = due or new.error.curable >= self.control.remesh_above * tolerance
        if new.refinement.fits and not due and not self._too_fine(new):
            return new
        better = remeshed(solver, new)
        if better.ok and not is_refined(solver, better):
            better = refined(solver, better)
        if not better.ok or better.error.motion > tolerance or not solver.alike(new, better):
            return new
        return better

    def _too_fine(self, new: Solution) -> bool:
        """Whether a far smaller mesh would do."""
        control = self.control
        if new.error.curable >= control.remesh_below * self.solver.tolerance.orbit:
            return False
        return new.refinement.refined().ntst <= control.smaller * new.orbit.mesh.ntst
