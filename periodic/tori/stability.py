"""Stability of tori: multipliers of the motions beside them.

A change w(theta) of the section is turned back and mapped, (L w)(theta) = DP(theta - rho) w(theta - rho).
Where the torus is reducible the spectrum of L is mu e^{i k rho}, for n multipliers mu and every whole k
(Jorba, Nonlinearity 14 (2001) 943): n circles of eigenvalues, whose radii are the multipliers' moduli. One is
1, along theta; of a free torus two are, along the flow too.
"""

from __future__ import annotations

import numpy as np

from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.tori.invariance import Invariance, angles
from periodic.tori.section import Section, kernel

FINE = 1e-11
"""Tolerance of the integration."""

MOST = 800
"""Most numbers on a section whose eigenvalues are computed; beyond, fewer angles are taken."""

SMOOTH = 0.25
"""Mean harmonic of the eigenvectors that are taken, as a part of the number of angles."""

AT_ONE = 1e-3
"""A modulus nearer to 1 than this is not told from it."""


def moduli(system: System, torus: Section) -> Array:
    """Return the moduli of the n multipliers of a torus over a period, the largest first.

    Parameters
    ----------
    system : System
        The equations.
    torus : Section
        The torus.

    Returns
    -------
    ndarray, shape (n,)
        The moduli. That along theta is 1, and of a free torus that along the flow; how near they come shows
        how accurate the others are.

    Raises
    ------
    ArithmeticError
        Where a motion on the torus cannot be followed.
    """
    count, n = torus.states.shape
    slopes = Invariance(system, 0, FINE).mapped(torus)[1]
    if count * n > MOST:
        fewer = MOST // n // 2 * 2 - 1
        turn = np.subtract.outer(angles(fewer), angles(count))
        slopes, count = np.einsum("jk,kab->jab", kernel(count, turn)[0], slopes), fewer
    own = angles(count)
    back = kernel(count, np.subtract.outer(own - torus.rotation, own))[0]
    matrix = np.einsum("jk,kab->jakb", back, slopes).reshape(count * n, count * n)
    values, vectors = np.linalg.eig(matrix)
    harmonics = np.abs(np.fft.fft(vectors.reshape(count, n, -1), axis=0)) ** 2
    orders = np.abs(np.fft.fftfreq(count, 1 / count))
    rough = np.einsum("k,kaj->j", orders, harmonics) / harmonics.sum(axis=(0, 1))
    smooth = np.argsort(rough, kind="stable")[: max(n, int(SMOOTH * count) * n)]
    sizes = np.sort(np.abs(values[smooth]))[::-1]
    return np.array([float(np.median(group)) for group in np.array_split(sizes, n)])


def stable(sizes: Array, free: bool) -> bool:
    """Return whether a torus attracts: all moduli but those along it are below 1."""
    along = 2 if free else 1
    others = np.delete(sizes, np.argsort(np.abs(np.log(np.maximum(sizes, 1e-300))))[:along])
    return bool((others < 1 - AT_ONE).all())
