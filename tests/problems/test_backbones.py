"""Backbones: families of free vibrations of conservative systems, traced in the frequency."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from reference.integration import path
from reference.shooting import Field, motion
from scipy.integrate import quad
from scipy.optimize import fsolve, minimize_scalar
from scipy.special import ellipk
from support.equations import oscillator, two_masses
from support.kept import kept

import periodic as per
import symbolic as sym

FREE = {"c": per.Conservative()}


def backbone(system: sym.CompiledSystem, end: float, which: int = 0, tol: float = 1e-8) -> per.Branch:
    """The family of a mode, from small amplitude to an angular frequency."""
    guess = per.normal_mode(
        system, per.trace(system, "c", (0, 1), method=per.Equilibrium())[0].orbit, "c", which=which
    )
    begin = float(guess.parameter[[p.name for p in system.parameters].index("omega")])
    return per.trace(system, "omega", (begin, end), guess=guess, determined=FREE, tol=tol)


def labels(branch: per.Branch) -> list[str]:
    """Labels of the special points between the ends."""
    return [p.label.value for p in branch.special_points if p.label is not per.Label.END]


def duffing_period(amplitude: float, linear: float, cubic: float) -> float:
    """T of x'' + linear x + cubic x^3 = 0: 4 K(m)/sqrt(linear + cubic A^2)."""
    square = linear + cubic * amplitude**2
    return float(4 * ellipk(cubic * amplitude**2 / (2 * square)) / np.sqrt(square))


@pytest.mark.parametrize("linear, cubic, end", [(1.0, 1.0, 3.0), (1.0, -1.0, 0.4)])
@pytest.mark.parametrize("tol, digits", [(1e-8, 1e-9), (1e-10, 1e-12)])
def test_backbone_of_duffing(linear: float, cubic: float, end: float, tol: float, digits: float) -> None:
    """Assert period, energy and dummy damping of the hardening and the softening oscillator, all stable.

    Its two multipliers of 1 are its only ones; they are not taken for a branch point or an instability.
    """
    branch = backbone(oscillator(linear, cubic), end, tol=tol)
    assert branch.stop.reason is per.Reason.BOUND and labels(branch) == []
    assert branch[0].maximum["x"] == pytest.approx(0.02, rel=1e-2)
    assert branch.stable.all()
    for point in branch:
        size = point.maximum["x"]
        assert 2 * np.pi / point.parameter == pytest.approx(duffing_period(size, linear, cubic), rel=digits)
        energy = linear * size**2 / 2 + cubic * size**4 / 4
        assert [point.minimum["energy"], point.maximum["energy"]] == pytest.approx([energy] * 2, rel=1e-6)
        assert abs(point.orbit.parameter[0]) < 1e-11
        assert point.conservative and point.trivial is not None and point.trivial < 1e-8
        assert len(point.nontrivial) == 0


def test_backbone_that_turns() -> None:
    """Assert that x'' + x - x^3 + 0.5 x^5 = 0, softening first, has an LP where T is longest."""
    system = oscillator(1.0, -1.0, 0.5)
    guess = per.normal_mode(system, per.trace(system, "c", (0, 1), method=per.Equilibrium())[0].orbit, "c")
    branch = per.trace(system, "omega", (0.5, 1.1), guess=guess, determined=FREE)
    assert labels(branch) == ["LP", "HB"]
    assert branch.stop.reason is per.Reason.EQUILIBRIUM
    assert branch[-1].parameter == pytest.approx(1, abs=1e-8)

    def frequency(size: float) -> float:
        def slowness(s: float) -> float:  # x = A sin s
            x = size * np.sin(s)
            sums = 1 - (size**2 + x**2) / 2 + (size**4 + size**2 * x**2 + x**4) / 6
            return float(1 / np.sqrt(sums))

        return np.pi / 2 / quad(slowness, 0, np.pi / 2, epsabs=1e-13, epsrel=1e-13)[0]

    least = minimize_scalar(frequency, bounds=(0.3, 1.4), method="bounded", options={"xatol": 1e-9})
    (fold,) = branch.labelled(per.Label.FOLD)
    assert fold.parameter == pytest.approx(least.fun, rel=1e-9)
    assert fold.maximum["x"] == pytest.approx(least.x, rel=1e-5)
    assert branch[0].parameter == 1.1


def test_linear_backbone_is_vertical() -> None:
    """Assert that the orbits of a linear oscillator, all of one frequency, are traced as they grow."""
    system = oscillator(4.0, 0.0)
    guess = per.normal_mode(system, per.trace(system, "c", (0, 1), method=per.Equilibrium())[0].orbit, "c")
    few = per.ArclengthControl(max_points=12)
    branch = per.trace(system, "omega", (1.0, 3.0), guess=guess, determined=FREE, control=few)
    assert len(branch) > 10
    assert branch.values == pytest.approx(np.full(len(branch), 2.0), rel=1e-9)
    assert np.ptp([p.maximum["x"] for p in branch]) > 0.5


def test_model_of_parts() -> None:
    """Assert the backbone of a mass on springs in SI units, the dummy being its damper, with its energy."""
    q = sym.coordinate("x", scale=1e-3)
    m, k, k3 = 2.0, 5e4, 2e10
    energy = sym.Equations(
        lambda x, p: {},
        states={},
        coordinates=[q],
        outputs=lambda x, p: {"energy": m * x.x_dot**2 / 2 + k * x.x**2 / 2 + k3 * x.x**4 / 4},
    )
    parts = sym.Mass(q, m) + sym.Spring(q, k) + sym.CubicSpring(q, k3) + sym.Damper(q, 0.0)
    branch = backbone(sym.compile(parts + energy), 400.0)
    assert branch.stop.reason is per.Reason.BOUND and labels(branch) == [] and branch.stable.all()
    for point in branch:
        size = point.maximum["x"]
        assert 2 * np.pi / point.parameter == pytest.approx(duffing_period(size, k / m, k3 / m), rel=1e-9)
        expected = k * size**2 / 2 + k3 * size**4 / 4
        assert point.maximum["energy"] == pytest.approx(expected, rel=1e-6)


MODES = {0: (1.0, 1.25), 1: (np.sqrt(3), 3.0)}
"""Linear frequency and end of the trace of the two modes of Kerschen's system."""


@kept
def normal_mode(which: int, tol: float = 1e-8, everywhere: bool = True) -> per.Branch:
    """A nonlinear normal mode of Kerschen's two masses."""
    return backbone(two_masses(everywhere), MODES[which][1], which, tol)


def rates_of_two_masses(t: float, y: np.ndarray, side: float = 1.0) -> list[float]:
    """Rates of (x1, x2, v1, v2) of Kerschen's two masses."""
    return [y[2], y[3], -2 * y[0] + y[1] - 0.5 * y[0] ** 3, -2 * y[1] + y[0]]


MASSES = Field(
    rates=rates_of_two_masses,
    jacobian=lambda t, y, side: [[0, 0, 1, 0], [0, 0, 0, 1], [-2 - 1.5 * y[0] ** 2, 1, 0, 0], [1, -2, 0, 0]],
)


def shot(omega: float, near: list[float]) -> np.ndarray:
    """Displacements at rest from which the two masses come to rest again half a period later (DOP853)."""

    def half(start: np.ndarray) -> np.ndarray:
        return path(rates_of_two_masses, [*start, 0, 0], np.pi / omega)[2:, -1]

    return fsolve(half, near, xtol=1e-11)


@pytest.mark.parametrize("which", [0, 1])
def test_nonlinear_normal_modes(which: int) -> None:
    """Assert start, shape and labels of both modes against shooting, and that the energy is kept."""
    branch = normal_mode(which)
    assert branch.stop.reason is per.Reason.BOUND and labels(branch) == [] and branch.stable.all()
    assert branch[0].parameter == pytest.approx(MODES[which][0], rel=1e-4)
    for point in branch[5 :: len(branch) // 3]:
        state = point.orbit.state(np.linspace(0, 2 * np.pi, 4001))
        start = state[np.abs(state[:, 2:]).sum(axis=1).argmin(), :2]
        found = np.abs(shot(point.parameter, list(start)))
        assert [point.maximum["x1"], point.maximum["x2"]] == pytest.approx(found, rel=1e-8)
        assert point.peak_to_peak("energy") < 1e-6 * point.maximum["energy"]
        assert point.trivial is not None and point.trivial < 1e-7
        assert len(point.nontrivial) == 2
        assert np.abs(point.nontrivial) == pytest.approx([1, 1], abs=1e-7)


def test_orbits_do_not_depend_on_the_dummy() -> None:
    """Assert that a damper on one mass alone gives the same orbits as one on each, and that both stay 0."""
    ends = [normal_mode(1, 1e-9, everywhere)[-1] for everywhere in (True, False)]
    assert ends[0].parameter == ends[1].parameter == 3.0
    for output in ("x1", "x2", "energy"):
        assert ends[0].maximum[output] == pytest.approx(ends[1].maximum[output], rel=1e-9)
    assert all(abs(point.orbit.parameter[0]) < 1e-12 for point in ends)


def test_branch_point_of_a_normal_mode() -> None:
    """Assert that the in-phase mode loses its symmetry where all four multipliers are 1, as integrated."""
    branch = backbone(two_masses(), 1.3)
    assert labels(branch) == ["BP"]
    (point,) = branch.labelled(per.Label.BRANCH)
    assert not branch[-1].stable and branch[0].stable

    found = motion(MASSES, point.orbit.state(np.zeros(1))[0], 2 * np.pi / point.parameter)
    assert found.end == pytest.approx(found.start, abs=1e-6)
    assert np.trace(found.monodromy) == pytest.approx(4, abs=1e-5)


def test_kept_on_disk(tmp_path: Path) -> None:
    """Assert that a saved backbone is as stable as before."""
    branch = normal_mode(1)
    branch.save(tmp_path / "branch.nc")
    again = per.Branch.load(tmp_path / "branch.nc")
    assert again.stable.all() and all(p.conservative for p in again)
    assert [len(p.nontrivial) for p in again] == [2] * len(branch)


def test_modes_that_there_are_not() -> None:
    """Assert that a mode beyond the last and a damped one are refused."""
    system = two_masses()
    still = per.trace(system, "c", (0, 1), method=per.Equilibrium())
    with pytest.raises(ValueError, match="which is 2; the equilibrium has 2 undamped modes"):
        per.normal_mode(system, still[0].orbit, "c", which=2)
    with pytest.raises(ValueError, match="which is 0; the equilibrium has 0 undamped modes"):
        per.normal_mode(system, still[-1].orbit, "c")
