"""The error estimate of a condensed orbit: its residual on the halved mesh, the correction on its own mesh.

Between collocation points the exact motion x under the forces f leaves a residual e = F(x) - f, evaluated on
the mesh with every interval halved. Of the forces' error d, (1 - F' G) d = e, the part e itself oscillates
within intervals; the rest g = d - e is smooth,

    (1 - F' G) g = F' G e,

and is solved for on the orbit's own mesh: no matrix is set up on the halved one (two grids: Atkinson,
The Numerical Solution of Integral Equations of the Second Kind, 1997, 6.2). Multipliers likewise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.floquet import Leading
from periodic.condensed.linearised import Local, local_rows
from periodic.condensed.operator import CondensedOperator
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.error import UNKNOWN, ErrorEstimate, unit_of
from periodic.correction.newton import Equations, LinearisedEquations
from periodic.correction.outcome import FAILURES
from periodic.correction.problem import Problem
from periodic.linear.unknowns import Increment, size_of
from periodic.orbit.construction import bisect
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Spectrum


@dataclass(frozen=True)
class ContactError(ErrorEstimate):
    """Errors of an orbit with event nodes.

    variation: part of the multipliers' error from the linearised motion; the orbit's own error adds the rest.
    """

    variation: float = 0.0


def applies(operator: CondensedOperator) -> bool:
    """Return whether the estimate applies to an orbit: one without own states and event nodes."""
    return not len(operator.given.others) and not len(operator.orbit.phases)


def estimate(
    problem: Problem, operator: CondensedOperator, tangent: Increment, spectrum: Spectrum
) -> ErrorEstimate:
    """Return the errors of a converged orbit, held on the arclength constraint normal to its tangent."""
    orbit = operator.orbit
    arclength = ArclengthConstraint(orbit, tangent, 0.0, problem.units(orbit), problem.index, size_of(orbit))
    try:
        missing = _Missing(problem, operator)
        rows = [c.linearise(problem.system, orbit, problem.free) for c in problem.side_conditions(orbit)]
        rows.append(arclength.linearise(problem.system, orbit, problem.free))
        states, answer = missing.states, operator.answered(rows, missing.on_own(missing.states))
        multiplier = spectrum.apart(missing.monodromy(operator.leading))
    except FAILURES:
        return UNKNOWN
    part = operator.given.part
    smooth = answer.stages[:, :, list(part.states)] - missing.on_own(states)
    between = np.abs(missing.gap + states + missing.on_fine(smooth))
    displacements = [k for k, state in enumerate(part.states) if state not in part.velocities]
    apart = max(between[:, :, displacements].max(initial=0.0), float(np.abs(answer.nodes).max()))
    largest = unit_of(problem.value(orbit), problem.scale)
    parameter = float(abs(answer.parameter) / largest)
    return ErrorEstimate(float(apart) / max(orbit.span(), LEAST_SPAN), multiplier, parameter)


class OneSided:
    """Equations linearised one after the other at orbits that differ by their errors, see `deferred`.

    An orbit close to a contact may reach it by its error alone: then the first linearisation stands, whose
    contacts are those of the mesh.
    """

    def __init__(self) -> None:
        self.known: tuple[LinearisedEquations, NDArray[np.int_]] | None = None  # the first, and its contacts

    def __call__(self, equations: Equations, orbit: Orbit) -> LinearisedEquations:
        """Return the equations linearised at an orbit, and solved. Raises FAILURES."""
        step = equations.step(orbit)
        operator, kernel = step.operator, step.kernel
        assert isinstance(operator, CondensedOperator) and kernel is not None
        held = operator.system.held
        if self.known is not None and not np.array_equal(held, self.known[1]):
            return self.known[0]
        found = LinearisedEquations(operator.orbit, step.increment, kernel, operator.fundamental)
        self.known = self.known or (found, held)
        return found


class _Missing:
    """The residual of an orbit on the halved mesh.

    gap (N, a, s): exact motion under its forces less the interpolated orbit; states (N, a, s): states at the
    places due to the residual of the forces.
    """

    def __init__(self, problem: Problem, operator: CondensedOperator) -> None:
        given, fine = operator.given, bisect(operator.orbit)
        self.given, self.places, forces = given, list(given.part.states), list(given.part.forces)
        scheme = fine.mesh.scheme
        self.response = replace(given.response, scheme=scheme, grid=fine.grid, period=fine.mesh.period)
        exact = self.response.stages(np.ascontiguousarray(fine.algebraic[:, :, forces]))
        self.gap = exact - fine.stages[:, :, self.places]
        fine.stages[:, :, self.places] = exact
        self.local: Local = local_rows(problem.system, given.part, fine, ())
        missing = self.local.forces[:, :, 0].reshape(*exact.shape[:2], -1)
        self.states = self.response.stages(np.ascontiguousarray(missing))
        points = scheme.points
        self.half = (points >= 0.5).astype(int)
        self.later = scheme.basis(2 * points - self.half)
        self.halves = scheme.basis(np.concatenate([points / 2, (1 + points) / 2]))
        self.forces_at = scheme.algebraic_basis(np.concatenate([points / 2, (1 + points) / 2]))

    def on_own(self, states: Array) -> Array:
        """Return states on the halved mesh, periodic, at the orbit's own points."""
        begun = np.concatenate([states[-1:, -1], states[:-1, -1]])[:, None]
        knots = np.concatenate([begun, states], axis=1)
        pairs = knots.reshape(len(knots) // 2, 2, *knots.shape[1:])[:, self.half]
        return np.asarray(np.einsum("ak,nak...->na...", self.later, pairs))

    def on_fine(self, states: Array) -> Array:
        """Return states at the orbit's own points, periodic, on the halved mesh."""
        begun = np.concatenate([states[-1:, -1], states[:-1, -1]])[:, None]
        knots = np.concatenate([begun, states], axis=1)
        found = np.einsum("ak,nk...->na...", self.halves, knots)
        return np.asarray(found.reshape(2 * len(states), *states.shape[1:]))

    def monodromy(self, leading: Leading) -> Array:
        """Return M of the halved mesh in the subspace of the leading multipliers, (r, r)."""
        floquet, basis = leading.floquet, leading.basis
        begun = floquet.modes(basis)
        own = floquet.forces(floquet.answers(basis))
        forces = np.einsum("ab,nbkr->nakr", self.forces_at, own)
        forces = np.ascontiguousarray(forces.reshape(2 * len(own), *own.shape[1:]))
        shown, _ = self.response.motions(forces, begun)
        count, points, _, r = shown.shape
        n = self.given.orbit.nodes.shape[1]
        by_place = self.local.forces[:, :, [1 + n + k for k in self.places]]
        wanted = by_place @ shown.reshape(count * points, -1, r)
        missing = wanted.reshape(forces.shape) - forces
        states, modes = self.response.motions(missing, np.zeros_like(begun))
        begun_at = np.zeros_like(states[:1, :1])
        knots = np.concatenate([np.concatenate([begun_at, states[:-1, -1:]]), states], axis=1)
        pairs = knots.reshape(count // 2, 2, *knots.shape[1:])[:, self.half]
        at_own = np.einsum("ak,nak...->na...", self.later, pairs)
        return np.asarray(leading.monodromy + basis.T @ floquet.left(at_own, modes))
