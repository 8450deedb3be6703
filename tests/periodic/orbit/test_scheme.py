"""Collocation schemes: points, quadrature and differentiation against what is known of them."""

import numpy as np
import pytest

import periodic as per

FAMILIES = tuple(per.Family)
NCOLS = range(2, 8)


@pytest.fixture(params=[(family, ncol) for family in FAMILIES for ncol in NCOLS], ids=str)
def scheme(request: pytest.FixtureRequest) -> per.Scheme:
    """Every scheme there is."""
    return per.Scheme(*request.param)


def test_derivatives_are_exact(scheme: per.Scheme) -> None:
    """Assert that the differentiation matrix is exact for every polynomial of degree up to ncol."""
    for degree in range(scheme.ncol + 1):
        exact = degree * scheme.knots ** max(degree - 1, 0)
        assert scheme.differentiation @ scheme.knots**degree == pytest.approx(exact, abs=1e-11)


def test_interpolation_is_exact(scheme: per.Scheme) -> None:
    """Assert that the basis reproduces polynomials of degree ncol, and that of the unknowns of ncol - 1."""
    theta = np.linspace(0.0, 1.0, 11)
    assert scheme.basis(theta) @ scheme.knots**scheme.ncol == pytest.approx(theta**scheme.ncol, abs=1e-12)
    degree = scheme.ncol - 1
    assert scheme.algebraic_basis(theta) @ scheme.points**degree == pytest.approx(theta**degree, abs=1e-12)


def test_end_value(scheme: per.Scheme) -> None:
    """Assert that the weights of the end give a polynomial's value at 1."""
    assert scheme.end @ scheme.knots**scheme.ncol == pytest.approx(1.0, abs=1e-13)


def quadrature(scheme: per.Scheme) -> np.ndarray:
    """Weights w with x(1) = sum of w x'(c) for x(0) = 0: one step of the scheme on x' = f(tau)."""
    return scheme.end[1:] @ np.linalg.inv(scheme.differentiation[1:, 1:])


def test_quadrature_degree(scheme: per.Scheme) -> None:
    """Assert that quadrature is exact up to degree 2 ncol - 1 (Gauss) or 2 ncol - 2 (Radau), no further."""
    degree = 2 * scheme.ncol - (1 if scheme.family is per.Family.GAUSS else 2)
    weights = quadrature(scheme)
    errors = [abs(weights @ scheme.points**k - 1 / (k + 1)) for k in range(degree + 2)]
    assert max(errors[:-1]) < 1e-14 * 10
    assert errors[-1] > 100 * max(errors[:-1])


def test_quadrature_weights_are_positive(scheme: per.Scheme) -> None:
    """Assert that all weights are positive and add up to 1."""
    weights = quadrature(scheme)
    assert (weights > 0).all()
    assert weights.sum() == pytest.approx(1.0, abs=1e-13)


@pytest.mark.parametrize("ncol", NCOLS)
def test_radau_ends_at_one(ncol: int) -> None:
    """Assert that Radau IIA has its last point at exactly 1 and the others inside."""
    points = per.Scheme(per.Family.RADAU, ncol).points
    assert points[-1] == 1.0
    assert (np.diff(points) > 0).all() and points[0] > 0 and points[-2] < 1


@pytest.mark.parametrize("ncol", NCOLS)
def test_gauss_is_symmetric(ncol: int) -> None:
    """Assert that Gauss points lie symmetrically about 1/2, both ends left out."""
    points = per.Scheme(per.Family.GAUSS, ncol).points
    assert points + points[::-1] == pytest.approx(1.0, abs=1e-15)
    assert (np.diff(points) > 0).all() and points[0] > 0


def test_radau_of_two() -> None:
    """Assert the points of Radau IIA with two stages: 1/3 and 1."""
    assert per.Scheme(per.Family.RADAU, 2).points == pytest.approx([1 / 3, 1.0], abs=1e-15)


@pytest.mark.parametrize("ncol", [-1, 0, 1, 8, 100])
def test_ncol_out_of_range(ncol: int) -> None:
    """Assert that a number of points outside 2 to 7 is refused in one sentence."""
    with pytest.raises(ValueError, match=f"^ncol is {ncol}; it must be a whole number from 2 to 7$"):
        per.Scheme(per.Family.RADAU, ncol)


@pytest.mark.parametrize("ncol", [2.5, float("nan")])
def test_ncol_not_whole(ncol: float) -> None:
    """Assert that a number of points that is not whole is refused in the same sentence."""
    with pytest.raises(ValueError, match="^ncol is .*; it must be a whole number from 2 to 7$"):
        per.Scheme(per.Family.GAUSS, ncol)  # type: ignore[arg-type]
