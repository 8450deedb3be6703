"""The arclength constraint: a step of given length along the tangent, in a metric that no mesh changes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.linear.unknowns import Increment, mean_weights, node_phase_gradient
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, jumps_of, resets_of


@dataclass(frozen=True)
class ArclengthConstraint:
    """<u - origin, direction> = distance, a hyperplane across `direction` (Keller 1977).

    The scalar product is the mean over the period of <x, y>/size^2, x and y at fixed tau, plus p q / scale^2
    of the continuation parameter, whose index is `index`.
    """

    origin: Orbit
    direction: Increment
    distance: float
    scale: float
    index: int
    size: float = 1.0

    @cached_property
    def weighted(self) -> Array:
        """Gradient in the states at the mesh points, shape (N+1, n)."""
        return (mean_weights(self.origin) / self.size**2)[:, None] * self.direction.profile

    def rate(self, direction: Increment) -> float:
        """How fast the distance grows along a direction on the origin's mesh."""
        weighted, outer = self._gradient(self.origin, (self.index,), self.origin.node_rates)
        along = np.append(direction.phases, direction.parameter)
        return float(np.vdot(weighted, direction.nodes) + outer @ along)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient; mesh points that move meet the origin where they are now."""
        state, slope = self._origin_at(system, orbit)
        weighted, outer = self._gradient(orbit, free, slope)
        further = orbit.parameter[self.index] - self.origin.parameter[self.index]
        value = np.einsum("jn,jn->", weighted, orbit.nodes - state)
        value += self.direction.parameter / self.scale**2 * further
        return Row(float(value) - self.distance, weighted, outer)

    def _origin_at(self, system: System, orbit: Orbit) -> tuple[Array, Array]:
        """States and slopes of the origin at an orbit's mesh points, on its tangents where there are jumps.

        Along the tangents points on a circle would leave it, with the square of their way: as much as the
        branch moves while an excursion ends.
        """
        origin = self.origin
        way = node_phase_gradient(orbit) @ (orbit.phases - origin.phases)
        if not way.any():
            return origin.nodes, origin.node_rates
        if resets_of(system) or jumps_of(system):
            return origin.nodes + way[:, None] * origin.node_rates, origin.node_rates
        at = orbit.mesh.nodes(orbit.phases)
        return origin.state(at), origin.rate(at)

    def _gradient(self, orbit: Orbit, free: tuple[int, ...], slope: Array) -> tuple[Array, Array]:
        weighted = self.weighted
        k = len(orbit.phases)
        outer = np.zeros(k + len(free))
        outer[:k] = -np.einsum("jn,jn,jk->k", weighted, slope, node_phase_gradient(orbit))
        outer[k + free.index(self.index)] = self.direction.parameter / self.scale**2
        return weighted, outer
