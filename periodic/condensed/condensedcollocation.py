"""Collocation of a system that is split: its linear part integrated exactly, unknowns at the places alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from periodic.collocation.collocation import Collocation
from periodic.collocation.meshmethod import MeshMethod, scheme_for
from periodic.condensed.estimate import ContactError, OneSided, applies, estimate
from periodic.condensed.floquet import LeadingSpectrum
from periodic.condensed.linearised import SplitLinearisation, exempt
from periodic.condensed.operator import CondensedOperator
from periodic.condensed.refinement import CondensedRefinement
from periodic.condensed.settling import followed
from periodic.condensed.splitmethod import SplitMethod
from periodic.condensed.variations import CondensedVariations
from periodic.correction.discretisation import Discretisation
from periodic.correction.error import ErrorEstimate, Halving, deferred
from periodic.correction.newton import Correction, briefest, in_order
from periodic.correction.outcome import EventsCrossedError
from periodic.correction.problem import Problem
from periodic.correction.refinement import Refinement
from periodic.events.eventrows import event_rows
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.linear.variation import Variations
from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.orbit.shallow import shallow
from periodic.stability.multipliers import Spectrum
from periodic.system import System, jumps_of, linear_of, slides_of

BRIEF_CONTACT = 0.05
"""Length (rad) of a contact below which rounding of the modes' phases shows in the multipliers."""

PARAMETER_SHARE = 0.1
"""Rounding of the parameter over that of the states: fast modes, which round most, contribute little."""


@dataclass(frozen=True)
class CondensedCollocation(SplitMethod, MeshMethod):
    """Collocation for a system with a linear part (`periodic.system.Split`).

    Forces on the linear part are polynomials in each interval, and its motion under them is exact, however
    fast its modes; event nodes are those of `Collocation`, whose settings it has.
    """

    ntst: int = 12
    ntst_min: int = 6

    ends_below: ClassVar[float] = 0.1
    all_states: ClassVar[bool] = False

    def _scheme_at(self, tolerance: float) -> Scheme:
        """The scheme for a tolerance.

        Unknowns are few and forces smooth: one point more in an interval than where all states are unknown.
        """
        return Scheme(Family.RADAU, min(scheme_for(tolerance).ncol + 1, 7))

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the equations of the places, and those of the event nodes."""
        if not in_order(orbit):
            raise EventsCrossedError
        given = SplitLinearisation.about(system, orbit, free, self.tolerance)
        return CondensedOperator(given, event_rows(system, orbit, free))

    def variations(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Variations:
        """Return the linearised motions about an orbit. Raises UnknownVariationsError where forces jump."""
        return CondensedVariations.about(system, orbit, free)

    @property
    def alternatives(self) -> tuple[Discretisation, ...]:
        """The method with other numbers of collocation points."""
        return tuple(replace(self, scheme=Scheme(Family.RADAU, ncol)) for ncol in (3, 5))

    def guess(self, system: System, parameter: Array, near: Orbit | None) -> Orbit:
        """Return the orbit at rest, or `near` on this scheme, with the forces that its motion gives."""
        if near is None or near.equilibrium:
            return super().guess(system, parameter, near)
        old = near.mesh
        mesh = Mesh(self.scheme or Scheme(), old.breaks, old.events, old.period, old.modes)
        found = replace(transfer(near, mesh, near.phases), parameter=parameter)
        forces = algebraic_at(system, found, found.stage_phases.ravel())
        return replace(found, algebraic=forces.reshape(found.algebraic.shape))

    def transfer(self, system: System, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the orbit on the other mesh."""
        yield transfer(orbit, mesh, phases)

    def reworded(self, system: System, orbit: Orbit, before: int = 0) -> Orbit | None:
        """Return a guess with the events of the orbit's own motion, where that can be followed."""
        motion = followed(system, orbit, before)
        return None if motion is None else self.guess(system, motion.parameter, motion)

    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors by the forces' residual on the halved mesh, or by a Newton step there.

        Velocities of the places, to which all modes contribute, count at mesh points alone: there they are
        exact for the forces, however fast they change in between.
        """
        operator = correction.operator
        if isinstance(operator, CondensedOperator) and applies(operator):
            return estimate(problem, operator, tangent, spectrum)
        exempted = self._exempted(problem.system, operator)
        beside = OneSided()
        brief = len(correction.orbit.phases) > 0 and briefest(correction.orbit) < BRIEF_CONTACT
        digits = (
            PARAMETER_SHARE * operator.rounding if brief and isinstance(operator, CondensedOperator) else 0.0
        )
        how = Halving(only_at_points=exempted, solved=beside, lengths=True, digits=digits)
        found = deferred(self._brief, problem, correction.orbit, tangent, spectrum, how)
        missing = self._misheld(problem.system, correction.orbit, found)
        if missing:
            return replace(found, orbit=missing)
        if beside.known is None or not correction.orbit.mesh.events:
            return found
        variation = spectrum.apart(beside.known[0].fundamental[-1])
        named = shallow(found)
        if isinstance(operator, CondensedOperator):
            share = min(1.0, operator.rounding / max(found.orbit, found.parameter, operator.rounding))
            named["rounding"] = max(found.rounding, share * found.by_orbit)
        return ContactError(**named, variation=variation)

    def settles(self, system: System) -> bool:
        """Return whether motion may stick: time stepping is cheap in modes, and finds where it sticks."""
        return bool(slides_of(system))

    @staticmethod
    def _exempted(system: System, operator: Operator | None) -> NDArray[np.bool_] | None:
        """States that count at mesh points alone, (N, n); where forces jump, not in active intervals."""
        if not isinstance(operator, CondensedOperator):
            return None
        found = np.zeros(operator.orbit.nodes[1:].shape, dtype=bool)
        found[:, list(exempt(system))] = True
        if jumps_of(system):
            found[operator.system.held] = False
        return found

    def _brief(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        given = SplitLinearisation.about(system, orbit, free, self.tolerance)
        return CondensedOperator(given, event_rows(system, orbit, free), brief=True)

    def spectrum(self, correction: Correction, trivial: int) -> Spectrum:
        """Return the leading Floquet multipliers."""
        operator = correction.operator
        leading = operator.leading if isinstance(operator, CondensedOperator) else None
        return LeadingSpectrum(correction.fundamental, trivial, leading)

    def refine(self, system: System, orbit: Orbit, error: ErrorEstimate) -> Refinement:
        """Say to which events the mesh should be tied, and how many intervals it needs."""
        return CondensedRefinement(self, system, orbit, error)


def mesh_method(system: System) -> MeshMethod:
    """Return the collocation method for a system: condensed to its places if it has a linear part."""
    return CondensedCollocation() if linear_of(system) is not None else Collocation()
