"""Special points by their test functions: places that are known exactly, and what must not be reported."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from reference.integration import path
from reference.shooting import Field, motion
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b
from support.kept import kept
from support.mathieu import Mathieu
from support.numpy_systems import Array, LinearOscillator
from support.traces import DUFFING_A, FINE, disc_system, duffing, duffing_system

import periodic as per

STEPS = (0.25, 1.0, 4.0)
"""Step sizes, in units of the default."""

DEPTH = 0.3
"""Modulation of the stiffness, as 2 DEPTH."""


def labels(branch: per.Branch) -> list[tuple[str, float]]:
    """Labels and parameters of the special points between the ends."""
    return [(p.label.value, p.parameter) for p in branch.special_points if p.label is not per.Label.END]


def steps(factor: float) -> per.ArclengthControl:
    """Steps so many times the default ones."""
    step = per.ArclengthControl()
    return per.ArclengthControl(ds=factor * step.ds, ds_max=min(1.0, factor * step.ds_max))


@pytest.mark.parametrize("factor", STEPS)
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_boundaries_of_mathieu(order: int, factor: float) -> None:
    """Assert both boundaries of a resonance tongue: PD where its order is odd, BP where it is even."""
    low, high = tongue(order)
    width = high - low
    found = per.trace(
        Mathieu(DEPTH), "Omega", (low - 0.4 * width, high + 0.5 * width), tol=FINE, control=steps(factor)
    )
    assert [label for label, _ in labels(found)] == ["PD" if order % 2 else "BP"] * 2
    assert [Omega for _, Omega in labels(found)] == pytest.approx([low, high], rel=1e-9)


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
    branch = per.trace(LinearOscillator(Omega=0.8), "zeta", (-0.1, 0.1), start=0.1, tol=1e-8)
    ((label, zeta),) = labels(branch)
    assert label == "NS"
    assert zeta == pytest.approx(0.0, abs=1e-9)
    (point,) = branch.labelled(per.Label.TORUS)
    assert np.abs(point.multipliers) == pytest.approx([1, 1], abs=1e-9)
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


@kept
def symmetric() -> per.Branch:
    """Its symmetric orbits."""
    return per.trace(PENDULUM, "F", (0.3, 1.2))


def test_symmetry_breaking() -> None:
    """Assert that a symmetric orbit loses its symmetry at a BP."""
    point = symmetric().labelled(per.Label.BRANCH)[0]
    assert point.multipliers[0] == pytest.approx(1.0, abs=1e-9)
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
    assert end == pytest.approx(start, abs=1e-8)


def pendulum_after_a_period(start: Array, force: float) -> Array:
    """States x and dx/dtau after 2 pi, by DOP853."""

    def rhs(tau: float, y: Array) -> list[float]:
        acceleration = force * math.cos(tau) - math.sin(y[0]) - 2 * 0.125 * 0.6 * y[1]
        return [y[1], acceleration / 0.6**2]

    return path(rhs, start)[:, -1]


class Parametric(LinearOscillator):
    """Omega^2 x'' + 2 zeta Omega x' + (1 + depth cos tau) x = 0: a damped tongue about Omega = 2."""

    def __init__(self, depth: float, zeta: float) -> None:
        super().__init__(Omega=2.0, zeta=zeta, F=0.0)
        self.depth = depth

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """r, dr/dx, dr/dtau."""
        stiffness = 1 + self.depth * np.cos(phase)
        return stiffness * x, stiffness, -self.depth * np.sin(phase) * x

    def doubling(self, Omega: float) -> float:
        """det(M + I), the monodromy matrix M by DOP853."""

        def matrix(tau: float, y: Array, side: float) -> Array:
            stiffness, damping = 1 + self.depth * math.cos(tau), 2 * self.parameters[1].value
            return np.array([[0.0, 1.0], [-stiffness / Omega**2, -damping / Omega]])

        field = Field(rates=lambda t, y, side: matrix(t, y, side) @ y, jacobian=matrix)
        return float(np.linalg.det(motion(field, np.zeros(2)).monodromy + np.eye(2)))


@pytest.mark.parametrize("upper", [3.0, 6.0])
@pytest.mark.parametrize("zeta, depth", [(0.005, 0.03), (0.02, 0.09), (0.05, 0.22), (0.1, 0.42), (0.15, 0.7)])
def test_doubling_and_back_within_a_step(zeta: float, depth: float, upper: float) -> None:
    """Assert that a narrow unstable tongue is not stepped over, whatever the damping."""
    system = Parametric(depth, zeta)
    found = per.trace(system, "Omega", (0.9, upper), start=upper).labelled(per.Label.DOUBLING)
    ends = [brentq(system.doubling, 2.0, far, xtol=1e-13) for far in (2.3, 1.7)]
    assert [p.parameter for p in found] == pytest.approx(ends, rel=1e-8)


class BiasedUeda(LinearOscillator):
    """x'' + 0.05 x' + x^3 - 1 = F cos tau (Omega = 1)."""

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """r, dr/dx, dr/dtau."""
        return x**3 - 1, 3 * x**2, np.zeros_like(x)


UEDA = (0.848421, 0.972998, 1.039922, 1.622543, 3.219008, 3.711320, 4.485519)
"""Period doublings between F = 0.2 and 5, by steps of 0.003 of the range."""


@pytest.mark.parametrize("factor", STEPS)
@pytest.mark.parametrize("lowest", [0.2, 0.4])
def test_ueda(lowest: float, factor: float) -> None:
    """Assert that none of Ueda's doublings is missed or found twice, from either start and any step."""
    branch = per.trace(BiasedUeda(Omega=1.0, zeta=0.025), "F", (lowest, 5.0), tol=FINE, control=steps(factor))
    found = [p.parameter for p in branch.labelled(per.Label.DOUBLING)]
    assert found == pytest.approx(list(UEDA), abs=1e-6)


@pytest.mark.parametrize("which", [0, 1])
def test_start_at_a_fold(which: int) -> None:
    """Assert that a branch started at one of its folds goes on both ways to its ends."""
    whole = duffing(accuracy=FINE)
    fold = whole.labelled(per.Label.FOLD)[which]
    branch = per.trace(duffing_system(*DUFFING_A), "Omega", (0.3, 3.0), guess=fold.orbit, tol=FINE)
    assert {branch[0].parameter, branch[-1].parameter} == {0.3, 3.0}
    assert branch.labelled(per.Label.BRANCH) == ()
    other = [p.parameter for p in branch.labelled(per.Label.FOLD)]
    assert min(abs(p - whole.labelled(per.Label.FOLD)[1 - which].parameter) for p in other) < 1e-11


def test_guess_over_too_many_periods() -> None:
    """Assert that a motion sampled over two periods which takes one is refused, not traced as doubled."""
    tau = np.linspace(0, 4 * np.pi, 401)
    system = LinearOscillator()
    guess = per.sampled(tau, system.exact_state(tau), np.zeros((401, 0)), system.nominal)
    with pytest.raises(ValueError, match="^guess takes 2 excitation periods, but its orbit repeats itself"):
        per.trace(system, "Omega", (0.5, 0.9), guess=guess)


def test_guess_brings_its_parameters() -> None:
    """Assert that a branch goes on at the parameters of the orbit that it is started from."""
    first = per.trace(LinearOscillator(), "Omega", (0.5, 0.9), values={"zeta": 0.2})
    point = first[3]
    second = per.trace(LinearOscillator(), "F", (0.5, 2.0), guess=point.orbit)
    (start,) = [p for p in second if p.parameter == 1.0]
    assert start.peak_to_peak("x") == pytest.approx(point.peak_to_peak("x"), rel=1e-10)
    with pytest.raises(ValueError, match="^guess has 2 parameters; it must have the 3 of the system$"):
        wrong = replace(point.orbit, parameter=np.ones(2))
        per.trace(LinearOscillator(), "F", (0.5, 2.0), guess=wrong)


@pytest.mark.parametrize(
    "change, sentence",
    [
        ({"nodes": np.zeros((9, 3))}, "guess has 3 states; it must have the 2 of the system"),
        (
            {"algebraic": np.zeros((8, 4, 1))},
            "guess has 1 algebraic unknowns; it must have the 0 of",
        ),
        (
            {"nodes": np.full((9, 2), np.nan)},
            "guess has values that are not finite; all of its numbers",
        ),
    ],
)
def test_refused_guess(change: dict[str, Array], sentence: str) -> None:
    """Assert that a guess of another system is refused in one sentence."""
    orbit = per.trace(LinearOscillator(), "Omega", (0.5, 0.6))[0].orbit
    with pytest.raises(ValueError, match=f"^{sentence}"):
        per.trace(LinearOscillator(), "Omega", (0.5, 0.6), guess=replace(orbit, **change))
