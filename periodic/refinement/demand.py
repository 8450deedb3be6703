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
"""The same for orbits with kinks, where `demand` gives the multipliers intervals of their own."""

ROUNDING = 1e4 * EPSILON
"""Rounding in the sum of all shares, over the largest multiplier: smaller shares demand no intervals,"""

FAINT = 1e-3
"""... if they are also below this part of their goal."""

MOST_PIECES = 3.0
"""Into how many pieces an interval is divided at the most."""


UNEVEN = 0.4
"""Least part of the present number of intervals that `evenly` returns."""


def demand(orbit: Orbit, error: ErrorEstimate, tolerance: float, most: int) -> Array | None:
    """Return how many intervals per rad the multipliers need about each interval, shape (N,).

    None where it is not known from which intervals their error comes. An interval is divided as its share of
    the error requires, but joined with others no faster than on a smooth motion, where errors at mesh points
    have order 2 ncol. Where a share may be rounding there is no demand: the orbit's own density decides.
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
    """Return how many intervals bring the error estimate to its aim, but for errors that `demand` reduces.

    begun: the number of intervals that, distributed anew, give the present error.
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
    """Return how many intervals of equal shares have errors no larger than the worst one's now.

    They are far fewer than at present where a kink has moved since the mesh was made.
    """
    part = density(orbit) * orbit.grid.width
    ntst = orbit.mesh.ntst
    return float(np.clip(SPLIT * part.sum() / part.max(), UNEVEN * ntst, ntst))
