"""The boundary to mesh refinement: what a discretisation would change of an orbit's mesh."""

from __future__ import annotations

from collections.abc import Iterator

from periodic.correction.error import ErrorEstimate
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array


class Refinement:
    """Changes to the mesh of an orbit: none in this class, which discretisations override.

    Parameters
    ----------
    orbit : Orbit
        A converged orbit.
    error : ErrorEstimate
        Its errors.
    """

    def __init__(self, orbit: Orbit, error: ErrorEstimate) -> None:
        self.orbit, self.error = orbit, error

    @property
    def fits(self) -> bool:
        """Whether the mesh is tied to just the events that it should be."""
        return True

    @property
    def mendable(self) -> bool:
        """Whether other meshes may reduce the error; not where the orbit violates its word."""
        return True

    @property
    def exhausted(self) -> bool:
        """Whether the mesh is the finest allowed."""
        return True

    @property
    def shortfall(self) -> str:
        """By how much the orbit misses the tolerance, and on which mesh."""
        return f"error estimate {self.error.motion:.1e} with {self.orbit.mesh.ntst} intervals"

    def refined(self) -> Mesh:
        """Return a mesh that suits the orbit.

        Returns
        -------
        Mesh
            The mesh, with the event nodes that the orbit has.
        """
        return self.orbit.mesh

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield meshes made for the orbit.

        Yields
        ------
        Mesh
            A mesh, the best first.
        ndarray, shape (k,)
            Phases of its event nodes, in rad.
        """
        yield from ()
