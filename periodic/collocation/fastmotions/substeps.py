"""Perturbations that grow or decay faster than the mesh resolves, followed in substeps.

A slow motion beside a repelling equilibrium of the fast states, as of a canard, is smooth, and few intervals
resolve it to all digits. A perturbation, however, grows by exp(z) in an interval, z its width times an
eigenvalue of the Jacobian. The scheme replaces exp(z) by a rational function, which is accurate for small z
but tends to 0 for large ones. So where a perturbation grows by more than exp(GROWING) in an interval, all
perturbations are followed on shorter intervals along the same polynomials: those that decay fast too, as
growth and decay may cancel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.collocation.fastmotions.exponentials import ORDER, Exponentials, exponentials, vibrates
from periodic.collocation.fastmotions.unresolved import jacobians
from periodic.correction.newton import Correction, Linearise
from periodic.linear.bordering import Chain
from periodic.linear.operator import Operator
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.system import System, jumps_of, resets_of
from periodic.system.precision import EPSILON

GROWING = 1.0
"""Largest Re z, z its width times an eigenvalue of the Jacobian, of an interval that is not divided."""

EACH, FASTEST = 0.7, 2.0
"""Largest Re z and largest |z| of the motions in a substep."""

MOST_SUBSTEPS = 64
"""Largest number of substeps of an interval."""


@dataclass(frozen=True)
class SteppedCorrection(Correction):
    """A correction that knows how perturbations grow and vibrate, where its mesh does not resolve it."""

    system: System | None = None
    equations: Linearise | None = None
    tolerance: float = 0.0

    @cached_property
    def stepping(self) -> Operator | Exponentials | None:
        """The linearised equations in substeps where growth is fast, or exponentials where vibrations are;
        else `operator`, which may be None."""
        assert self.system is not None and self.equations is not None
        if self.gentle:
            return self.operator
        return stepping(self.equations, self.system, self.orbit, self.operator, self.tolerance)


def stepping(
    equations: Linearise,
    system: System,
    orbit: Orbit,
    operator: Operator | None,
    tolerance: float,
    finer: float = 1.0,
) -> Operator | Exponentials | None:
    """Return what resolves how perturbations of an orbit grow or vibrate: `operator` if its mesh does.

    tolerance: of the multipliers. finer: factor by which substeps are shorter than needed, for an error
    estimate that compares two, and parts of exponentials. Raises FAILURES.
    """
    if resets_of(system) or jumps_of(system) or not (operator is None or isinstance(operator, Chain)):
        return operator
    jacobian = jacobians(system, orbit) * (finer * orbit.grid.width[:, None, None])
    if not np.isfinite(jacobian).all() or np.abs(jacobian).sum(axis=2).max() <= GROWING:
        return operator
    exponents = np.linalg.eigvals(jacobian).astype(np.complex128)
    counts = substeps(exponents)
    if (counts > 1).any():
        return equations(system, divided(orbit, counts), ())
    if vibrates(orbit.mesh.scheme, exponents, tolerance, finer):
        return exponentials(system, orbit, tolerance / finer**ORDER) or operator
    return operator


def substeps(exponents: NDArray[np.complex128]) -> NDArray[np.int_]:
    """Return the number of substeps of each interval, shape (N,): 1 where nothing grows fast.

    exponents: eigenvalues of J, dx/dtau = J x about its middle, times its width, shape (N, n).
    """
    one = np.ones(len(exponents), dtype=int)
    growth = exponents.real.max(axis=1)
    growth[growth <= EPSILON * exponents.shape[1] * np.abs(exponents).max(axis=1)] = 0.0
    if growth.max() <= GROWING:
        return one
    needed = np.maximum(growth / EACH, np.abs(exponents).max(axis=1) / FASTEST)
    return np.clip(np.ceil(needed), 1, MOST_SUBSTEPS).astype(int)


def divided(orbit: Orbit, counts: NDArray[np.int_]) -> Orbit:
    """Return the same piecewise polynomial with each interval divided into its number of substeps."""
    mesh, breaks, begin = orbit.mesh, [], 0
    for ends in mesh.breaks:
        own = counts[begin : begin + len(ends) - 1]
        inner = [np.linspace(a, b, k, endpoint=False) for a, b, k in zip(ends, ends[1:], own, strict=False)]
        breaks.append(np.concatenate([*inner, ends[-1:]]))
        begin += len(own)
    return transfer(
        orbit, Mesh(mesh.scheme, tuple(breaks), mesh.events, mesh.period, mesh.modes), orbit.phases
    )
