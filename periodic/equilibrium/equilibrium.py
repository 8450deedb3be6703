"""Equilibria: orbits that are constant, 0 = R(0, x, z, p), so that they are continued as orbits are.

What the multipliers are to an orbit, the eigenvalues lambda of d(dx)/dt = J dx are to an equilibrium. With
' = d/dtau and d/dt = omega d/dtau, J is the upper part of -omega [R_x' R_z]^-1 R_x.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from periodic.correction.discretisation import Discretisation
from periodic.correction.error import EXACT, ErrorEstimate
from periodic.correction.newton import Correction
from periodic.correction.problem import Problem
from periodic.correction.refinement import Refinement
from periodic.equilibrium.linearise import linearise
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import constant
from periodic.orbit.layout import layout_of
from periodic.orbit.mesh import Mesh, uniform
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.stability.multipliers import Spectrum, Stability
from periodic.system import System, index_of

PHASES = np.linspace(0.0, FORCED, 8) + 0.1
"""At which it is tested whether the equations depend on tau."""


@dataclass(frozen=True)
class Equilibrium(Discretisation):
    """The method for equilibria: 0 = R(0, x, z, p).

    Parameters
    ----------
    frequency : str
        Name of the parameter omega with d/dt = omega d/dtau, for eigenvalues in 1/s.
    """

    frequency: str = "omega"

    @property
    def stability(self) -> Stability:
        """Eigenvalues."""
        return Stability.EIGENVALUES

    def check(self, problem: Problem) -> None:
        """Refuse a frequency that is no parameter, and a branch over the frequency. Raises ValueError."""
        names = [p.name for p in problem.system.parameters]
        if self.frequency not in names:
            raise ValueError(
                f"frequency is {self.frequency!r}; it must be one of the parameters {', '.join(names)}"
            )
        if self.frequency == problem.parameter:
            raise ValueError(
                f"parameter is {self.frequency!r}, the frequency; equilibria do not depend on it"
            )

    def guess(self, system: System, parameter: Array, near: Orbit | None) -> Orbit:
        """Return the system's rest values, or the state with which an orbit begins, as an equilibrium.

        Raises ValueError for equations that depend on tau.
        """
        state, algebraic = system.rest(parameter) if near is None else (near.nodes[0], near.algebraic[0, 0])
        _refuse_excitation(system, state, algebraic, parameter)
        return replace(
            constant(uniform(Scheme(), 1), state, algebraic, parameter, layout_of(system)), equilibrium=True
        )

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the equations of the equilibrium."""
        return linearise(system, orbit, free)

    def accepted(self, system: System, correction: Correction) -> Correction:
        """Return it with J in 1/s as its `fundamental`, shape (1, n, n)."""
        omega = float(correction.orbit.parameter[index_of(system, self.frequency)])
        return replace(correction, fundamental=omega * correction.fundamental)

    def transfer(self, system: System, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the equilibrium itself."""
        yield orbit

    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Return zeros: nothing is discretised."""
        return EXACT

    def refine(self, system: System, orbit: Orbit, error: ErrorEstimate) -> Refinement:
        """Change nothing: every equilibrium has the same mesh."""
        return Refinement(orbit, error)


def _refuse_excitation(system: System, state: Array, algebraic: Array, parameter: Array) -> None:
    """Raise ValueError for equations that depend on tau."""
    x, z = (np.tile(values, (len(PHASES), 1)) for values in (state, algebraic))
    line = system.linearise(np.zeros_like(x), x, z, PHASES, parameter)
    for values in (line.residual, line.d_rate, line.d_state, line.d_algebraic):
        if np.ptp(values, axis=0).max(initial=0.0) > 1e-9 * (1 + np.abs(values).max(initial=0.0)):
            raise ValueError(
                "the system is excited: its equations depend on the phase, and only those that do not have "
                "equilibria; set the excitation to 0"
            )
