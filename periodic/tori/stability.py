"""Stability of tori: multipliers of the motions beside them.

A change w(theta) of the section is turned back and mapped, (L w)(theta) = DP(theta - rho) w(theta - rho).
Where the torus is reducible the spectrum of L is mu e^{i k rho}, for n multipliers mu and every whole k
(Jorba, Nonlinearity 14 (2001) 943): n circles of eigenvalues, whose radii are the multipliers' moduli. The
vector of mu e^{i k rho} is e^{i k theta} times that of mu: mu is where the mean of a vector's harmonics is 0.
One multiplier is 1, along theta; of a free torus two are, along the flow too. Where others reach the circle
three bifurcations are told apart: a real one at 1 (BP, or LP where the family turns back); a real one at -1,
or whose vector changes sign round the section, with harmonics about 1/2 (PD); and a pair (NS).
"""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.label import Label
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.tori.grid import Grid
from periodic.tori.invariance import Invariance
from periodic.tori.section import Section

FINE = 1e-11
"""Tolerance of the integration."""

MOST = 800
"""Most numbers on a section whose eigenvalues are computed; beyond, fewer angles are taken."""

SMOOTH = 0.25
"""Mean harmonic of the eigenvectors that are taken, as a part of the number of angles."""

AT_ONE = 1e-3
"""A modulus nearer to 1 than this, or two of a ratio nearer to it, are not told apart."""


def torus_multipliers(system: System, torus: Section) -> Array:
    """Return the n multipliers of a torus over a period, the largest first.

    Their arguments are known but for multiples of rho; of vectors that change sign round the section they are
    turned by rho / 2.

    Parameters
    ----------
    system : System
        The equations.
    torus : Section
        The torus.

    Returns
    -------
    ndarray of complex, shape (n,)
        The multipliers. That along theta is 1, and of a free torus that along the flow; how near their moduli
        come shows how accurate the others are.

    Raises
    ------
    ArithmeticError
        Where a motion on the torus cannot be followed.
    """
    return _spectrum(system, torus)[0]


def crossing(system: System, torus: Section) -> Label:
    """Return what happens on a torus where a multiplier, or a pair, is on the unit circle: BP, PD or NS."""
    found, halves = _spectrum(system, torus)
    near = np.abs(np.log(np.maximum(np.abs(found), np.finfo(float).tiny))) < AT_ONE
    others = sorted(np.flatnonzero(near), key=lambda k: (bool(halves[k]), abs(found[k] - 1)))
    others = others[2 if torus.free else 1 :]
    if len(others) > 1:
        return Label.TORUS
    return Label.DOUBLING if any(halves[k] or found[k].real < 0 for k in others) else Label.BRANCH


def across(sizes: Array, free: bool) -> Array:
    """Return which multipliers, by their moduli, are not those along the torus: their indices."""
    along = 2 if free else 1
    at_one = np.argsort(np.abs(np.log(np.maximum(sizes, np.finfo(float).tiny))), kind="stable")[:along]
    return np.setdiff1d(np.arange(len(sizes)), at_one)


def stable(sizes: Array, free: bool) -> bool:
    """Return whether a torus attracts: all moduli but those along it are below 1."""
    return bool((sizes[across(sizes, free)] < 1 - AT_ONE).all())


def _spectrum(system: System, torus: Section) -> tuple[Array, Array]:
    """The multipliers, and whether the vector of each changes sign round the section."""
    n = torus.states.shape[1]
    values, means = _eigenvalues(system, torus)
    order = np.argsort(-np.abs(values), kind="stable")
    values, means = values[order], means[order]
    groups = np.array_split(values, n)
    sizes = np.array([np.median(np.abs(group)) for group in groups])
    ends = [0, *np.cumsum([len(group) for group in groups])]
    found, halves, k = np.zeros(n, dtype=complex), np.zeros(n, dtype=bool), 0
    while k < n:
        alike = k + 1
        while alike < n and np.log(sizes[k] / max(sizes[alike], np.finfo(float).tiny)) < AT_ONE:
            alike += 1
        group = slice(ends[k], ends[alike])
        middle = ends[k] + np.lexsort((-values[group].imag, np.round(np.abs(means[group]), 2)))[: alike - k]
        for place, j in enumerate(middle, k):
            found[place] = sizes[place] * np.exp(1j * np.angle(values[j]))
            halves[place] = 0.25 < abs(means[j]) < 0.75
        k = alike
    return found, halves


def _eigenvalues(system: System, torus: Section) -> tuple[Array, Array]:
    """The eigenvalues of L whose vectors are smooth, and the mean of each vector's harmonics."""
    count, n = torus.states.shape
    grid = torus.grid if count * n <= MOST else Grid(MOST // n // 2 * 2 - 1, torus.breaks)
    count = grid.count
    slopes = Invariance(system, 0, FINE).mapped(torus, torus.states_at(grid.angles - torus.rotation))[1]
    back = grid.interpolation(grid.angles - torus.rotation)[0]
    matrix = np.einsum("jk,jab->jakb", back, slopes).reshape(count * n, count * n)
    values, vectors = np.linalg.eig(matrix)
    even = grid.interpolation(Grid(count).angles)[0]
    shapes = np.einsum("jk,kas->jas", even, vectors.reshape(count, n, -1))
    harmonics = np.abs(np.fft.fft(shapes, axis=0)) ** 2
    harmonics = harmonics.sum(axis=1)
    harmonics = harmonics / np.maximum(harmonics.sum(axis=0), np.finfo(float).tiny)
    orders = np.fft.fftfreq(count, 1 / count)
    rough = np.abs(orders) @ harmonics
    smooth = np.argsort(rough, kind="stable")[: max(n, int(SMOOTH * count) * n)]
    return values[smooth], orders @ harmonics[:, smooth]
