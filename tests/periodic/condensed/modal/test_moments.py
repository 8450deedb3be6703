"""Moments of exponentials against quadrature, on both sides of where their series ends."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.condensed.modal.moments import SERIES_UP_TO, Moments
from periodic.orbit.scheme import Family, Scheme

EXPONENTS = [
    0.0,
    0.1j,
    -2 + 1j,
    (SERIES_UP_TO - 0.01) * 1j,
    (SERIES_UP_TO + 0.01) * 1j,
    5j,
    -3.1 + 0.2j,
    40j,
    -50 + 3j,
]


@pytest.mark.parametrize("ncol", [2, 5, 7])
@pytest.mark.parametrize("x", EXPONENTS)
def test_moments_are_the_integrals(ncol: int, x: complex) -> None:
    """Assert int exp(x (c - s)) l(s) ds to 12 digits, and its derivative in x by differences to 7."""
    moments = Moments(Scheme(Family.RADAU, ncol))
    points, step = moments.scheme.points, 1e-5
    found = moments.table(np.array([x, x + step, x - step], dtype=complex))
    nodes, weights = np.polynomial.legendre.leggauss(200)
    place, weights = (nodes + 1) / 2, weights / 2
    for a, end in enumerate(points):
        basis = moments.scheme.algebraic_basis(end * place)
        integral = (np.exp(x * end * (1 - place)) * weights * end) @ basis
        assert np.allclose(found.moment[0, a], integral, rtol=0, atol=1e-12)
    slope = (found.moment[1] - found.moment[2]) / (2 * step)
    assert np.allclose(found.slope[0], slope, rtol=0, atol=3e-7)
