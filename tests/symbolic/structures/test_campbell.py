"""Natural frequencies over the speed: of a gyroscopic disc and of damped masses in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import symbolic as sym
from symbolic.structures.campbell import Campbell


def test_forward_and_backward_frequencies() -> None:
    """Assert -w^2 +- g Omega w + k = 0 of a disc in two directions, as many as are asked for."""
    gyroscopic = np.array([[0.0, 0.5], [-0.5, 0.0]])
    matrices = sym.Matrices(np.eye(2), None, 4 * np.eye(2), G=gyroscopic)
    speeds = [0.0, 1.0, 3.0]
    found = sym.campbell(matrices, speeds, 2)
    shift = 0.25 * np.array(speeds)
    root = np.sqrt(4 + shift**2)
    assert found.speeds.tolist() == speeds
    assert found.frequencies == pytest.approx(np.stack([root - shift, root + shift], axis=1), rel=1e-9)
    assert np.abs(found.damping).max() < 1e-9
    assert sym.campbell(matrices, speeds, 1).frequencies.shape == (3, 1)


def test_damping_ratios_and_what_does_not_oscillate() -> None:
    """Assert both of one mass, and NaN for another that is damped beyond all oscillation."""
    matrices = sym.Matrices(np.eye(2), np.diag([0.4, 9.0]), np.diag([4.0, 1.0]))
    found = sym.campbell(matrices, [1.0], 3)
    assert found.frequencies[0, 0] == pytest.approx(2 * np.sqrt(1 - 0.1**2))
    assert found.damping[0, 0] == pytest.approx(0.1)
    assert np.isnan(found.frequencies[0, 1:]).all() and np.isnan(found.damping[0, 1:]).all()


def test_whirl_of_what_is_overdamped_is_none() -> None:
    """Assert that pairs that gyroscopic moments make of overdamped motions hide no natural frequency.

    Two planes, a soft mode each and a stiff one that is overdamped: alike in both planes, that is a double
    real exponent, which the gyroscopic matrix parts along the imaginary axis.
    """
    once = np.diag([1.0, 1e8])
    damping, turning = np.diag([0.02, 1e6]), np.diag([0.1, 1.0])
    plane = np.zeros((2, 2))
    matrices = sym.Matrices(
        np.eye(4),
        np.block([[damping, plane], [plane, damping]]),
        np.block([[once, plane], [plane, once]]),
        G=np.block([[plane, turning], [-turning, plane]]),
    )
    found = sym.campbell(matrices, np.linspace(0.0, 3.0, 13), 4)
    every = np.linalg.eigvals(
        np.block([[np.zeros((4, 4)), np.eye(4)], [-matrices.K, -matrices.C - 3.0 * matrices.G]])
    )
    assert (every.imag > 0).sum() == 4  # the two of the overdamped ones are there
    assert np.isfinite(found.frequencies).sum(axis=1).tolist() == [2] * 13
    for speed, row in zip(found.speeds, found.frequencies, strict=True):  # of x + iy
        exact = np.sort(abs(np.roots([1.0, 0.02 - 0.1j * speed, 1.0]).imag))
        assert row[:2] == pytest.approx(exact, rel=1e-6)
    assert len(found.critical()) == 2


@pytest.mark.parametrize(
    ("order", "expected"), [(1.0, [0.5, 1.4, 2.5]), (0.5, [1.0, 3.0]), (2.0, [0.25]), (9.0, [1 / 18])]
)
def test_critical_speeds_between_those_given(order: float, expected: list[float]) -> None:
    """Assert where lines between the speeds of the diagram are met, and once where two modes meet there."""
    speeds = np.array([0.0, 1.0, 2.0, 3.0])
    rows = [[0.5, 0.5, np.nan], [0.5, 0.5, np.nan], [1.75, 2.75, np.nan], [1.5, 2.25, np.nan]]
    diagram = Campbell(speeds, np.array(rows), np.zeros((4, 3)))
    assert diagram.critical(order) == pytest.approx(expected, rel=1e-12)


def test_critical_speed_that_is_given() -> None:
    """Assert it where it is one of the speeds, and both of an interval in which all are critical."""
    speeds = np.array([1.0, 2.0, 3.0])
    for row, expected in (([3.0, 2.0, 1.0], [2.0]), ([1.0, 2.0, 7.0], [1.0, 2.0]), ([9.0, 9.0, 9.0], [])):
        diagram = Campbell(speeds, np.array(row)[:, None], np.zeros((3, 1)))
        assert diagram.critical().tolist() == expected


@pytest.mark.parametrize("speeds", [[1.0, 1.0], [1.0, 0.5], [0.0, 2.0, 1.5]])
def test_speeds_that_do_not_ascend(speeds: list[float]) -> None:
    """Assert the sentence, of equal ones too."""
    matrices = sym.Matrices(np.eye(1), None, np.eye(1))
    with pytest.raises(ValueError, match="^speeds is .*; it must be ascending$"):
        sym.campbell(matrices, speeds)


@pytest.mark.parametrize(
    ("count", "said"), [(0, "count is 0"), (1.5, "count is 1.5"), (True, "count is True")]
)
def test_counts_that_are_none(count: Any, said: str) -> None:
    """Assert the sentence."""
    with pytest.raises(ValueError, match=f"^{said}; it must be a whole number of at least 1$"):
        sym.campbell(sym.Matrices(np.eye(1), None, np.eye(1)), [1.0], count)


def test_large_structures_are_refused() -> None:
    """Assert the sentence from 501 degrees of freedom on."""
    many = np.eye(501)
    with pytest.raises(
        ValueError, match="^the structure has 501 freedoms; a Campbell diagram takes at most 500: "
    ):
        sym.campbell(sym.Matrices(many, None, many), [1.0])
