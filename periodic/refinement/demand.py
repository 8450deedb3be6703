"""How many intervals an orbit needs: for its own error, and for that of its multipliers."""

from __future__ import annotations

import numpy as np

from periodic.correction.error import SAFETY, ErrorEstimate
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.refinement.equidistribution import SPLIT, density
from periodic.system.precision import EPSILON

AIM = 0.1
"""The part of the tolerance that a new mesh aims at, for the orbit and for the multipliers."""

AIM_WITH_KINKS = 0.03
"""The same for orbits with kinks, where the multipliers have their intervals and few are left to be spent."""

ROUNDING = 1e4 * EPSILON
"""What all shares may add up to by rounding, over the largest multiplier: as small ones ask for nothing,"""

FAINT = 1e-3
"""... if they are also below this part of their goal."""

MOST_PIECES = 3.0
"""Into how many pieces an interval is divided at the most."""


UNEVEN = 0.4
"""Part of the intervals that evenly spread err as little, at the least."""


def demand(orbit: Orbit, error: ErrorEstimate, tolerance: float, most: int) -> Array | None:
    """Return how many intervals per rad the multipliers need about each interval, shape (N,).

    None where it is not known from which intervals their error comes. An interval is divided as its share of
    the error asks for, but joined with others no faster than on a smooth motion, where errors at mesh points
    go with twice the power. Where a share may be rounding the orbit's own density says what is needed.
    """
    if error.shares is None or not np.isfinite(error.worst):
        return None
    largest = error.multiplier - error.by_orbit if error.multiplier > SAFETY * error.rounding else 0.0
    goal, total = AIM * tolerance / SAFETY, float(error.shares.sum())
    part = error.shares / total * max(largest, 0.0) / goal * len(error.shares) if total > 0 else error.shares
    ncol = orbit.mesh.scheme.ncol
    pieces = np.where(part > 1, part ** (1 / (ncol + 1)), part ** (1 / (2 * ncol)))
    pieces[part < min(ROUNDING / goal, FAINT)] = 0.0
    wanted: Array = np.minimum(pieces, MOST_PIECES) / orbit.grid.width
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
    ratio = (
        curable / ((AIM_WITH_KINKS if known else AIM) * tolerance) if np.isfinite(error.worst) else 4.0**order
    )
    factor = float(np.clip(ratio, 2.0**-order, 2.5**order)) ** (1 / order)
    return int(np.clip(np.ceil(factor * begun), least, most))


def evenly(orbit: Orbit) -> float:
    """Return how many intervals, where none has more than its share, err no more than the worst does now.

    Beside a kink that has moved since the mesh was made they are far fewer than there are.
    """
    part = density(orbit) * orbit.grid.width
    ntst = orbit.mesh.ntst
    return float(np.clip(SPLIT * part.sum() / part.max(), UNEVEN * ntst, ntst))
