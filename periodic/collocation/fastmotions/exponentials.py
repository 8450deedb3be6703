"""Perturbations that vibrate faster than the mesh of a slow orbit resolves, followed by exponentials.

Of x' = A(t) x, A along the orbit's polynomials, a part of an interval, of length h, has the mean matrix a.
About its middle, where s = 0,

    x(h/2) = exp(a h/2) (1 - S/2)^-1 (1 + S/2) exp(a h/2) x(-h/2),   S = int e^{-a s} (A(s) - a) e^{a s} ds,

the first term of Magnus' series in a frame that vibrates as a does. In the modes of a, A - a is a polynomial
and the integral with exponentials is exact: h need resolve how A changes, not the vibrations. The error is of
fourth order and even, so that parts of h, h/2, h/4, ... are extrapolated, in each interval until two agree.

References
----------
Iserles, BIT 42 (2002) 561 (modified Magnus methods); Hairer, Norsett & Wanner, Solving Ordinary Differential
Equations I, II.9 (extrapolation).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import TypeVar

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.collocation.fastmotions.unresolved import FAST, growth
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import System
from periodic.system.precision import EPSILON

POINTS = 4
"""Gauss points of a part at which the matrix is evaluated; its polynomial is of one degree less."""

ORDER = 4
"""Order of the error in the length of the parts, before they are extrapolated."""

GONE = float(-np.log(EPSILON))
"""Decay in an interval (a logarithm) above which a vibration is gone at its end."""

MOST_PARTS = 64
"""Into how many an interval is divided at the most, a power of 2."""

SHORT = 1.0
"""Exponent up to which moments of an exponential are summed as series."""

TERMS = 18
"""How many of their terms are summed: 1/18! is rounding."""

Complex = NDArray[np.complex128]
Number = TypeVar("Number", np.float64, np.complex128)


@dataclass(frozen=True)
class Exponentials:
    """How perturbations pass from one mesh point to the next, steps (N, n, n).

    turning: the mean of A over each interval, times its width, shape (N, n, n).
    """

    steps: Array
    turning: Array

    @cached_property
    def fundamental(self) -> Array:
        """Fundamental matrices at the mesh points, shape (N+1, n, n)."""
        return np.array(
            list(accumulate(self.steps, lambda x, step: step @ x, initial=np.eye(len(self.steps[0]))))
        )


def vibrates(scheme: Scheme, exponents: Complex, tolerance: float, finer: float = 1.0) -> bool:
    """Return whether a mesh is too coarse for the multipliers of fast vibrations.

    Parameters
    ----------
    scheme : Scheme
        The scheme of the mesh.
    exponents : Array
        Eigenvalues of J, dx/dtau = J x about the middle of each interval, times its width, shape (N, n).
    tolerance : float
        Error of the multipliers that is tolerated.
    finer : float
        By how much the intervals are shorter than these widths.

    Returns
    -------
    bool
        Whether one turns by more than FAST in an interval, and the scheme's error in it there, of what is
        left of it over the period, exceeds the tolerance.
    """
    fast = (np.abs(exponents.imag) > FAST) & (exponents.real > -GONE)
    if not fast.any():
        return False
    least = np.where(fast, exponents.real, -np.inf).max(axis=1)
    left = np.exp(min(float(least[fast.any(axis=1)].sum()) / finer, 0.0))
    off = np.abs(growth(scheme, exponents[fast]) * np.exp(-exponents[fast]) - 1)
    return bool(left * off.max() > tolerance)


def exponentials(system: System, orbit: Orbit, tolerance: float) -> Exponentials | None:
    """Return how perturbations of an orbit pass on, to a tolerance.

    Parameters
    ----------
    system : System
        The equations, without jumps.
    orbit : Orbit
        The orbit.
    tolerance : float
        Bound of the sum over the intervals of the last changes of their steps, in modes, by extrapolation.

    Returns
    -------
    Exponentials or None
        None where the mean matrix has no basis of modes, as with rigid-body motions, or where the steps do
        not converge, as beside motions that decay by hundreds of decades in an interval.
    """
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows does not converge
            return _found(_Matrices(system, orbit), tolerance / orbit.mesh.ntst)
    except np.linalg.LinAlgError:  # the modes of a part are no basis
        return None


def _found(matrices: _Matrices, tolerance: float) -> Exponentials | None:
    """The same, to a tolerance in each interval. Raises numpy.linalg.LinAlgError."""
    width = matrices.orbit.grid.width
    turning = _mean(matrices.at(1, np.arange(len(width)))) * width[:, None, None]
    frame = _frame(turning.sum(axis=0) / width.sum())
    if not EPSILON * np.linalg.cond(frame.modes) < tolerance:
        return None
    found = _extrapolated(matrices, frame, tolerance)
    return None if found is None else Exponentials(frame.back(found), turning)


@dataclass(frozen=True)
class _Frame:
    """Where steps are computed and compared.

    size: of the states (n,), by which they are alike. modes: of the mean matrix of states so scaled (n, n).
    """

    size: Array
    modes: Complex

    def scaled(self, matrices: Array) -> Array:
        """Matrices of states that are scaled."""
        return matrices * (self.size / self.size[:, None])

    def of(self, matrices: Complex) -> Complex:
        """Matrices in modes, of those of scaled states."""
        return np.asarray(np.linalg.solve(self.modes, matrices @ self.modes))

    def back(self, matrices: Complex) -> Array:
        """Matrices of states, of those in modes."""
        scaled = (self.modes @ matrices @ np.linalg.inv(self.modes)).real
        return np.asarray(scaled * (self.size[:, None] / self.size))


def _frame(mean: Array) -> _Frame:
    """Sizes by which the mean matrix is balanced, and its modes then."""
    balanced, (size, _) = scipy.linalg.matrix_balance(mean, permute=False, separate=True)
    return _Frame(size.astype(float), np.linalg.eig(balanced)[1].astype(np.complex128))


@dataclass(frozen=True)
class _Matrices:
    """The matrix A of dx/dtau = A x along an orbit."""

    system: System
    orbit: Orbit

    def at(self, parts: int, chosen: NDArray[np.int_]) -> Array:
        """At the Gauss points of equal parts of chosen intervals, shape (len(chosen) parts, POINTS, n, n)."""
        orbit, points = self.orbit, (1 + np.polynomial.legendre.leggauss(POINTS)[0]) / 2
        theta = ((np.arange(parts)[:, None] + points) / parts).ravel()
        basis = orbit.mesh.scheme.basis(theta)
        knots = np.concatenate([orbit.nodes[:-1, None, :], orbit.stages], axis=1)[chosen]
        rates, states = (basis @ values for values in (orbit.knot_rates[chosen], knots))
        phases = orbit.grid.left[chosen, None] + orbit.grid.width[chosen, None] * theta
        unknowns = _between(orbit, theta, chosen)
        flat = (phases.size, -1) if unknowns.size else (phases.size, 0)
        n = states.shape[-1]
        found = self.system.linearise(
            rates.reshape(-1, n),
            states.reshape(-1, n),
            unknowns.reshape(flat),
            phases.ravel(),
            orbit.parameter,
        )
        by_rates = np.concatenate([found.d_rate, found.d_algebraic], axis=2)
        return np.linalg.solve(by_rates, -found.d_state)[:, :n].reshape(-1, POINTS, n, n)


def _between(orbit: Orbit, theta: Array, chosen: NDArray[np.int_]) -> Array:
    """The algebraic unknowns at parts theta of chosen intervals, by polynomials."""
    scheme = orbit.mesh.scheme
    weights = np.vander(theta, scheme.ncol) @ np.linalg.inv(np.vander(scheme.points, scheme.ncol))
    return np.asarray(weights @ orbit.algebraic[chosen])


def _mean(matrices: NDArray[Number]) -> NDArray[Number]:
    """Means (..., n, n) of matrices at Gauss points, (..., POINTS, n, n)."""
    weights = np.polynomial.legendre.leggauss(POINTS)[1] / 2
    return np.asarray(np.einsum("m,...mab->...ab", weights, matrices))


def _extrapolated(matrices: _Matrices, frame: _Frame, tolerance: float) -> Complex | None:
    """The steps of all intervals in modes, from 1, 2, 4, ... parts; None where they do not agree."""
    count = matrices.orbit.mesh.ntst
    found = np.empty((count, *frame.modes.shape), dtype=np.complex128)
    left, row = np.arange(count), list[Complex]()
    for level in range(MOST_PARTS.bit_length()):
        new = [_steps(matrices, frame, 2**level, left)]
        for k, coarse in enumerate(row):
            new.append(new[k] + (new[k] - coarse) / (2.0 ** (ORDER + 2 * k) - 1))
        if row:
            off = np.abs(new[-1] - row[-1]).max(axis=(1, 2))
            done = off <= tolerance
            found[left[done]] = new[-1][done]
            left, new = left[~done], [each[~done] for each in new]
        if not len(left):
            return found
        row = new
    return None


def _steps(matrices: _Matrices, frame: _Frame, parts: int, chosen: NDArray[np.int_]) -> Complex:
    """Steps of chosen intervals, each of equal parts, in modes, shape (len(chosen), n, n)."""
    length = np.repeat(matrices.orbit.grid.width[chosen] / parts, parts)
    each = frame.of(_step(frame.scaled(matrices.at(parts, chosen)), length))
    each = each.reshape(len(chosen), parts, *each.shape[1:])
    found = each[:, 0]
    for k in range(1, parts):
        found = each[:, k] @ found
    return np.asarray(found)


def _step(given: Array, length: Array) -> Complex:
    """Steps over parts of lengths (J,) from the matrices at their Gauss points, (J, POINTS, n, n)."""
    mean = _mean(given)
    exponents, modes = np.linalg.eig(mean)
    inverse = np.linalg.inv(modes)
    apart = inverse[:, None] @ (given - mean[:, None]) @ modes[:, None]
    turned = _turned(apart, length, exponents)
    half, eye = np.exp(exponents * (length / 2)[:, None]), np.eye(exponents.shape[1])
    middle = np.linalg.solve(eye - turned / 2, eye + turned / 2)
    return np.asarray((modes * half[:, None, :]) @ middle @ (half[:, :, None] * inverse))


def _turned(matrices: Complex, length: Array, exponents: Complex) -> Complex:
    """The integral S over parts of lengths (J,): matrices (J, POINTS, n, n) in modes, exponents (J, n)."""
    places = np.polynomial.legendre.leggauss(POINTS)[0]
    powers = np.linalg.inv(np.vander(places, increasing=True))
    half = (length / 2)[:, None, None]
    moments = _moments((exponents[:, None, :] - exponents[:, :, None]) * half, POINTS)
    coefficients = np.einsum("pm,jmab->pjab", powers, matrices)
    return np.asarray(half * (coefficients * moments).sum(axis=0))


def _moments(z: Complex, count: int) -> Complex:
    """The integrals of u^p exp(z u) over (-1, 1), p < count, shape (count, *z.shape)."""
    short = np.abs(z) <= SHORT
    far, near = np.where(short, SHORT, z), np.where(short, z, 0.0)
    right, left = np.exp(far), np.exp(-far)
    series, term = np.zeros((count, *z.shape), dtype=np.complex128), np.ones_like(near)
    for k in range(TERMS):
        for p in range(k % 2, count, 2):
            series[p] += 2 / (p + k + 1) * term
        term = term * (near / (k + 1))
    found = np.empty_like(series)
    for p in range(count):
        ends = right - (-1) ** p * left
        by_parts = (ends - p * found[p - 1] if p else ends) / far
        found[p] = np.where(short, series[p], by_parts)
    return found
