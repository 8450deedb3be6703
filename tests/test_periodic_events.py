"""Special points by their test functions: places that are known exactly, and what must not be reported."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from numpy_systems import Array, LinearOscillator
from scipy.integrate import solve_ivp
from scipy.special import mathieu_a, mathieu_b
from test_periodic_doubling import Mathieu
from traces import FINE, disc_system, duffing

import periodic as per

STEPS = (0.25, 1.0, 4.0)
"""Step sizes, in units of the default."""

DEPTH = 0.3
"""Modulation of the stiffness, as 2 DEPTH."""


def labels(branch: per.Branch) -> list[tuple[str, float]]:
    """Labels and parameters of the special points between the ends."""
    return [(p.label.value, p.parameter) for p in branch.special_points if p.label is not per.Label.END]


def steps(factor: float) -> per.Settings:
    """Settings with steps so many times the default ones."""
    step = per.StepSettings()
    return FINE.settings(per.StepSettings(ds=factor * step.ds, ds_max=min(1.0, factor * step.ds_max)))


@pytest.mark.parametrize("factor", STEPS)
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_boundaries_of_mathieu(order: int, factor: float) -> None:
    """Assert both boundaries of a resonance tongue: PD where its order is odd, BP where it is even."""
    low, high = tongue(order)
    width = high - low
    found = per.trace(
        Mathieu(DEPTH), "Omega", (low - 0.4 * width, high + 0.5 * width), settings=steps(factor)
    )
    assert [label for label, _ in labels(found)] == ["PD" if order % 2 else "BP"] * 2
    assert [Omega for _, Omega in labels(found)] == pytest.approx([low, high], rel=1e-8)


def tongue(order: int) -> tuple[float, float]:
    """Omega where q = DEPTH a meets the boundaries a(q) and b(q) of a tongue, by fixed point iteration."""
    found = []
    for boundary in (mathieu_a, mathieu_b):
        a = float(order**2)
        for _ in range(400):
            a = float(boundary(order, DEPTH * a))
        found.append(2 / math.sqrt(a))
    return min(found), max(found)


def test_torus_of_an_oscillator_that_loses_its_damping() -> None:
    """Assert that NS is found where the damping of a linear oscillator vanishes, and only there."""
    branch = per.trace(LinearOscillator(Omega=0.8), "zeta", (-0.1, 0.1), start=0.1)
    ((label, zeta),) = labels(branch)
    assert label == "NS"
    assert zeta == pytest.approx(0.0, abs=1e-9)
    (point,) = branch.labelled(per.Label.TORUS)
    assert np.abs(point.multipliers) == pytest.approx([1, 1], abs=1e-8)
    assert not point.stable


def test_conserved_products_are_no_torus() -> None:
    """Assert that an undamped branch, where every product of multipliers is 1, has no NS."""
    branch = per.trace(LinearOscillator(zeta=0.0), "Omega", (0.4, 0.7))
    assert labels(branch) == []


@pytest.mark.parametrize("which", ["duffing", "disc"])
def test_folds_are_no_branch_points(which: str) -> None:
    """Assert that the folds of a response are LP and nothing else is reported."""
    branch = duffing() if which == "duffing" else _disc()
    assert [label for label, _ in labels(branch)] == ["LP", "LP"]


def _disc() -> per.Branch:
    rpm = 2 * math.pi / 60
    return per.trace(disc_system("vitrea79-810N"), "speed", (230 * rpm, 300 * rpm), start=300 * rpm)


class Pendulum(LinearOscillator):
    """Omega^2 x'' + 2 zeta Omega x' + sin x = F cos tau: symmetric under x(tau) -> -x(tau + pi)."""

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """r, dr/dx, dr/dtau."""
        return np.sin(x), np.cos(x), np.zeros_like(x)


PENDULUM = Pendulum(Omega=0.6, zeta=0.125, F=0.3)


@cache
def symmetric() -> per.Branch:
    """Its symmetric orbits."""
    return per.trace(PENDULUM, "F", (0.3, 1.2))


def test_symmetry_breaking() -> None:
    """Assert that a symmetric orbit loses its symmetry at a BP."""
    point = symmetric().labelled(per.Label.BRANCH)[0]
    assert point.multipliers[0] == pytest.approx(1.0, abs=1e-7)
    assert -point.minimum["x"] == pytest.approx(point.maximum["x"], rel=1e-7)
    place = symmetric().points.index(point)
    assert symmetric().stable[place - 2 : place].all() and not symmetric().stable[place : place + 2].any()


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_lopsided_branch(side: float) -> None:
    """Assert that the lopsided orbits are reached from the BP, on either side, and are what is simulated."""
    point = symmetric().labelled(per.Label.BRANCH)[0]
    guess = per.branched(PENDULUM, point.orbit, "F", distance=0.05 * side)
    begin = float(guess.parameter[2])
    branch = per.trace(PENDULUM, "F", (begin, begin + 0.01), start=begin, guess=guess, at=(begin + 0.005,))
    (found,) = branch.labelled(per.Label.USER)
    assert abs(found.maximum["x"] + found.minimum["x"]) > 0.1
    assert found.stable
    start = found.orbit.state(np.zeros(1))[0]
    end = pendulum_after_a_period(start, found.parameter)
    assert end == pytest.approx(start, abs=2e-7)


def pendulum_after_a_period(start: Array, force: float) -> Array:
    """States x and dx/dtau after 2 pi, by DOP853."""

    def rhs(tau: float, y: Array) -> list[float]:
        acceleration = force * math.cos(tau) - math.sin(y[0]) - 2 * 0.125 * 0.6 * y[1]
        return [y[1], acceleration / 0.6**2]

    return np.asarray(
        solve_ivp(rhs, (0, 2 * math.pi), start, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    )
