"""The invariant subspace of the largest multipliers of many, by Davidson's method.

The monodromy matrix is a diagonal E, the growth of the uncoupled modes, plus a term from the forces at the
places, which is small but for the lowest modes. A subspace that begins with the least damped modes therefore
nearly holds the eigenvectors of the largest multipliers; it is widened by (mu - E)^-1 r, r the residual of an
eigenvector, until it holds them.

References
----------
.. [1] E. R. Davidson, Journal of Computational Physics 17 (1975) 87-94.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Complex

SPARE = 3
"""Next smaller multipliers that must converge besides those that are wanted."""

MORE = 4
"""Least damped modes in the first subspace beyond as many coordinates as multipliers are computed."""

BLOCK = 4
"""Random vectors whose images join the subspace: they hold motion driven by forces at the places."""

LARGEST_SUBSPACE = 72
"""Largest size of the subspace."""

EIGENVECTOR_RESIDUAL = 1e-12
"""Largest residual of an eigenvector, relative to the largest multiplier or to 1 if that is larger."""


class Motions(Protocol):
    """Free motion over a period; see `periodic.condensed.floquet.ModalFloquet`."""

    @property
    def light(self) -> int: ...
    @property
    def kept(self) -> NDArray[np.int_]: ...
    @property
    def eigen(self) -> tuple[Complex, Complex]: ...
    def lightest(self, count: int) -> NDArray[np.int_]: ...
    def apart(self, values: Complex, vectors: Complex) -> Complex: ...
    def once(self, basis: Array) -> Array: ...


def invariant(motions: Motions, count: int, light: float) -> Array:
    """Return an orthonormal basis of the subspace of the `count` largest multipliers, (coordinates, r).

    Where more are larger than `light` it holds all of these. A pair that would be one too many is left out,
    and the next real multiplier taken, if any.
    """
    # mostly the system has as many lightly damped multipliers as its linear part alone
    values, vectors = _largest(motions, max(count, motions.light))
    if np.abs(values).min() > light:
        values, vectors = _all(motions, len(motions.kept))
    count = max(count, int((np.abs(values) > light).sum()))
    order = np.argsort(-np.abs(values), kind="stable")
    columns: list[Array] = []
    for k in order:
        if values[k].imag == 0 and len(columns) < count:
            columns.append(vectors[:, k].real)
        if values[k].imag > 0 and len(columns) < count - 1:
            columns += [vectors[:, k].real, vectors[:, k].imag]
    return np.linalg.qr(np.array(columns).T)[0]


def _largest(motions: Motions, count: int) -> tuple[Complex, Complex]:
    """The `count` + SPARE largest multipliers, and their eigenvectors."""
    size, wanted = len(motions.kept), count + SPARE
    begun = wanted + 2 * MORE
    if begun + BLOCK > size:
        return _all(motions, wanted)
    space = np.eye(size)[:, motions.lightest(begun)]
    drawn = np.random.default_rng(0).standard_normal((size, BLOCK))
    images = motions.once(np.concatenate([space, drawn], axis=1))
    images, more = images[:, :begun], images[:, begun:]
    while space.shape[1] + more.shape[1] <= min(LARGEST_SUBSPACE, size):
        more = _orthogonal(space, more)
        space = np.concatenate([space, more], axis=1)
        images = np.concatenate([images, motions.once(more)], axis=1)
        values, vectors = np.linalg.eig(space.T @ images)
        first = np.argsort(-np.abs(values), kind="stable")[:wanted]
        values, found = values[first].astype(np.complex128), space @ vectors[:, first]
        left = images @ vectors[:, first] - found * values
        wrong = np.linalg.norm(left, axis=0) > EIGENVECTOR_RESIDUAL * max(1.0, float(np.abs(values).max()))
        if not wrong.any():
            return values, found.astype(np.complex128)
        wrong &= values.imag >= 0
        beyond = motions.apart(values[wrong], left[:, wrong])
        paired = values[wrong].imag > 0
        more = np.concatenate([beyond.real, beyond[:, paired].imag], axis=1)
    return _all(motions, wanted)  # not converged, as where multipliers have nearly one modulus


def _orthogonal(space: Array, vectors: Array) -> Array:
    """An orthonormal basis of the parts of vectors that are orthogonal to a subspace."""
    for _ in range(2):
        vectors = np.linalg.qr(vectors - space @ (space.T @ vectors))[0]
    return vectors


def _all(motions: Motions, wanted: int) -> tuple[Complex, Complex]:
    values, vectors = motions.eigen
    first = np.argsort(-np.abs(values), kind="stable")[:wanted]
    return values[first], vectors[:, first]
