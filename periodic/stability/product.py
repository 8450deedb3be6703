"""Multipliers of a product of matrices over many decades: none is lost beside the largest.

The columns of an orthogonal matrix are carried through all factors, orthogonalised after each (A_j Q_{j-1} =
Q_j R_j); after some periods they span the motions in order of their growth, and the product is block upper
triangular in them. Each block is multiplied up on its own, scaled, so that its multipliers keep their digits.

References
----------
Bojanczyk, Golub & Van Dooren, Proc. SPIE 1770 (1992); Lust, Int. J. Bifurcation and Chaos 11 (2001) 2389.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.orbit.scheme import Array
from periodic.system.precision import EPSILON, LARGEST, SMALLEST

APART = np.log(100.0)
"""Multipliers whose moduli differ by this factor (a logarithm) belong to different blocks."""

MULTIPLIED_UP = 1e3
"""Growth of motions in steps that are multiplied up: what does not grow loses three digits by it."""

PERIODS = 16
"""How many periods the columns are carried at the most."""

SETTLED = 1e-11
"""What is left below the blocks when the columns span the motions in their order."""

TURNING = SETTLED**0.5
"""What is left there for good where blocks are one: of a pair that turns. What is less is rounding."""

LARGEST_LOGARITHM = np.log(LARGEST)
"""Larger multipliers (a logarithm) are given as this one."""


def multipliers(steps: Array, known: float = EPSILON) -> NDArray[np.complex128]:
    """Return the eigenvalues of steps[-1] ... steps[0], steps (N, n, n), largest modulus first.

    known: the relative error of the steps. Eigenvalues are 0 whose motions a step makes smaller than that:
    of them the steps say nothing more. Of those beyond 1e300 the modulus is given as that.
    """
    n = steps.shape[1]
    if n == 1:
        return _of_block(steps, np.eye(1))
    steps, basis = _joined(steps), np.eye(n)
    for _ in range(PERIODS):
        begun, packed = basis, np.empty_like(steps)
        for j, step in enumerate(steps):
            basis, packed[j] = _orthogonal(step @ basis)
        triangles = np.triu(packed)
        sizes = np.abs(np.diagonal(triangles, axis1=1, axis2=2))
        growth = np.log(np.maximum(sizes, SMALLEST)).sum(axis=0)
        turn = begun.T @ basis
        cuts = np.flatnonzero(growth[:-1] - growth[1:] > APART) + 1
        below = np.array([np.abs(turn[cut:, :cut]).max() for cut in cuts])
        if (below < SETTLED).all():
            break
    blocks = np.split(np.arange(n), cuts[below < TURNING])
    lost = (sizes < known * sizes.max(axis=1, keepdims=True)).any(axis=0)
    found = [_of_block(triangles[:, b[:, None], b], turn[b[:, None], b]) for b in blocks]
    return np.concatenate([0 * f if lost[b].any() else f for f, b in zip(found, blocks, strict=True)])


def _orthogonal(matrix: Array) -> tuple[Array, Array]:
    """Q of a matrix, and R above what LAPACK keeps below it; numpy's own way to it takes longer."""
    lapack = scipy.linalg.lapack
    packed, tau, _, _ = lapack.dgeqrf(matrix)
    return lapack.dorgqr(packed, tau)[0], packed


def _joined(steps: Array) -> Array:
    """The same product in fewer factors, none of which is conditioned worse than MULTIPLIED_UP for that."""
    with np.errstate(divide="ignore", invalid="ignore"):
        sizes = np.linalg.svd(steps, compute_uv=False)
        conditions = np.nan_to_num(np.log(sizes[:, 0] / sizes[:, -1]), nan=np.inf, posinf=np.inf)
    found: list[Array] = []
    total = np.inf
    for step, condition in zip(steps, conditions, strict=True):
        total += condition
        if total < np.log(MULTIPLIED_UP):
            found[-1] = step @ found[-1]
        else:
            found.append(step)
            total = condition
    return np.array(found)


def _of_block(factors: Array, turn: Array) -> NDArray[np.complex128]:
    """Eigenvalues of turn @ factors[-1] ... factors[0], largest modulus first."""
    if len(turn) == 1:
        sizes = np.maximum(np.abs(factors[:, 0, 0]), SMALLEST)
        total = float(np.log(sizes).sum())
        sign = turn[0, 0] * np.prod(np.sign(factors[:, 0, 0]))
        return np.array([sign * np.exp(min(total, LARGEST_LOGARITHM))], dtype=np.complex128)
    product, logarithm = np.eye(len(turn)), 0.0
    for factor in factors:
        product = factor @ product
        size = max(float(np.abs(product).max()), SMALLEST)
        product, logarithm = product / size, logarithm + float(np.log(size))
    values = np.linalg.eigvals(turn @ product)
    sizes = np.abs(values)
    known = np.log(np.maximum(sizes, SMALLEST)) + logarithm
    values = values * np.exp(np.minimum(known, LARGEST_LOGARITHM) - np.log(np.maximum(sizes, SMALLEST)))
    return values[np.argsort(-np.abs(values), kind="stable")].astype(np.complex128)
