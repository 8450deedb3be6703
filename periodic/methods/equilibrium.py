"""Equilibria: orbits that are constant, 0 = R(0, x, z, p), so that they are continued as orbits are.

What the multipliers are to an orbit, the eigenvalues lambda of d(dx)/dt = J dx are to an equilibrium. With
' = d/dtau and d/dt = omega d/dtau, J is the upper part of -omega [R_x' R_z]^-1 R_x.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from periodic import stationary
from periodic.accuracy import ErrorEstimate
from periodic.anchors import Crossing
from periodic.closure import Closure, Plane
from periodic.equilibrium import increment
from periodic.mesh import Mesh, uniform
from periodic.newton import Correction, NewtonSettings, Outcome, correct
from periodic.orbit import FORCED, Orbit, constant
from periodic.rotation import Turn
from periodic.scheme import Array
from periodic.settings import MeshSettings
from periodic.system import System

if TYPE_CHECKING:
    from periodic.solve import Solved, Task

PHASES = np.linspace(0.0, FORCED, 8) + 0.1
"""At which an excitation shows."""


@dataclass(frozen=True)
class Equilibrium:
    """See `periodic.methods.protocol.Method`; `frequency` is the index of the parameter omega."""

    frequency: int

    passages = stationary.PASSAGES
    branching = ()
    schemes = ()

    def rest(self, system: System, settings: MeshSettings, parameter: Array) -> Orbit:
        """Return the system's rest values as an equilibrium."""
        return self._at(system, settings, *system.rest(parameter), parameter)

    def adopted(self, system: System, settings: MeshSettings, guess: Orbit, parameter: Array) -> Orbit:
        """Return the state and the unknowns with which a guess begins as an equilibrium."""
        return self._at(system, settings, guess.nodes[0], guess.algebraic[0, 0], parameter)

    def _at(
        self, system: System, settings: MeshSettings, state: Array, algebraic: Array, parameter: Array
    ) -> Orbit:
        _refuse_excitation(system, state, algebraic, parameter)
        mesh = uniform(settings.scheme, 1)
        return replace(constant(mesh, state, algebraic, parameter), equilibrium=True)

    def correct(
        self,
        system: System,
        guess: Orbit,
        free: tuple[int, ...],
        closures: Sequence[Closure],
        settings: NewtonSettings,
    ) -> Correction:
        """Solve for the equilibrium near `guess`; its `fundamental` is J in 1/s, shape (1, n, n)."""
        found = correct(system, guess, free, closures, settings, increment=increment)
        if found.outcome is not Outcome.CONVERGED:
            return found
        omega = float(found.orbit.parameter[self.frequency])
        return replace(found, fundamental=omega * found.fundamental)

    def estimate(self, task: Task, correction: Correction, plane: Plane) -> ErrorEstimate:
        """Return zeros: nothing is discretised."""
        return ErrorEstimate(0.0, 0.0)

    def wanted(self, task: Task, orbit: Orbit, error: ErrorEstimate) -> list[Crossing]:
        """Return nothing: an equilibrium crosses no switch."""
        return []

    def genuine(self, system: System, orbit: Orbit) -> bool:
        """There is nothing that the mesh is tied to."""
        return True

    def exhausted(self, settings: MeshSettings, orbit: Orbit) -> bool:
        """There is no finer mesh."""
        return True

    def shortfall(self, task: Task, solved: Solved) -> str:
        """Return the residual: nothing is discretised."""
        return f"residual {solved.correction.residual:.1e}"

    def meshes(self, task: Task, solved: Solved) -> Iterator[tuple[Mesh, Array]]:
        """Yield nothing: every equilibrium has the same mesh."""
        return iter(())

    def mesh_for(self, task: Task, new: Solved) -> Mesh:
        """Return the only mesh."""
        return new.orbit.mesh

    def guesses(self, task: Task, old: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the equilibrium itself."""
        yield old

    def turned(self, base: Correction, new: Correction) -> Turn:
        """Nothing is in tune with anything."""
        return Turn(0.0)


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
