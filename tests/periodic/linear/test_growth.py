"""Orbits beside motions that grow by many decades: elimination from both ends, multipliers one by one."""

from __future__ import annotations

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.linear.pairwise import reduce
from periodic.stability.product import multipliers

DECADES = np.array([30.0, 4.0, -1.0, -1.0, -25.0])
ANGLE = 0.7


def steps(count: int = 60) -> np.ndarray:
    """Factors whose product has the moduli 10^DECADES, the two equal ones as a pair at the angle ANGLE."""
    rng = np.random.default_rng(3)
    frames = [np.linalg.qr(rng.normal(size=(5, 5)))[0] + 0.2 * rng.normal(size=(5, 5)) for _ in range(count)]
    frames.append(frames[0])
    growth = np.diag(10.0 ** (DECADES / count))
    c, s = np.cos(ANGLE / count), np.sin(ANGLE / count)
    growth[2:4, 2:4] = 10.0 ** (DECADES[2] / count) * np.array([[c, -s], [s, c]])
    return np.array([frames[j + 1] @ growth @ np.linalg.inv(frames[j]) for j in range(count)])


def test_multipliers_over_55_decades() -> None:
    """Assert all five multipliers relatively, the pair with its angle."""
    found = multipliers(steps())
    wanted = 10.0**DECADES * np.exp(1j * ANGLE * np.array([0, 0, 1, -1, 0]))
    order = np.lexsort([-found.imag, -np.round(np.log10(np.abs(found)))])
    assert np.abs(found[order] / wanted - 1).max() < 1e-12


@pytest.mark.parametrize("count", [1, 2, 7, 60])
def test_reduction_solves_the_chain(count: int) -> None:
    """Assert mesh points between given ends against the whole system solved at once."""
    rng = np.random.default_rng(count)
    factors = steps(max(count, 30))[:count]
    chain = np.concatenate([rng.normal(size=(count, 5, 1)), factors, rng.normal(size=(count, 5, 2))], axis=2)
    reduced, outer = reduce(chain), rng.normal(size=2)
    matrix, right = np.zeros((5 * count + 5, 5 * count + 5)), np.zeros(5 * count + 5)
    for j in range(count):
        rows = slice(5 * j, 5 * j + 5)
        matrix[rows, 5 * j : 5 * j + 5], matrix[rows, 5 * j + 5 : 5 * j + 10] = -factors[j], np.eye(5)
        right[rows] = chain[j, :, 0] + chain[j, :, 6:] @ outer
    matrix[-5:, :5], matrix[-5:, -5:] = -np.eye(5), np.eye(5)
    whole = np.linalg.solve(matrix, right).reshape(count + 1, 5)
    both = np.concatenate([[1.0], whole[0], whole[-1], outer])
    size = np.abs(whole).max()
    assert np.abs(reduced.ends @ both).max() < 1e-12 * size
    assert np.abs(reduced.maps @ both - whole).max() < 1e-11 * size


@pytest.mark.parametrize("rate", [5.0, 30.0])
def test_inverted_oscillator(rate: float) -> None:
    """Assert orbit and multipliers of x'' = L^2 x - .1 x^3 + cos(Omega t) to L = 30, exp(1e2) in a period.

    x is small: its response and its multipliers are those without the cube to x^2 / L^2.
    """
    x = sym.coordinate("x")
    model = sym.Mass(x, 1.0) + sym.Spring(x, -(rate**2)) + sym.CubicSpring(x, 0.1) + sym.HarmonicForce(x, 1.0)
    branch = per.trace(sym.compile(model), "Omega", (0.5, 1.5))
    assert branch.stop.reason is per.Reason.BOUND
    for point in branch:
        amplitude = 1 / (rate**2 + point.parameter**2)
        assert point.maximum["x"] == pytest.approx(amplitude, rel=amplitude**2)
        wanted = 2 * np.pi * rate / point.parameter
        assert np.log(np.abs(point.multipliers)) == pytest.approx([wanted, -wanted], rel=1e-4)
        assert np.prod(point.multipliers) == pytest.approx(1.0, abs=1e-6)
        assert not point.stable
