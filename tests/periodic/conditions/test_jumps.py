"""Conditions on orbits with impacts and with stick and slip: gradients, curves in two parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from reference.bouncing import DAMPING, RESTITUTION, bouncing, settled_at, shot
from scipy.linalg import expm

import periodic as per
import symbolic as sym


def fold_force(w: float) -> float:
    """A of the fold of orbits of one impact at a frequency; see tests/problems/nonsmooth/test_impacts.py."""
    over = expm(2 * np.pi / w * np.array([[0.0, 1.0], [-1.0, -DAMPING]]))
    g = np.linalg.solve(over - np.eye(2), [0.0, -(1 + 1 / RESTITUTION)])
    v = g[0] / (g[0] ** 2 + ((1 - g[1]) / w) ** 2)
    stiffness = abs(1 - w**2 + 1j * DAMPING * w)
    return float(stiffness * np.hypot(1 - v * g[0], v * (1 - g[1]) / w))


def with_one_impact() -> tuple[sym.CompiledSystem, per.Orbit]:
    """The oscillator at A = w = 1."""
    system = bouncing()
    return system, per.trace(system, "A", (0.9, 1.0), start=1.0, guess=settled_at(system))[-1].orbit


def with_stops() -> tuple[sym.CompiledSystem, per.Orbit]:
    """An oscillator with dry friction that sticks twice in a period."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.HarmonicForce(x, 0.5, 0.5)]
    system = sym.compile(sym.combine([*parts, sym.CoulombFriction(x, 0.2)]))
    orbit = per.trace(system, "Omega", (0.49, 0.5), start=0.5)[-1].orbit
    assert len(orbit.phases) == 4
    return system, orbit


@pytest.mark.parametrize("given", [with_one_impact, with_stops])
@pytest.mark.parametrize("condition", [per.FoldCondition(), per.DoublingCondition(), per.TorusCondition()])
def test_gradients(
    given: Callable[[], tuple[sym.CompiledSystem, per.Orbit]], condition: per.extend.Condition
) -> None:
    """Assert gradients of conditions on the multipliers against differences, to 5 digits."""
    system, orbit = given()
    free, size = (0, 1), len(orbit.phases)
    side = condition.at(orbit, per.Given(0))
    row = side.linearise(system, orbit, free)
    assert row.stages is not None
    random = np.random.default_rng(3)
    nodes, stages = random.standard_normal(orbit.nodes.shape), random.standard_normal(orbit.stages.shape)
    nodes[-1], outer = nodes[0], random.standard_normal(size + 2)

    def value(step: float) -> float:
        parameter = orbit.parameter.copy()
        parameter[list(free)] += step * outer[size:]
        moved = replace(
            orbit,
            nodes=orbit.nodes + step * nodes,
            stages=orbit.stages + step * stages,
            phases=orbit.phases + step * outer[:size],
            parameter=parameter,
        )
        return side.linearise(system, moved, free).value

    found = (row.nodes * nodes).sum() + (row.stages * stages).sum() + row.outer @ outer
    step = 1e-6
    assert found == pytest.approx((value(step) - value(-step)) / (2 * step), rel=1e-5)


def test_curve_of_folds() -> None:
    """Assert the curve of folds of orbits with an impact over the frequency, in closed form, to 10 digits.

    Downwards it ends where the impact has no speed left.
    """
    system = bouncing()
    branch = per.trace(system, "A", (0.05, 1.0), start=1.0, guess=settled_at(system), tol=1e-8)
    fold, held = branch.labelled("LP")[0], {"A": per.FoldCondition()}
    for end in (1.8, 0.9):
        curve = per.trace(system, "w", (1.0, end), guess=fold.orbit, determined=held, tol=1e-8)
        assert curve.column("A") == pytest.approx([fold_force(w) for w in curve.values], rel=1e-10)
        if end > 1:
            assert curve[-1].parameter == end
    assert "the impact at wall has no speed left" in str(curve.stop)
    assert curve[-1].parameter == pytest.approx(0.9988, abs=1e-4)


def test_curve_of_grazing() -> None:
    """Assert the grazing curve A = d |k - w^2 + i c w| from the GR of a branch with impacts, to 8 digits."""
    system = bouncing()
    branch = per.trace(system, "A", (0.05, 1.0), start=1.0, guess=settled_at(system), tol=1e-8)
    (graze,) = branch.labelled("GR")
    assert graze.parameter == pytest.approx(DAMPING, rel=1e-10)
    held = {"A": per.GrazingCondition("wall")}
    curve = per.trace(system, "w", (0.3, 2.0), guess=graze.orbit, determined=held, tol=1e-8)
    assert {curve[0].parameter, curve[-1].parameter} == {0.3, 2.0}
    w = curve.values
    assert curve.column("A") == pytest.approx(np.abs(1 - w**2 + 1j * DAMPING * w), rel=1e-8)


def test_curve_of_doublings() -> None:
    """Assert a multiplier -1 by independent shooting along a curve of PD with two impacts a period."""
    system = bouncing()
    upward = per.trace(system, "w", (0.63, 0.66), tol=1e-8)
    double = upward.labelled("PD")[0]
    held = {"w": per.DoublingCondition()}
    curve = per.trace(system, "A", (0.97, 1.03), guess=double.orbit, determined=held, tol=1e-8)
    assert {curve[0].parameter, curve[-1].parameter} == {0.97, 1.03}
    for point in (curve[0], curve[-1]):
        assert np.abs(shot(point).multipliers + 1).min() < 1e-7
    kinked = f"with kinks, {len(curve)} of {len(curve)} points"
    assert curve.remarks == (f"generalised period doublings (GPD) are not looked for on orbits {kinked}",)


def test_curve_of_peaks() -> None:
    """Assert that a curve of resonance peaks meets the peak of a branch over the frequency."""
    system, aim = bouncing(), per.Amplitude("v")
    begin = per.trace(system, "w", (1.0, 1.74), start=1.0, guess=settled_at(system), at=(1.73,))
    guess = next(p for p in begin if p.parameter == 1.73).orbit
    curve = per.trace(system, "A", (1.0, 1.1), start=1.0, guess=guess, determined={"w": per.Peak(aim)})
    assert curve[-1].parameter == 1.1
    w = curve[0].orbit.parameters["w"]
    beside = (w - 2e-4, w, w + 2e-4)
    held = {"start": w, "guess": curve[0].orbit, "at": beside, "tol": 1e-9}
    around = per.trace(system, "w", (w - 2e-3, w + 2e-3), **held)
    low, top, high = (next(aim(system, p.orbit) for p in around if p.parameter == at) for at in beside)
    assert top > max(low, high) and abs(high - low) < 0.02 * (2 * top - low - high)


def test_level() -> None:
    """Assert that a curve of orbits of a given least displacement keeps it."""
    system, orbit = with_one_impact()
    aim = per.Minimum("x")
    wanted = aim(system, orbit)
    held = {"A": per.Level(aim, wanted)}
    curve = per.trace(system, "w", (0.9, 1.1), guess=orbit, determined=held)
    assert {curve[0].parameter, curve[-1].parameter} == {0.9, 1.1}
    np.testing.assert_allclose([p.minimum["x"] for p in curve], wanted, rtol=1e-6)
