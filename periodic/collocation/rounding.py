"""Rounding at stiff or shallow contacts: it affects the multipliers far more than the orbit.

An event node lies where a switch is at its level within the rounding of the terms that cancel in it; beside a
grazing that is a large part of a contact's depth. Within a contact of stiffness k the multipliers have the
rounding of the states k times.
"""

from __future__ import annotations

import numpy as np

from periodic.events.rates import rate_before
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Spectrum
from periodic.system.precision import EPSILON

TERMS = 4
"""Largest error of a switch at its level, in roundings of the terms that cancel in it."""


UNTOLD = 0.1
"""Error of the begin of a contact, over its length, above which the multipliers are not known."""

LIKELY = 2
"""Typical error of a switch at its level, in the same roundings."""


def aside(orbit: Orbit, rows: list[Row]) -> Array:
    """Return how far from their levels rounding leaves the switches of event nodes, shape (k,)."""
    sizes = [float(np.abs(row.nodes * orbit.nodes).sum()) for row in rows]
    return TERMS * EPSILON * np.array(sizes)


def of_states(orbit: Orbit, spectrum: Spectrum) -> float:
    """Return an estimate of the multipliers' error by rounding of the states, where an orbit has kinks.

    That of one mesh point grows with the fastest rate of the fundamental matrices, that of all with the root
    of their number.
    """
    if len(orbit.mesh.exact_ends) == 0:
        return 0.0
    return EPSILON * _fastest(orbit, spectrum) * float(np.sqrt(orbit.mesh.ntst))


def of_events(orbit: Orbit, rows: list[Row], spectrum: Spectrum) -> float:
    """Return an estimate of the multipliers' error by rounding of the phases at which contacts begin and end.

    It grows with the root of the number of mesh points. The multipliers are not known where that error is as
    long as the contact.
    """
    late, off, lengths = 0.0, aside(orbit, rows), orbit.mesh.segment_lengths(orbit.phases)
    for i, (row, start) in enumerate(zip(rows, orbit.mesh.starts, strict=True)):
        slope = abs(float(row.nodes[start] @ rate_before(orbit, i)) + float(row.outer[i]))
        own = float(off[i]) / slope if slope > 0 and orbit.mesh.events[i].level == 0 else 0.0
        if own > UNTOLD * min(lengths[i], lengths[i - 1]):
            return np.inf
        late += own
    if not late:
        return 0.0
    every = float(np.sqrt(orbit.mesh.ntst))
    return _fastest(orbit, spectrum) * late * LIKELY / TERMS * every / spectrum.radius


def _fastest(orbit: Orbit, spectrum: Spectrum) -> float:
    """The fastest rate of the fundamental matrices (1/rad)."""
    size = np.linalg.norm(spectrum.fundamental[:-1], axis=(1, 2))
    change = np.linalg.norm(np.diff(spectrum.fundamental, axis=0), axis=(1, 2))
    left = size > 0  # of one state nothing is left where it slides
    return float((change[left] / (orbit.grid.width * size)[left]).max(initial=0.0))
