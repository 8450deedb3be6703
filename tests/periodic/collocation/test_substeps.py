"""Into how many substeps intervals are divided where perturbations grow."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.collocation.fastmotions.substeps import GROWING, MOST_SUBSTEPS, substeps
from periodic.orbit.scheme import Array

INTERVALS = 40


def divided(exponents: list[float]) -> tuple[list[int], Array]:
    """Counts of intervals whose Jacobians times width have these eigenvalues, and those that are computed."""
    random = np.random.default_rng(0).standard_normal((INTERVALS, len(exponents), len(exponents)))
    basis = np.linalg.qr(random)[0]
    jacobian = basis * np.array(exponents) @ np.swapaxes(basis, 1, 2)
    found = np.linalg.eigvals(jacobian).astype(np.complex128)
    return sorted({int(count) for count in substeps(found)}), found.real.max(axis=1)


def test_rounding_is_no_growth() -> None:
    """Assert that an eigenvalue beyond GROWING is none beside a rate of stick of which it is a rounding.

    It once cost a third of the disc's branch.
    """
    counts, growth = divided([-3e16, -1e-3, -1e-2])
    assert growth.max() > GROWING
    assert counts == [1]


@pytest.mark.parametrize(
    ("exponents", "expected"),
    [([-0.5, 2.0, -1e-2], [3]), ([-1e6, 2.0, 0.0], [MOST_SUBSTEPS]), ([-1e6, 0.5, 0.0], [1])],
)
def test_growth_is_followed(exponents: list[float], expected: list[int]) -> None:
    """Assert what growth is divided into by itself, and with fast decay beside it."""
    assert divided(exponents)[0] == expected
