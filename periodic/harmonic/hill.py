"""Hill's method: fundamental matrices of an orbit from the exponents of its variational equation.

    u' = J(tau) u,  J = -E^-1 A.     With u = exp(lambda tau) v(tau), v periodic:  J v - v' = lambda v,

an eigenproblem in the Fourier coefficients of v. Every exponent comes with copies lambda + i k w, whose v is
shifted by k harmonics, and the truncation spoils those whose v reaches the last harmonics. From copy to copy
the centroid of v's spectrum moves by one harmonic: a window of that width about 0 holds each exponent once,
with the v that is resolved best (Lazarus & Thomas 2010; Guillot, Lazarus et al. 2020 for the sorting by
weighted means). The invariant subspace of the chosen ones, and not their eigenvectors, gives

    Phi(tau) = P(tau) exp(B tau) P(0)^-1,   J P - P' = P B,

so that coinciding multipliers need no care.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.harmonic.balance import projected, sampled
from periodic.harmonic.series import FourierOrbit, basis, basis_slope
from periodic.orbit.scheme import Array
from periodic.system import System

Complex = NDArray[np.complex128]

DENSE = 64
"""Largest matrices of which all eigenvalues are computed; of larger ones those near 0 (block Arnoldi)."""

SHIFT = 0.2137
"""Shift of the shift-and-invert iteration, in units of w: real, and unlikely to be an exponent itself."""

BLOCKS = (12, 18, 27, 40)
"""Sizes of the Krylov space in blocks, tried in turn."""

STATES_PER_VECTOR = 4
"""A block has n / BLOCK vectors for n states, and at least two."""

KRYLOV_RESIDUAL = 1e-11
"""Largest residual of an eigenvector from a Krylov space, relative to its eigenvalue."""

DEPENDENT = 1e-4
"""Eigenvectors whose singular values spread more are replaced by Schur vectors."""

WINDOW = 1.5
"""Only centroids nearer to 0 than this decide where the window ends."""


@dataclass(frozen=True)
class FloquetForm:
    """Floquet's form of the fundamental matrices: coefficients of P (2H+1, n, n), and B (n, n).

    resolved: whether the exponents could be distinguished from their copies.
    """

    shape: Complex
    rate: Complex
    period: float
    resolved: bool

    @property
    def harmonics(self) -> int:
        """Harmonics of P."""
        return (len(self.shape) - 1) // 2

    def fundamental(self, orbit: FourierOrbit) -> Array:
        """Return Phi at the mesh points, (N+1, n, n).

        Raises numpy.linalg.LinAlgError where P(0) is singular.
        """
        shapes = np.tensordot(
            basis(self.harmonics, orbit.frequency * orbit.mesh.nodes(orbit.phases)), self.shape, 1
        )
        step = scipy.linalg.expm(self.rate * self.period / orbit.mesh.ntst)
        growth = np.empty_like(shapes)
        growth[0] = np.linalg.inv(shapes[0])
        with np.errstate(over="ignore", invalid="ignore"):
            for j in range(orbit.mesh.ntst):
                growth[j + 1] = step @ growth[j]
            fundamental = (shapes @ growth).real
        if not np.isfinite(fundamental).all():
            raise np.linalg.LinAlgError("the vectors at the first mesh point are dependent")
        return fundamental

    def error(self, system: System, fine: FourierOrbit) -> float:
        """Estimate the error of the multipliers from the residual of P's equation along a better orbit.

        With P^-1 (J P - P' - P B) = G the sums of powers of the multipliers are off by
        tr M^k: k period tr(exp(k period B) mean G), to first order; they are measured as in
        `periodic.correction.error`.
        """
        if not self.resolved:
            return np.inf
        angle = fine.frequency * fine.stage_phases.ravel()
        P = np.tensordot(basis(self.harmonics, angle), self.shape, 1)
        slope = fine.frequency * np.tensordot(basis_slope(self.harmonics, angle), self.shape, 1)
        left = np.linalg.solve(P, jacobian(system, fine) @ P - slope - P @ self.rate).mean(axis=0)
        once = scipy.linalg.expm(self.rate * self.period)
        scale = max(1.0, float(np.abs(np.linalg.eigvals(once)).max()))
        sums = [np.trace(power @ left) for power in (once / scale, once @ once / scale**2)]
        return float(self.period * np.abs(sums).max())


def jacobian(system: System, orbit: FourierOrbit) -> Array:
    """J at the samples, shape (S, n, n).

    Raises FloatingPointError where the equations are not finite, numpy.linalg.LinAlgError where E is
    singular.
    """
    samples = sampled(system, orbit, ())
    result = -np.linalg.solve(samples.d_rate, samples.d_state).astype(float, copy=False)
    if not np.isfinite(result).all():
        raise FloatingPointError("the Jacobian of the explicit equation is not finite")
    return result


def floquet(system: System, orbit: FourierOrbit) -> FloquetForm:
    """Return Floquet's form of the fundamental matrices of an orbit. Raises as `jacobian` does."""
    n = orbit.nodes.shape[1]
    J = jacobian(system, orbit) / orbit.frequency
    matrix = projected(np.broadcast_to(-np.eye(n), J.shape), J, 1.0)
    found = _krylov(matrix, n) if len(matrix) > DENSE else _dense(matrix, n)
    return FloquetForm(
        found.vectors.reshape(-1, n, n), orbit.frequency * found.rate, orbit.mesh.period, found.resolved
    )


@dataclass(frozen=True)
class _Subspace:
    """The invariant subspace (size, n) of the chosen exponents, B / w, and whether just n were chosen."""

    vectors: Complex
    rate: Complex
    resolved: bool


def _dense(matrix: Array, n: int) -> _Subspace:
    """The subspace of the exponents whose centroids lie nearest to 0, from all eigenvalues."""
    values, vectors = np.linalg.eig(matrix)
    chosen, resolved = in_window(centroids(vectors, n), n)
    return _spanned(matrix, values, vectors, chosen, resolved)


def _krylov(matrix: Array, n: int) -> _Subspace:
    """The subspace of the exponents whose imaginary parts lie nearest to 0.

    They are computed in a Krylov space of (matrix - SHIFT)^-1, which is enlarged until it holds them.
    """
    size, far, each = len(matrix), len(matrix) // n / 4, max(2, n // STATES_PER_VECTOR)
    factors = scipy.linalg.lu_factor(matrix - SHIFT * np.eye(size))
    space = np.linalg.qr(np.random.default_rng(0).standard_normal((size, each)))[0]
    images = np.zeros((size, 0))
    for blocks in BLOCKS:
        if (blocks + 1) * each > size:
            break
        while images.shape[1] < blocks * each:
            image = scipy.linalg.lu_solve(factors, space[:, -each:])
            images = np.concatenate([images, image], axis=1)
            for _ in range(2):
                image = image - space @ (space.T @ image)
            space = np.concatenate([space, np.linalg.qr(image)[0]], axis=1)
        known = space[:, :-each]
        inside = known.T @ images
        values, vectors = np.linalg.eig(inside)
        ritz = known @ vectors
        left = np.linalg.norm(images @ vectors - ritz * values, axis=0)
        good = np.flatnonzero((left < KRYLOV_RESIDUAL * np.abs(values)) & (np.abs(centroids(ritz, n)) < far))
        chosen = np.zeros(len(values), dtype=bool)
        chosen[good], resolved = in_window((1 / values[good]).imag, n)
        if resolved:
            found = _spanned(inside, values, vectors, chosen, resolved)
            rate = np.linalg.inv(found.rate).astype(np.complex128, copy=False) + SHIFT * np.eye(
                n, dtype=complex
            )
            return _Subspace(known @ found.vectors, rate, found.resolved)
    return _dense(matrix, n)


def _spanned(
    matrix: Array, values: Complex, vectors: Complex, chosen: NDArray[np.bool_], resolved: bool
) -> _Subspace:
    """The invariant subspace of the chosen eigenvalues of a matrix."""
    mine = vectors[:, chosen]
    spread = np.linalg.svd(mine, compute_uv=False)
    if spread[-1] > DEPENDENT * spread[0]:
        return _Subspace(mine, np.diag(values[chosen]), resolved)

    def is_chosen(value: complex) -> bool:
        return bool(chosen[np.abs(values - value).argmin()])

    n = int(chosen.sum())
    triangle, turned, count = scipy.linalg.schur(matrix, "complex", sort=is_chosen)  # type: ignore[call-overload]
    return _Subspace(turned[:, :n], triangle[:n, :n], resolved and count == n)


def centroids(vectors: Complex, n: int) -> Array:
    """Mean harmonic of each column's spectrum, weighted with the squares of its amplitudes; (columns,)."""
    size = len(vectors) // n
    parts = vectors.reshape(size, n, -1)
    harmonics = (size - 1) // 2
    cosine, sine = parts[1 : harmonics + 1], parts[harmonics + 1 :]
    up, down = ((np.abs(cosine + sign * sine) ** 2).sum(axis=1) / 4 for sign in (-1j, 1j))
    whole = (np.abs(parts[0]) ** 2).sum(axis=0) + up.sum(axis=0) + down.sum(axis=0)
    return np.arange(1, harmonics + 1) @ (up - down) / whole


def in_window(places: Array, n: int) -> tuple[NDArray[np.bool_], bool]:
    """Return which places lie in a window of width 1 about 0, and whether these are just n.

    The places are centroids; those of the copies of one exponent are 1 apart. The window ends in the widest
    gap between the places near 0, modulo 1. Where it does not hold n places, the n nearest to its middle are
    taken.
    """
    near = np.sort(np.mod(places[np.abs(places) <= WINDOW], 1.0))
    if len(near) == 0:
        near = np.zeros(1)
    gaps = np.diff(near, append=near[0] + 1)
    widest = int(gaps.argmax())
    end = float(np.mod(near[widest] + gaps[widest] / 2, 1.0))
    window = (places > end - 1) & (places <= end)
    if window.sum() == n:
        return window, True
    nearest = np.zeros(len(places), dtype=bool)
    nearest[np.abs(places - (end - 0.5)).argsort(kind="stable")[:n]] = True
    return nearest, False
