"""What a discretisation would change of an orbit's mesh, and the mesh that spreads its error evenly."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from periodic.correction.error import ROUNDED, SAFETY, ErrorEstimate
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.redistribution import SPLIT, density
from periodic.orbit.scheme import Array

AIM = 0.1
"""The part of the tolerance that a new mesh aims at."""

CLOSER = 0.03
"""The same for orbits with kinks, where the multipliers have their intervals and few are left to be spent."""

SHARED = 0.1
"""The same for the multipliers, to whose error each interval adds its share."""

ROUNDING = 1e4 * float(np.finfo(float).eps)
"""What all shares may add up to by rounding, over the largest multiplier: as small ones ask for nothing,"""

FAINT = 1e-3
"""... if they are also below this part of their goal."""

FINEST = 3.0
"""Into how many pieces an interval is divided at the most."""


UNEVEN = 0.4
"""Part of the intervals that evenly spread err as little, at the least."""


class Refinement:
    """What is to be done to the mesh of an orbit: as it stands, nothing. Discretisations override it.

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


def demand(orbit: Orbit, error: ErrorEstimate, tolerance: float, most: int) -> Array | None:
    """Return how many intervals per rad the multipliers need about each interval, shape (N,).

    None where it is not known from which intervals their error comes. An interval is divided as its share of
    the error asks for, but joined with others no faster than on a smooth motion, where errors at mesh points
    go with twice the power. Where a share may be rounding the orbit's own density says what is needed.
    """
    if error.shares is None or not np.isfinite(error.worst):
        return None
    largest = error.multiplier - error.by_orbit if error.multiplier > ROUNDED * error.rounding else 0.0
    goal, total = SHARED * tolerance / SAFETY, float(error.shares.sum())
    part = error.shares / total * max(largest, 0.0) / goal * len(error.shares) if total > 0 else error.shares
    ncol = orbit.mesh.scheme.ncol
    pieces = np.where(part > 1, part ** (1 / (ncol + 1)), part ** (1 / (2 * ncol)))
    pieces[part < min(ROUNDING / goal, FAINT)] = 0.0
    wanted: Array = np.minimum(pieces, FINEST) / orbit.grid.width
    intervals = float(wanted @ orbit.grid.width)
    return wanted * min(1.0, most / intervals) if intervals > 0 else None


def wanted_ntst(
    orbit: Orbit, error: ErrorEstimate, tolerance: float, least: int, most: int, begun: float
) -> int:
    """Return how many intervals bring the error estimate to its aim, but for what `demand` cures.

    begun: how many, spread anew, err as much as the orbit's own do now.
    """
    order = orbit.mesh.scheme.ncol + 1
    known = error.shares is not None
    curable = min(error.curable, error.spread) if known else error.curable
    ratio = curable / ((CLOSER if known else AIM) * tolerance) if np.isfinite(error.worst) else 4.0**order
    factor = float(np.clip(ratio, 2.0**-order, 2.5**order)) ** (1 / order)
    return int(np.clip(np.ceil(factor * begun), least, most))


def evenly(orbit: Orbit) -> float:
    """Return how many intervals, where none has more than its share, err no more than the worst does now.

    Beside a kink that has moved since the mesh was made they are far fewer than there are.
    """
    part = density(orbit) * orbit.grid.width
    ntst = orbit.mesh.ntst
    return float(np.clip(SPLIT * part.sum() / part.max(), UNEVEN * ntst, ntst))
