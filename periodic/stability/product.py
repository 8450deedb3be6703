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
from numpy.typing import NDArray

from periodic.linear.bordering import GROWTH
from periodic.orbit.scheme import Array
from periodic.stability.spectrum import Spectrum

APART = np.log(10.0)
"""Multipliers whose moduli differ by this factor (a logarithm) belong to different blocks."""

PERIODS = 16
"""How many periods the columns are carried at the most."""

SETTLED = 1e-11
"""What is left below the blocks when the columns span the motions in their order."""

ROUNDING = float(np.finfo(float).eps)

TINY = float(np.finfo(float).tiny)
"""What grows by less in an interval is gone, as where a motion begins to stick."""


def multipliers(steps: Array, known: float = ROUNDING) -> NDArray[np.complex128]:
    """Return the eigenvalues of steps[-1] ... steps[0], steps (N, n, n), largest modulus first.

    known: the relative error of the steps. Eigenvalues are 0 whose motions a step makes smaller than that:
    of them the steps say nothing more.
    """
    n = steps.shape[1]
    basis = np.eye(n)
    for _ in range(PERIODS):
        begun, triangles = basis, np.empty_like(steps)
        for j, step in enumerate(steps):
            basis, triangles[j] = np.linalg.qr(step @ basis)
        sizes = np.abs(np.diagonal(triangles, axis1=1, axis2=2))
        growth = np.log(np.maximum(sizes, TINY)).sum(axis=0)
        turn = begun.T @ basis
        cuts = np.flatnonzero(growth[:-1] - growth[1:] > APART) + 1
        blocks = np.split(np.arange(n), cuts)
        if all(np.abs(turn[cut:, :cut]).max() < SETTLED for cut in cuts):
            break
    lost = (sizes < known * sizes.max(axis=1, keepdims=True)).any(axis=0)
    found = [_of_block(triangles[:, b[:, None], b], turn[b[:, None], b]) for b in blocks]
    return np.concatenate([0 * f if lost[b].any() else f for f, b in zip(found, blocks, strict=True)])


def spectrum_of(fundamental: Array, operator: object, trivial: int, known: float = ROUNDING) -> Spectrum:
    """Return the spectrum of an orbit, from the steps of its operator where motions grow by many decades."""
    steps = getattr(operator, "steps", None)
    if steps is None or not np.abs(fundamental).max() > GROWTH:
        return Spectrum(fundamental, trivial)
    return Spectrum(fundamental, trivial, known_better=multipliers(steps, known))


def _of_block(factors: Array, turn: Array) -> NDArray[np.complex128]:
    """Eigenvalues of turn @ factors[-1] ... factors[0], largest modulus first."""
    product, logarithm = np.eye(len(turn)), 0.0
    for factor in factors:
        product = factor @ product
        size = max(float(np.abs(product).max()), TINY)
        product, logarithm = product / size, logarithm + float(np.log(size))
    with np.errstate(over="ignore"):
        values = np.linalg.eigvals(turn @ product) * np.exp(logarithm)
    return values[np.argsort(-np.abs(values), kind="stable")].astype(np.complex128)
