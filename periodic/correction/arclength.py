"""The arclength constraint: a step of given length along the tangent, in a metric that no mesh changes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.linear.unknowns import Increment, mean_weights, node_phase_gradient
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System


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

    def rate(self, direction: Increment) -> float:
        """How fast the distance grows along a direction on the origin's mesh."""
        weighted, outer = self._gradient(self.origin, (self.index,))
        along = np.append(direction.phases, direction.parameter)
        return float(np.vdot(weighted, direction.nodes) + outer @ along)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient; mesh points that move carry the origin's slope with them."""
        weighted, outer = self._gradient(orbit, free)
        shift = orbit.parameter[list(free)] - self.origin.parameter[list(free)]
        moved = np.append(orbit.phases - self.origin.phases, shift)
        value = np.einsum("jn,jn->", weighted, orbit.nodes - self.origin.nodes) + outer @ moved
        return Row(float(value) - self.distance, weighted, outer)

    def _gradient(self, orbit: Orbit, free: tuple[int, ...]) -> tuple[Array, Array]:
        slope, moving = self.origin.node_rates, node_phase_gradient(orbit)
        weights = mean_weights(self.origin) / self.size**2
        weighted = weights[:, None] * self.direction.profile
        k = len(orbit.phases)
        outer = np.zeros(k + len(free))
        outer[:k] = -np.einsum("jn,jn,jk->k", weighted, slope, moving)
        outer[k + free.index(self.index)] = self.direction.parameter / self.scale**2
        return weighted, outer
