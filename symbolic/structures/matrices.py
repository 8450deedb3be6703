"""The matrices of a linear structure, M q'' + (C + Omega G) q' + K q = f, and what they must be."""

from __future__ import annotations

import contextlib
import math
import operator
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh, splu

from symbolic.arrays import Array
from symbolic.checks import mapping, refusal, text, whole
from symbolic.structures.rounding import hidden

sparse: Any = scipy.sparse
"""Untyped: its stubs tell kinds apart that are one here."""

Matrix = Any
"""numpy.ndarray or scipy.sparse array, shape (n, n)."""

DENSE = 500
"""Up to this size eigenproblems of symmetric matrices are solved in full."""

RELATIVE_STEP = float(np.finfo(float).eps) ** (1 / 3)
"""Of central differences of matrices, over the argument: there h^2 is the rounding eps / h."""

REGULAR = 1e3 * float(np.finfo(float).eps)
"""Part of M, in units of K / M, that makes a singular K regular beyond rounding."""

BELOW = 0.1
"""Distance of the shift below the lowest elastic mode, as a part of its omega^2."""

SYMMETRY = 1e-8
"""Largest difference of an entry of M or K from its mirror image, relative to the largest entry."""


@dataclass(frozen=True, eq=False)
class Matrices:
    """A linear structure M q'' + (C + Omega G) q' + K q = f of n degrees of freedom.

    Parameters
    ----------
    M : array_like or scipy.sparse, shape (n, n)
        Mass, symmetric and positive definite (kg).
    C : array_like or scipy.sparse, shape (n, n)
        Damping (N s/m); zero where None is given.
    K : array_like or scipy.sparse, shape (n, n)
        Stiffness (N/m). It need not be symmetric (a bearing's is not).
    G : array_like or scipy.sparse, shape (n, n), optional
        Gyroscopic matrix: C + Omega G at the speed Omega in rad/s.
    at : mapping of str to int
        Places: names of degrees of freedom by their index, counted from 0.

    Raises
    ------
    ValueError
        For a matrix that is not square, not finite or not of the size of M, an M that is not symmetric and
        positive definite, an index out of range.

    Notes
    -----
    A matrix given sparse stays sparse (CSR), all others become arrays of floats.
    """

    M: Matrix
    C: Matrix
    K: Matrix
    G: Matrix = None
    at: Mapping[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        mass = square("M", self.M)
        size = mass.shape[0]
        _definite(mass)
        set_ = object.__setattr__
        set_(self, "M", mass)
        set_(self, "K", square("K", self.K, size))
        set_(self, "C", zeros_like(mass) if self.C is None else square("C", self.C, size))
        set_(self, "G", None if self.G is None else square("G", self.G, size))
        set_(self, "at", {text("a place", p): index(p, i, size) for p, i in mapping("at", self.at).items()})

    @property
    def size(self) -> int:
        """Number n of degrees of freedom."""
        return int(self.M.shape[0])

    @property
    def first_frequency(self) -> float:
        """Lowest undamped natural frequency that is not zero, in Hz: a model in wrong units says so by it."""
        squares, shapes = modes(self.K, self.M, min(self.size, 12))
        elastic = squares[(squares > 1e-9 * np.abs(squares).max()) & ~hidden(self.K, squares, shapes)]
        return math.sqrt(elastic[0]) / (2 * math.pi) if len(elastic) else 0.0

    def __getitem__(self, place: str) -> int:
        if place not in self.at:
            raise refusal(
                "place", place, f"one of {', '.join(self.at) or 'none: the structure names no place'}"
            )
        return self.at[place]

    def __repr__(self) -> str:
        names = list(self.at)
        shown = names if len(names) <= 8 else [*names[:4], "...", names[-1]]
        places = ", ".join(shown) or "no named places"
        first = f"first natural frequency {self.first_frequency:.6g} Hz"
        return f"<Matrices: {self.size} degrees of freedom, {first}; {places}>"


def square(name: str, given: Any, size: int | None = None) -> Matrix:
    """Return a square matrix of finite numbers, of n = `size` rows where it is given. Raises ValueError."""
    matrix = _floats(name, given)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or 0 in matrix.shape:
        raise ValueError(f"{name} has shape {matrix.shape}; it must be square")
    if size is not None and matrix.shape[0] != size:
        rows = matrix.shape[0]
        raise ValueError(f"{name} is {rows} x {rows}; it must be {size} x {size}, as the mass matrix is")
    if not np.isfinite(matrix.data if sparse.issparse(matrix) else matrix).all():
        raise ValueError(f"{name} has entries that are not finite; all of them must be finite numbers")
    return matrix


def index(place: str, given: Any, size: int) -> int:
    """Return the index of a degree of freedom. Raises ValueError."""
    try:
        number = -1 if isinstance(given, bool) else operator.index(given)
    except TypeError:
        number = -1
    if not 0 <= number < size:
        raise refusal(f"the index of place {place!r}", given, f"a whole number from 0 to {size - 1}")
    return number


def zeros_like(matrix: Matrix) -> Matrix:
    """Return zeros of a matrix's size and kind."""
    n = matrix.shape[0]
    return sparse.csr_array((n, n)) if sparse.issparse(matrix) else np.zeros((n, n))


def dense(matrix: Matrix) -> Array:
    """Return a matrix as an array."""
    return np.asarray(matrix.toarray() if sparse.issparse(matrix) else matrix, dtype=float)


def lowest(stiffness: Matrix, mass: Matrix, count: int) -> Array:
    """Return the `count` lowest omega^2 of K phi = omega^2 M phi, of the symmetric part of K, ascending."""
    return modes(stiffness, mass, count)[0]


def modes(stiffness: Matrix, mass: Matrix, count: int) -> tuple[Array, Array]:
    """Return the `count` lowest undamped modes of K phi = omega^2 M phi, normalised to phi' M phi = 1.

    Parameters
    ----------
    stiffness, mass : array or scipy.sparse, shape (n, n)
        K (its symmetric part counts) and M.
    count : int
        How many.

    Returns
    -------
    squares : ndarray, shape (count,)
        omega^2 in rad^2/s^2, ascending; those of rigid-body modes are zero to rounding.
    shapes : ndarray, shape (n, count)
        Mode shapes phi.

    Raises
    ------
    ValueError
        For more modes than degrees of freedom.
    ArithmeticError
        Where Lanczos' method with shift-invert does not converge.
    """
    n = mass.shape[0]
    if whole("modes", count, 1) > n:
        raise refusal("modes", count, f"a whole number from 1 to {n}, the degrees of freedom")
    symmetric = (stiffness + stiffness.T) / 2
    if n <= DENSE or count > n // 2:
        squares, shapes = scipy.linalg.eigh(dense(symmetric), dense(mass), subset_by_index=(0, count - 1))
        return squares, shapes
    pencil = sparse.csc_array(symmetric), sparse.csc_array(mass)
    try:
        return _by_lanczos(*pencil, count)
    except ArpackNoConvergence as error:
        raise ArithmeticError(f"the {count} lowest modes were not found: {error}") from None


def _by_lanczos(stiffness: Matrix, mass: Matrix, count: int) -> tuple[Array, Array]:
    """The lowest modes by shift-invert about 0; a little below where K is singular, by rigid-body modes.

    The nearer the shift is to the modes, the less of them is lost: first from one at which K is regular for
    certain, then from one just below the lowest elastic mode that this has found.
    """
    with contextlib.suppress(SingularError):
        squares, shapes = _about(stiffness, mass, count, 0.0)
        if not hidden(stiffness, squares, shapes).any():
            return squares, shapes
    squares, shapes = _about(stiffness, mass, count, -REGULAR * float(abs(stiffness).sum() / abs(mass).sum()))
    elastic = squares[~hidden(stiffness, squares, shapes) & (squares > 0)]
    return _about(stiffness, mass, count, -BELOW * float(elastic[0])) if len(elastic) else (squares, shapes)


class SingularError(ArithmeticError):
    """A pencil that cannot be factorised at a shift."""


def _about(stiffness: Matrix, mass: Matrix, count: int, shift: float) -> tuple[Array, Array]:
    """The modes next to a shift, ascending; from one start, so that they are the same each time.

    Rayleigh's quotient has the errors of the shapes, by rounding of the factors, by their squares alone.
    Raises SingularError where K - shift M is singular.
    """
    start = np.random.default_rng(0).normal(size=mass.shape[0])
    try:
        factors = splu(stiffness - shift * mass)
    except RuntimeError:
        raise SingularError from None
    inverse = LinearOperator(mass.shape, factors.solve, dtype=float)
    _, shapes = eigsh(stiffness, count, mass, sigma=shift, which="LM", v0=start, OPinv=inverse)
    squares = np.einsum("nj,nj->j", shapes, stiffness @ shapes)
    order = np.argsort(squares)
    return squares[order], shapes[:, order]


def _floats(name: str, given: Any) -> Matrix:
    if sparse.issparse(given):
        if np.iscomplexobj(given.data):
            raise ValueError(f"{name} is complex; it must be real")
        return sparse.csr_array(given, dtype=float)
    try:
        array = np.asarray(given)
        if np.iscomplexobj(array):
            raise ValueError(f"{name} is complex; it must be real")
        return np.array(array, dtype=float)
    except (TypeError, ValueError) as error:
        if "complex" in str(error):
            raise
        raise refusal(name, given, "a square matrix of numbers") from None


def _definite(mass: Matrix) -> None:
    """Refuse a mass matrix that is not symmetric and positive definite."""
    largest = abs(mass).max()
    if abs(mass - mass.T).max() > SYMMETRY * largest:
        raise ValueError("M is not symmetric; a mass matrix must be symmetric and positive definite")
    where = np.flatnonzero(mass.diagonal() <= 0)
    if len(where):
        value = mass.diagonal()[where[0]]
        raise ValueError(
            f"M has {value:g} on its diagonal at degree of freedom {where[0]}; a mass matrix must be "
            f"positive definite: condense or drop degrees of freedom without mass"
        )
    if not _is_definite(mass):
        raise ValueError("M is singular or indefinite; a mass matrix must be positive definite")


def _is_definite(mass: Matrix) -> bool:
    if mass.shape[0] <= DENSE:
        scale = np.sqrt(mass.diagonal())
        return bool(np.linalg.eigvalsh(dense(mass) / scale[:, None] / scale)[0] > 1e-13)
    diagonal = sparse.diags_array(1 / np.sqrt(mass.diagonal()))
    scaled = sparse.csc_array(diagonal @ mass @ diagonal)
    factors = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0)
    return bool((factors.U.diagonal() > 1e-13).all() and (factors.perm_r == factors.perm_c).all())
