"""Reduction of large structures to a few places and modes, with the error of it.

The reduced structure is q = T r with r = (motion at the places, modal coordinates): its first degrees of
freedom are the places themselves, so that anything attaches to it as to the full one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from symbolic.arrays import Array, Complex
from symbolic.checks import finite, positive, refusal, whole
from symbolic.structures.flexibility import flexibility, indices, solved
from symbolic.structures.matrices import Matrices, Matrix, dense, lowest, modes, sparse
from symbolic.structures.rounding import LEFT, hidden


@dataclass(frozen=True, eq=False)
class Reduction:
    """A structure reduced to places and modes.

    Parameters
    ----------
    matrices : Matrices
        The reduced structure: T' M T and so on, with the names of the places kept.
    recovery : ndarray, shape (n, r)
        T: motion q = T r of the full structure from that of the reduced one.
    full : Matrices
        The full structure.
    places : ndarray of int, shape (k,)
        Its degrees of freedom that are the first k of the reduced one.
    """

    matrices: Matrices
    recovery: Array
    full: Matrices = field(repr=False)
    places: Array = field(repr=False)

    def error(self, low: float, high: float, *, points: int = 40, speed: float = 0.0) -> float:
        """Return the error of the reduction over a band of frequencies.

        The largest of ``|H_reduced - H|/|H|`` (2-norms) of the dynamic flexibility H at the places, over
        `points` even angular frequencies and the reduced structure's natural frequencies in the band.

        Parameters
        ----------
        low, high : float
            The band, rad/s.
        points : int
            Even frequencies.
        speed : float
            Omega in rad/s, for a structure with gyroscopic forces.

        Returns
        -------
        float
            The relative error.

        Raises
        ------
        ValueError
            For an empty band, and at an undamped resonance (the structure needs damping).
        """
        if not 0 <= finite("low", low) < positive("high", high):
            raise refusal("low", low, f"at least 0 and less than high = {high:g}")
        natural = np.sqrt(np.abs(lowest(self.matrices.K, self.matrices.M, self.matrices.size)))
        even = np.linspace(low, high, whole("points", points, 2))
        band = np.unique(np.r_[even, natural[(natural > low) & (natural < high)]]).tolist()
        first = list(range(len(self.places)))
        exact = flexibility(self.full, self.places.tolist(), band, speed=speed)
        found = flexibility(self.matrices, first, band, speed=speed)
        return float((_norms(found - exact) / _norms(exact)).max())


def craig_bampton(matrices: Matrices, places: Sequence[str | int], modes: int) -> Reduction:
    """Return a structure reduced by Craig and Bampton's method.

    T = [static modes of the places; modes with the places held].

    Parameters
    ----------
    matrices : Matrices
        The full structure; sparse ones are factorised sparse.
    places : sequence of str or int
        Degrees of freedom that are kept: all to which something is attached.
    modes : int
        Number of modes with the places held, the lowest first.

    Returns
    -------
    Reduction
        The reduced structure and how to come back from it.

    Raises
    ------
    ValueError
        For places that do not exist, more modes than there are, a structure that moves freely while the
        places are held, and one so fine that rounding of its stiffness hides modes.

    References
    ----------
    .. [1] R. R. Craig, M. C. C. Bampton, AIAA Journal 6 (1968) 1313-1319.
    """
    kept = indices(matrices, places)
    inner = np.setdiff1d(np.arange(matrices.size), kept)
    recovery = np.zeros((matrices.size, len(kept) + whole("modes", modes, 0)))
    recovery[kept, np.arange(len(kept))] = 1
    if len(inner):
        stiffness, mass = _cut(matrices.K, inner, inner), _cut(matrices.M, inner, inner)
        static = solved(stiffness, -dense(_cut(matrices.K, inner, kept)))
        if static is None:
            raise ValueError("the structure moves freely while the places are held; hold it or add places")
        recovery[inner, : len(kept)] = static.real
        if modes:
            recovery[inner, len(kept) :] = _modes(stiffness, mass, modes)
    return _reduced(matrices, recovery, kept)


def residual_modes(matrices: Matrices, places: Sequence[str | int], modes: int) -> Reduction:
    """Return a structure reduced to its lowest modes and the residual flexibility of all others.

    T = [modes; (K + s M)^-1 B - modes (Lambda + s)^-1 modes' B], which answers static forces at the places
    exactly (Rubin's method); s > 0 only where the structure has rigid-body modes.

    Parameters
    ----------
    matrices : Matrices
        The full structure.
    places : sequence of str or int
        Degrees of freedom to which something is attached.
    modes : int
        Number of modes of the free structure, rigid-body modes included.

    Returns
    -------
    Reduction
        The reduced structure and how to come back from it.

    Raises
    ------
    ValueError
        For places that do not exist, and more modes than there are.

    References
    ----------
    .. [1] S. Rubin, AIAA Journal 13 (1975) 995-1006.
    """
    kept = indices(matrices, places)
    count, n = whole("modes", modes, 1), matrices.size
    if count + len(kept) > n:
        raise refusal("modes", modes, f"at most {n - len(kept)}, the degrees of freedom less the places")
    squares, shapes = _lowest(matrices, count)
    shift = 0.0 if squares[0] > 1e-9 * squares[-1] else max(float(squares[-1]), 1e-300)
    load = np.zeros((n, len(kept)))
    load[kept, np.arange(len(kept))] = 1
    symmetric = (matrices.K + matrices.K.T) / 2
    flexible = solved(symmetric + shift * matrices.M, load)
    if flexible is None:
        raise ValueError("the stiffness is singular; take more modes, all rigid-body ones among them")
    residual = flexible.real - shapes @ ((shapes.T @ load) / (squares + shift)[:, None])
    at_places = residual @ np.linalg.inv(residual[kept])
    return _reduced(matrices, np.hstack([at_places, shapes - at_places @ shapes[kept]]), kept)


def _reduced(matrices: Matrices, recovery: Array, kept: Array) -> Reduction:
    def projected(matrix: Matrix) -> Array:
        return np.asarray(recovery.T @ (matrix @ recovery))

    mass = projected(matrices.M)
    gyroscopic = None if matrices.G is None else projected(matrices.G)
    first = {int(dof): k for k, dof in enumerate(kept)}
    at = {name: first[dof] for name, dof in matrices.at.items() if dof in first}
    reduced = Matrices((mass + mass.T) / 2, projected(matrices.C), projected(matrices.K), gyroscopic, at=at)
    return Reduction(reduced, recovery, matrices, kept)


def _cut(matrix: Matrix, rows: Array, columns: Array) -> Matrix:
    return matrix[rows][:, columns] if sparse.issparse(matrix) else matrix[np.ix_(rows, columns)]


def _modes(stiffness: Matrix, mass: Matrix, count: int) -> Array:
    """The lowest modes of a held structure. Raises ValueError where rounding of K hides one."""
    squares, shapes = modes(stiffness, mass, count)
    lost = int(hidden(stiffness, squares, shapes).sum())
    if lost:
        raise ValueError(
            f"the stiffness, right to rounding, does not tell {lost} of the modes with the places held to "
            f"{LEFT:.0%}; take a coarser mesh"
        )
    return shapes


def _lowest(matrices: Matrices, count: int) -> tuple[Array, Array]:
    return modes(matrices.K, matrices.M, count)


def _norms(flexibilities: Complex) -> Array:
    return np.asarray(np.linalg.norm(flexibilities, ord=2, axis=(1, 2)))
