"""The arclength constraint: a step of given length along the tangent, in a metric independent of the mesh."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.linear.unknowns import Increment, length_metric, metric_weights, node_phase_gradient, outer
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, jumps_of, resets_of


@dataclass(frozen=True)
class ArclengthConstraint:
    """<u - origin, direction> = distance, the hyperplane normal to `direction` (Keller 1977).

    The scalar product is that of `Increment.dot`: the mean over the period of <x, y>/size^2, x and y at fixed
    tau, plus p q / scale^2 of the free parameters (`index` is the first one's), plus the part of the lengths
    of brief excursions.
    """

    origin: Orbit
    direction: Increment
    distance: float
    scale: float | Array
    index: int
    size: float = 1.0

    @cached_property
    def weighted(self) -> Array:
        """Gradient in the states at the mesh points, shape (N+1, n)."""
        return (metric_weights(self.origin) / self.size**2)[:, None] * self.direction.profile

    @cached_property
    def lengths(self) -> Array:
        """Gradient in the event nodes' phases by brief excursions' lengths, shape (k,)."""
        return length_metric(self.origin, self.direction.phases)

    @cached_property
    def _rates(self) -> Array:
        """Gradient in the free parameters, shape (q,); 0 but for the first where `scale` is a number."""
        own, scale = self.direction.parameters, self.scale
        if isinstance(scale, np.ndarray):
            return np.append(own, np.zeros(len(scale) - len(own))) / scale**2
        return np.append(own[:1] / scale**2, np.zeros(self.origin.parameter.size - 1))

    def rate(self, direction: Increment) -> float:
        """How fast the distance grows along a direction on the origin's mesh."""
        weighted, lengths = self._gradient(self.origin, (), self.origin.node_rates)
        states = np.vdot(weighted, direction.nodes) + lengths @ direction.phases
        return float(states) + outer(self.direction, direction, self.scale)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient; the origin is evaluated at the orbit's present mesh points."""
        state, slope = self._origin_at(system, orbit)
        weighted, outer = self._gradient(orbit, free, slope)
        further = orbit.parameter[list(free)] - self.origin.parameter[list(free)]
        value = np.einsum("jn,jn->", weighted, orbit.nodes - state)
        value += outer[len(orbit.phases) :] @ further
        value += self.lengths @ (orbit.phases - self.origin.phases)
        return Row(float(value) - self.distance, weighted, outer)

    def _origin_at(self, system: System, orbit: Orbit) -> tuple[Array, Array]:
        """States and slopes of the origin at an orbit's mesh points, by its tangents where there are jumps.

        Without jumps the error of tangents, of second order in the shift, would matter: it is as large as the
        branch's own motion while an excursion ends.
        """
        origin = self.origin
        way = node_phase_gradient(orbit) @ (orbit.phases - origin.phases)
        if not way.any():
            return origin.nodes, origin.node_rates
        if resets_of(system) or jumps_of(system):
            return origin.nodes + way[:, None] * origin.node_rates, origin.node_rates
        return _in_own_segments(origin, orbit.mesh.nodes(orbit.phases))

    def _gradient(self, orbit: Orbit, free: tuple[int, ...], slope: Array) -> tuple[Array, Array]:
        weighted = self.weighted
        k = len(orbit.phases)
        outer = np.zeros(k + len(free))
        outer[:k] = self.lengths - np.einsum("jn,jn,jk->k", weighted, slope, node_phase_gradient(orbit))
        outer[k : k + len(free)] = self._rates[: len(free)]
        return weighted, outer


def _in_own_segments(origin: Orbit, at: Array) -> tuple[Array, Array]:
    """States and slopes of an orbit at its moved mesh points, beyond a segment by the tangent at its end.

    A point must not take states of another segment: one in contact would take those of the flight before it.
    An event node is in the longer of its two segments.
    """
    mesh, grid, length = origin.mesh, origin.grid, origin.mesh.segment_lengths(origin.phases)
    own = np.searchsorted(mesh.starts, np.arange(mesh.ntst), side="right") - 1
    segment, previous = own.copy(), np.arange(-1, len(length) - 1) % len(length)
    longer = length[previous] > length
    segment[mesh.starts[longer]] = previous[longer]
    tau = at[:-1] + mesh.period * (segment > own)  # the last segment is before the first
    inside = np.clip(tau, origin.phases[segment], origin.phases[segment] + length[segment])
    first, last = mesh.starts[segment], np.append(mesh.starts[1:], mesh.ntst)[segment] - 1
    index = np.clip(np.searchsorted(grid.left, inside, side="right") - 1, first, last)
    basis = mesh.scheme.basis((inside - grid.left[index]) / grid.width[index])
    slope = np.einsum("tl,tln->tn", basis, origin.knot_rates[index])
    state = np.einsum("tl,tln->tn", basis, origin.knots[index]) + (tau - inside)[:, None] * slope
    return np.concatenate([state, state[:1]]), np.concatenate([slope, slope[:1]])
