"""Mesh selection: intervals are halved until each carries a like share of the interpolation error.

The (ncol+1)-th derivative is estimated from the jumps of the ncol-th between neighbours of one segment
(de Boor; Russell & Christiansen 1978), never across an event node.
"""

from __future__ import annotations

import numpy as np

from periodic.orbit.mesh import MIN_INTERVALS, EventNode, Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array

FLOOR = 0.2
"""Part of the mean density that every interval keeps, so that none grows without bound."""

MAX_HALVINGS = 40
"""Bound on how often a segment is halved."""

SPLIT = 1.4
"""An interval is halved where it would hold more than this many intervals of the wanted density."""

GROWTHS = tuple(1.1**k for k in range(8))
"""Factors tried on the density until halving gives as many intervals as wanted."""


def density(orbit: Orbit) -> Array:
    """Return the mesh density wanted in each interval, shape (N,), in intervals per unit of tau."""
    width, ncol = orbit.grid.width, orbit.mesh.scheme.ncol
    top = np.einsum("l,jln->jn", orbit.mesh.scheme.barycentric, orbit.knots) / width[:, None] ** ncol
    order = 1 / (ncol + 1)
    wanted = np.empty(len(width))
    first = 0
    for breaks in orbit.mesh.breaks:
        part = slice(first, first + len(breaks) - 1)
        wanted[part] = _jumps(top[part], width[part], closed=not orbit.mesh.events) ** order
        first = part.stop
    mean = float(wanted @ width) / orbit.mesh.period
    return np.maximum(wanted, FLOOR * mean) if mean > 0 else np.ones(len(width))


def _jumps(top: Array, width: Array, closed: bool) -> Array:
    """Size of the next derivative in each interval of a segment, from the jumps at its two ends."""
    if len(width) == 1:
        return np.linalg.norm(top, axis=1) / width
    jump = np.linalg.norm(np.diff(top, axis=0), axis=1) * 2 / (width[1:] + width[:-1])
    left, right = np.append(jump[0], jump), np.append(jump, jump[-1])
    if closed:
        left[0] = right[-1] = np.linalg.norm(top[0] - top[-1]) * 2 / (width[0] + width[-1])
    return np.maximum(left, right)


def redistribute(
    orbit: Orbit,
    ntst: int,
    events: tuple[EventNode, ...],
    phases: Array,
    shortest: float,
    demand: Array | None = None,
) -> Mesh:
    """Return a mesh of about `ntst` intervals for an orbit, with the given event nodes at `phases`.

    No interval shorter than `shortest` (rad) is halved. There are more where `demand`, in intervals per rad
    about each of the orbit's intervals, is larger than the density.

    Each segment is halved again and again where the density requires it. Its intervals are therefore the
    same from one mesh to the next wherever the density has hardly changed, and the orbit is carried over
    without any error there, as Newton's method needs close to a kink.
    """
    wanted = density(orbit)
    wanted *= ntst / float(wanted @ orbit.grid.width)
    if demand is not None:
        wanted = np.maximum(wanted, demand)
        ntst = round(float(wanted @ orbit.grid.width))
    for growth in GROWTHS:
        mesh = spread(orbit, growth * wanted, events, phases, shortest)
        if mesh.ntst >= ntst:
            break
    return mesh


def spread(
    orbit: Orbit, wanted: Array, events: tuple[EventNode, ...], phases: Array, shortest: float
) -> Mesh:
    """Return a mesh for an orbit as `redistribute` does, of a density (N,) in intervals per unit of tau.

    No interval holds more than SPLIT intervals of that density.
    """
    period = orbit.mesh.period
    edges = np.append(orbit.grid.left, orbit.grid.left[0] + period)
    curve = np.array([edges, np.append(0.0, np.cumsum(wanted * orbit.grid.width))])
    begins = phases if events else np.zeros(1)
    ends = np.append(begins[1:], begins[0] + period)
    breaks = tuple(_halved(begin, end, curve, shortest) for begin, end in zip(begins, ends, strict=True))
    return Mesh(orbit.mesh.scheme, breaks, events, period, orbit.mesh.modes)


def _halved(begin: float, end: float, curve: Array, shortest: float) -> Array:
    """Breaks of one segment, halved where an interval holds more than SPLIT of the curve's intervals."""
    sigma = np.linspace(0.0, 1.0, MIN_INTERVALS + 1)
    for _ in range(MAX_HALVINGS):
        share = np.diff(_cumulative(begin + sigma * (end - begin), *curve))
        long = np.diff(sigma) * (end - begin) > shortest
        middle = (sigma[1:] + sigma[:-1])[(share > SPLIT) & long] / 2
        if len(middle) == 0:
            break
        sigma = np.sort(np.append(sigma, middle))
    return sigma


def _cumulative(tau: Array, edges: Array, total: Array) -> Array:
    """Integral of the density from edges[0] to tau, continued periodically."""
    turns, rest = np.divmod(tau - edges[0], edges[-1] - edges[0])
    return turns * total[-1] + np.interp(rest + edges[0], edges, total)
