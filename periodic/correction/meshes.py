"""What a discretisation would change of an orbit's mesh, and the mesh that spreads its error evenly."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from periodic.correction.error import ErrorEstimate
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array

AIM = 0.1
"""The part of the tolerance that a new mesh aims at."""


class Refinement:
    """What is to be done to the mesh of an orbit: as it stands, nothing. Discretisations override it."""

    def __init__(self, orbit: Orbit, error: ErrorEstimate) -> None:
        self.orbit, self.error = orbit, error

    @property
    def fits(self) -> bool:
        """Whether the mesh is tied to just the events that it should be."""
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
        """Return a mesh that suits the orbit, with the event nodes that it has."""
        return self.orbit.mesh

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield meshes made for the orbit, with their event nodes' phases, the best first."""
        yield from ()


def wanted_ntst(orbit: Orbit, error: ErrorEstimate, tolerance: float, least: int, most: int) -> int:
    """Return the number of intervals that brings the error estimate to its aim."""
    order = orbit.mesh.scheme.ncol + 1
    ratio = error.curable / (AIM * tolerance) if np.isfinite(error.worst) else 4.0**order
    factor = float(np.clip(ratio, 2.0**-order, 2.5**order)) ** (1 / order)
    return int(np.clip(np.ceil(factor * orbit.mesh.ntst), least, most))
