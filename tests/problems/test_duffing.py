"""Two Duffing oscillators whose folds are known to ten digits and more."""

from __future__ import annotations

import numpy as np
import pytest
from reference.integration import path
from support.traces import (
    DUFFING_A,
    DUFFING_NLVIB,
    FINE,
    STANDARD,
    duffing,
    duffing_system,
    largest_multiplier,
    user_points,
)

import periodic as per

FOLDS = {DUFFING_A: (2.211935317020, 1.438670145514), DUFFING_NLVIB: (1.26960195555, 1.11570025177)}
"""Frequencies of the folds, the upper one first (DOP853 shooting)."""

HEIGHTS = (2.315979798728, 0.699671897403)
"""Largest |x| at the folds of problem A."""

BETWEEN = 1.8
"""A frequency between the folds of problem A."""

each_problem = pytest.mark.parametrize("problem", FOLDS, ids=["A", "NLvib"])
Problem = tuple[float, float, float]


def folds(branch: per.Branch) -> list[float]:
    """Parameter values of a branch's folds."""
    return [point.parameter for point in branch.labelled(per.Label.FOLD)]


@each_problem
@pytest.mark.parametrize("accuracy, precision", [(FINE, 1e-9), (STANDARD, 1e-8), (per.Accuracy.DRAFT, 1e-4)])
def test_folds(problem: Problem, accuracy: per.Accuracy, precision: float) -> None:
    """Assert that the branch has its two folds and no other, where they are known to be."""
    assert folds(duffing(problem, accuracy)) == pytest.approx(FOLDS[problem], rel=precision)


@pytest.mark.parametrize("accuracy, precision", [(FINE, 1e-7), (STANDARD, 1e-6)])
def test_heights_at_the_folds(accuracy: per.Accuracy, precision: float) -> None:
    """Assert the largest |x| at the folds of problem A."""
    found = [
        max(point.maximum["x"], -point.minimum["x"])
        for point in duffing(DUFFING_A, accuracy).labelled(per.Label.FOLD)
    ]
    assert found == pytest.approx(HEIGHTS, rel=precision)


@each_problem
@pytest.mark.parametrize("accuracy, precision", [(FINE, 1e-9), (STANDARD, 1e-8)])
def test_folds_do_not_depend_on_direction(problem: Problem, accuracy: per.Accuracy, precision: float) -> None:
    """Assert that the branch traced downwards has the same folds in the opposite order."""
    down = folds(duffing(problem, accuracy, (3.0, 0.3)))
    assert down[::-1] == pytest.approx(folds(duffing(problem, accuracy)), rel=precision)


@each_problem
def test_multiplier_at_the_folds(problem: Problem) -> None:
    """Assert that one multiplier is 1 at the folds and the largest between them exceeds 1."""
    branch = duffing(problem, FINE)
    upper, lower = (branch.points.index(point) for point in branch.labelled(per.Label.FOLD))
    for index in (upper, lower):
        assert largest_multiplier(branch[index]) == pytest.approx(1.0, abs=1e-8)
    middle = branch.points[upper + 1 : lower]
    assert middle and not any(point.stable for point in middle)
    assert all(largest_multiplier(point) > 1 for point in middle)


@each_problem
@pytest.mark.parametrize("accuracy, precision", [(FINE, 5e-8), (STANDARD, 1e-6)])
def test_liouville(problem: Problem, accuracy: per.Accuracy, precision: float) -> None:
    """Assert that the multipliers of every orbit have the product exp(-damping T)."""
    for point in duffing(problem, accuracy):
        exact = np.exp(-problem[0] * 2 * np.pi / point.parameter)
        assert np.prod(point.multipliers) == pytest.approx(exact, rel=precision)


def test_every_sheet_has_its_user_point() -> None:
    """Assert that a frequency between the folds is hit exactly on all three sheets, the middle unstable."""
    points = user_points(duffing(DUFFING_A, STANDARD, (0.3, 3.0), (BETWEEN,)), BETWEEN)
    assert [point.stable for point in points] == [True, False, True]
    heights = [point.peak_to_peak("x") for point in points]
    assert heights[0] > heights[1] > heights[2]


def test_symmetry() -> None:
    """Assert that orbits have the half-wave symmetry of the equation: x(tau + pi) = -x(tau)."""
    point = user_points(duffing(DUFFING_A, FINE, (0.3, 3.0), (BETWEEN,)), BETWEEN)[0]
    tau = np.linspace(0.0, np.pi, 200)
    assert np.abs(point.orbit.state(tau + np.pi) + point.orbit.state(tau)).max() < 1e-12


def test_energy_balance() -> None:
    """Assert that over a period the force does the work that the damper takes, on every sheet."""
    damping, _, force = DUFFING_A
    tau = np.linspace(0.0, 2 * np.pi, 4096, endpoint=False)
    for point in user_points(duffing(DUFFING_A, FINE, (0.3, 3.0), (BETWEEN,)), BETWEEN):
        velocity = BETWEEN * point.orbit.rate(tau)[:, 0]
        assert (force * np.cos(tau) * velocity).mean() == pytest.approx(
            damping * (velocity**2).mean(), rel=1e-7
        )


def test_stability_by_time_integration() -> None:
    """Assert that time integration stays on the stable orbits and leaves the unstable one."""
    damping, cubic, force = DUFFING_A

    def rhs(t: float, y: np.ndarray) -> list[float]:
        return [y[1], force * np.cos(BETWEEN * t) - damping * y[1] - y[0] - cubic * y[0] ** 3]

    for point in user_points(duffing(DUFFING_A, FINE, (0.3, 3.0), (BETWEEN,)), BETWEEN):
        x, v = point.orbit.state(np.zeros(1))[0]
        start = np.array([x, v * BETWEEN]) * (1 + 1e-6)
        end = path(rhs, start, 60 * np.pi / BETWEEN)[:, -1]
        grown = np.abs(end - start).max()
        assert (grown < 1e-5) == point.stable


def test_system_is_shared() -> None:
    """Assert that a trace leaves the nominal parameters of its system as they were."""
    system = duffing_system(*DUFFING_A)
    before = system.nominal.copy()
    per.trace(system, "Omega", (0.3, 0.32))
    assert (system.nominal == before).all()
