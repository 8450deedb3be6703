"""Hill's method: fundamental matrices of an orbit from the exponents of its variational equation.

    u' = J(tau) u,  J = -E^-1 A.     With u = exp(lambda tau) v(tau), v periodic:  J v - v' = lambda v,

an eigenproblem in the Fourier coefficients of v. Every exponent comes with copies lambda + i k w, whose v is
turned by k harmonics, and the truncation spoils those whose v reaches the last harmonics. Along the copies of
one exponent the centroid of v's spectrum moves in steps of one harmonic: a window of that width about 0 holds
each exponent once, with the v that is resolved best (Lazarus & Thomas 2010; Guillot, Lazarus et al. 2020 for
the sorting by weighted means). The invariant subspace of the chosen ones, and not their eigenvectors, gives

    Phi(tau) = P(tau) exp(B tau) P(0)^-1,   J P - P' = P B,

so that coinciding multipliers need no care.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from periodic.balance import projected, sampled
from periodic.fourier import FourierOrbit, transform
from periodic.scheme import Array
from periodic.system import System

Complex = NDArray[np.complex128]

DENSE = 40
"""Up to so many harmonic coefficients 2H+1 all eigenvalues are found; beyond, those near 0 (Arnoldi)."""

SHIFT = 0.2137
"""Near which they are looked for: real, and no likely exponent itself."""

BLOCKS = (10, 16, 24)
"""Sizes of the Krylov space in blocks of n vectors, tried in turn."""

CLOSE = 1e-10
"""Largest residual of Ritz vectors, relative to their eigenvalue."""


NEAR = 1.5
"""Centroids nearer to 0 than this tell where the window ends."""


@dataclass(frozen=True)
class Floquet:
    """Fundamental matrices at the mesh points (N+1, n, n), and whether the exponents could be told apart."""

    fundamental: Array
    resolved: bool


def floquet(system: System, orbit: FourierOrbit) -> Floquet:
    """Return the fundamental matrices of an orbit.

    Raises FloatingPointError where the equations are not finite, numpy.linalg.LinAlgError where E or P(0) is
    singular.
    """
    n = orbit.nodes.shape[1]
    samples = sampled(system, orbit, ())
    jacobian = -np.linalg.solve(samples.d_rate, samples.d_state)
    unit = np.broadcast_to(np.eye(n), jacobian.shape)
    matrix = projected(-unit, jacobian, orbit.frequency)
    vectors, rate, resolved = _genuine(matrix, n)
    shapes = np.tensordot(transform(orbit.harmonics).nodes, vectors.reshape(-1, n, n), 1)
    step = linalg.expm(rate * orbit.mesh.period / orbit.mesh.ntst)
    growth = np.empty_like(shapes)
    growth[0] = np.linalg.inv(shapes[0])
    for j in range(orbit.mesh.ntst):
        growth[j + 1] = step @ growth[j]
    fundamental = (shapes @ growth).real
    if not np.isfinite(fundamental).all():
        raise np.linalg.LinAlgError("the eigenvectors at the first mesh point are dependent")
    return Floquet(fundamental, resolved)


def _genuine(matrix: Array, n: int) -> tuple[Complex, Complex, bool]:
    """The invariant subspace (size, n) of the genuine exponents, B, and whether there were just n of them."""
    if len(matrix) > DENSE * n:
        found = _krylov(matrix, n)
        if found is not None:
            return found
    vectors, rate, resolved = _subspace(matrix, np.eye(len(matrix)), n)
    return vectors, rate, resolved


def _krylov(matrix: Array, n: int) -> tuple[Complex, Complex, bool] | None:
    """The same from a Krylov space of (matrix - SHIFT)^-1; None where it is not accurate or complete."""
    size = len(matrix)
    factors = linalg.lu_factor(matrix - SHIFT * np.eye(size))
    block = np.linalg.qr(np.random.default_rng(0).standard_normal((size, n)))[0]
    space, images = block, np.zeros((size, 0))
    for blocks in BLOCKS:
        while images.shape[1] < blocks * n:
            image = linalg.lu_solve(factors, space[:, -n:])
            images = np.concatenate([images, image], axis=1)
            for _ in range(2):
                image = image - space @ (space.T @ image)
            space = np.concatenate([space, np.linalg.qr(image)[0]], axis=1)
        basis = space[:, :-n]
        vectors, inverse, resolved = _subspace(basis.T @ images, basis, n, inverted=True)
        rate = np.linalg.inv(inverse) + SHIFT * np.eye(n)
        error = np.abs(matrix @ vectors - vectors @ rate).max()
        if resolved and error < CLOSE * max(1.0, np.abs(rate).max()):
            return vectors, rate, True
    return None


def _subspace(matrix: Array, basis: Array, n: int, *, inverted: bool = False) -> tuple[Complex, Complex, bool]:
    """Choose among the eigenvalues of `matrix`, whose vectors are coordinates in `basis`."""
    values, vectors = np.linalg.eig(matrix)
    chosen, resolved = chosen_by_centroid(centroids(basis @ vectors, n), n)

    def is_chosen(value: complex) -> bool:
        return bool(chosen[np.abs(values - value).argmin()])

    triangle, turned, count = linalg.schur(matrix, output="complex", sort=is_chosen)
    return basis @ turned[:, :n], triangle[:n, :n], resolved and count == n


def centroids(vectors: Complex, n: int) -> Array:
    """Mean harmonic of each column's spectrum, weighted with the squares of its amplitudes; (columns,)."""
    size = len(vectors) // n
    parts = vectors.reshape(size, n, -1)
    harmonics = (size - 1) // 2
    cosine, sine = parts[1 : harmonics + 1], parts[harmonics + 1 :]
    up, down = ((np.abs(cosine + sign * sine) ** 2).sum(axis=1) / 4 for sign in (-1j, 1j))
    whole = (np.abs(parts[0]) ** 2).sum(axis=0) + up.sum(axis=0) + down.sum(axis=0)
    return np.arange(1, harmonics + 1) @ (up - down) / whole


def chosen_by_centroid(centroid: Array, n: int) -> tuple[NDArray[np.bool_], bool]:
    """Which of the columns lie in a window of width 1 about 0, and whether these are just n.

    The window ends in the widest gap between the centroids near 0, taken modulo 1.
    """
    near = np.sort(np.mod(centroid[np.abs(centroid) <= NEAR], 1.0))
    if len(near) == 0:
        near = np.zeros(1)
    gaps = np.diff(near, append=near[0] + 1)
    widest = int(gaps.argmax())
    end = float(np.mod(near[widest] + gaps[widest] / 2, 1.0))
    window = (centroid > end - 1) & (centroid <= end)
    if window.sum() == n:
        return window, True
    nearest = np.zeros(len(centroid), dtype=bool)
    nearest[np.abs(centroid - (end - 0.5)).argsort(kind="stable")[:n]] = True
    return nearest, False
