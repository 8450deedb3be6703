"""What continuation asks of a discretisation: how an orbit is represented, solved for and refined.

Every method works on `periodic.orbit.Orbit`: values at mesh points and, within each interval, at the points
of its scheme. `periodic.solve` has the steps that all methods share.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Protocol

from periodic.accuracy import ErrorEstimate
from periodic.anchors import Crossing
from periodic.closure import Closure, Plane
from periodic.mesh import Mesh
from periodic.newton import Correction, NewtonSettings
from periodic.orbit import Orbit
from periodic.rotation import Turn
from periodic.scheme import Array, Scheme
from periodic.settings import MeshSettings
from periodic.system import System

if TYPE_CHECKING:
    from periodic.events import Test
    from periodic.solve import Solved, Task


class Method(Protocol):
    """A discretisation."""

    @property
    def passages(self) -> tuple[Test, ...]:
        """Test functions of the special points that it locates, turns (LP) apart."""

    @property
    def branching(self) -> tuple[Test, ...]:
        """Those that are looked for only where the branch does not turn."""

    @property
    def schemes(self) -> tuple[Scheme, ...]:
        """Schemes with which a first orbit is looked for if Newton does not find it with the wanted one."""

    def rest(self, system: System, settings: MeshSettings, parameter: Array) -> Orbit:
        """Return the constant orbit at the system's rest values: the usual first guess."""

    def adopted(self, system: System, settings: MeshSettings, guess: Orbit, parameter: Array) -> Orbit:
        """Return a guess from any method in this one's representation, at given parameters."""

    def correct(
        self,
        system: System,
        guess: Orbit,
        free: tuple[int, ...],
        closures: Sequence[Closure],
        settings: NewtonSettings,
    ) -> Correction:
        """Solve for the orbit near `guess`, with the parameters `free` closed by as many closures."""

    def estimate(self, task: Task, correction: Correction, plane: Plane) -> ErrorEstimate:
        """Estimate the errors of a converged orbit, held on a plane."""

    def wanted(self, task: Task, orbit: Orbit, error: ErrorEstimate) -> list[Crossing]:
        """Return the crossings of switches to which the mesh should be tied."""

    def genuine(self, system: System, orbit: Orbit) -> bool:
        """Whether what the mesh is tied to is still there."""

    def exhausted(self, settings: MeshSettings, orbit: Orbit) -> bool:
        """Whether an orbit's mesh is the finest allowed."""

    def shortfall(self, task: Task, solved: Solved) -> str:
        """Say by how much an orbit misses the tolerance, and on which mesh."""

    def meshes(self, task: Task, solved: Solved) -> Iterator[tuple[Mesh, Array]]:
        """Yield meshes made for an orbit, with their anchors' phases, the best first."""

    def mesh_for(self, task: Task, new: Solved) -> Mesh:
        """Return a mesh that suits an orbit, with the anchors that it has."""

    def guesses(self, task: Task, old: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield guesses for an orbit carried to another mesh, the best first."""

    def turned(self, base: Correction, new: Correction) -> Turn:
        """How far multipliers turn between two orbits."""
