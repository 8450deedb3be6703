"""The spectrum of an orbit whose motions grow by many decades within the period, from its intervals.

Of an autonomous orbit the flow f comes back as itself: Phi f(0) = f(0). Where a motion that decays over the
period grows within it, as along the repelling branch of a canard, rounding mixes it into the flow, and the
multiplier that is 1 is lost with the others. So the flow is taken out of each interval's step A_j,

    B_j = Q_{j+1}' A_j Q_j,   the columns of Q_j an orthonormal basis of what is across f_j,

and the other multipliers are those of the product of the B_j, one size smaller.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np

from periodic.linear.bordering import GROWTH
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import LOST_FLOW, Complex, Spectrum
from periodic.stability.product import MULTIPLIED_UP, multipliers
from periodic.system.precision import EPSILON, SMALLEST


@runtime_checkable
class Stepping(Protocol):
    """Linearised equations that say how perturbations pass from joint to joint, and the flow there."""

    @property
    def growth(self) -> float:
        """How much they grow at the most from one joint to another."""

    @property
    def steps(self) -> Array:
        """Shape (N, n, n)."""

    @property
    def flow(self) -> Array | None:
        """dx/dtau at the joints, shape (N+1, n); None where it jumps."""


@dataclass(frozen=True, eq=False)
class GradedSpectrum(Spectrum):
    """Multipliers over many decades; see `Spectrum`.

    stepping: the linearised equations. known_to: the relative error of their steps.
    """

    stepping: Stepping = field(kw_only=True)
    known_to: float = EPSILON

    @cached_property
    def _eigen(self) -> tuple[Complex, Complex]:
        values, vectors = np.linalg.eig(self.monodromy)
        found = np.empty(len(values), dtype=np.complex128)
        found[np.argsort(-np.abs(values), kind="stable")] = self._sorted(self.stepping)
        return found, vectors.astype(np.complex128)

    @property
    def known(self) -> bool:
        """Whether the flow comes back as itself."""
        flow = self.stepping.flow
        if not self.trivial or flow is None:
            return super().known
        return bool(_stray(self.stepping.steps, flow) <= LOST_FLOW)

    def apart(self, monodromy: Array, operator: object = None) -> float:
        """Distance from the spectrum of other equations, likewise from their steps."""
        if not isinstance(operator, Stepping):
            return super().apart(monodromy)
        own, other = (self._sorted(stepping) / self.radius for stepping in (self.stepping, operator))
        with np.errstate(over="ignore", invalid="ignore"):  # far larger ones are infinitely far
            sums = [abs((other**power).sum() - (own**power).sum()) / power for power in (1, 2)]
        return float(np.nan_to_num(max(sums), nan=np.inf))

    def _sorted(self, stepping: Stepping) -> Complex:
        """The multipliers, largest modulus first."""
        flow = stepping.flow
        if not self.trivial or flow is None:
            return multipliers(stepping.steps, self.known_to)
        others = multipliers(_transverse(stepping.steps, flow), self.known_to)
        found = np.append(others, 1.0)
        return found[np.argsort(-np.abs(found), kind="stable")]


def spectrum_of(fundamental: Array, operator: object, trivial: int, known_to: float = EPSILON) -> Spectrum:
    """Return the spectrum of an orbit, from the steps of its operator where motions grow by many decades.

    Also where these are more than the intervals that the fundamental matrices are of.
    """
    if not isinstance(operator, Stepping):
        return Spectrum(fundamental, trivial)
    if operator.growth <= (MULTIPLIED_UP if trivial else GROWTH) and len(operator.steps) < len(fundamental):
        return Spectrum(fundamental, trivial)
    return GradedSpectrum(fundamental, trivial, known_to, stepping=operator)


def _transverse(steps: Array, flow: Array) -> Array:
    """The steps on what is across the flow (N, n-1, n-1)."""
    bases = np.linalg.qr(flow[:, :, None], mode="complete")[0][:, :, 1:]
    bases[-1] = bases[0]
    return np.swapaxes(bases[1:], 1, 2) @ steps @ bases[:-1]


def _stray(steps: Array, flow: Array) -> float:
    """How far the flow at a joint is from what its step makes of that before it, relative to it."""
    brought = np.einsum("jnm,jm->jn", steps, flow[:-1])
    apart = np.linalg.norm(brought - flow[1:], axis=1)
    return float((apart / np.maximum(np.linalg.norm(flow[1:], axis=1), SMALLEST)).max())
