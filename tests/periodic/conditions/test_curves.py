"""Curves that folds, doublings and tori trace in two parameters, and what lies on them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.special import mathieu_a, mathieu_b
from support.kept import kept
from support.traces import (
    DUFFING_A,
    FINE,
    RPM,
    STANDARD,
    disc,
    disc_system,
    duffing,
    duffing_system,
    user_points,
)

import periodic as per
import symbolic as sym
from symbolic.equations.assembly import Assembly


@dataclass(frozen=True)
class Parametric(sym.Part):
    """Stiffness that is modulated with the excitation's phase: force 2 depth cos(tau) q."""

    q: sym.Coordinate
    depth: float

    def contribute(self, assembly: Assembly) -> None:
        """Add the force, and the frequency of the excitation."""
        position = assembly.motion(self.q).position.symbol
        assembly.motion(self.q).force += (
            2 * assembly.parameter(self.depth, "depth") * assembly.cosine * position
        )
        assembly.excite(assembly.parameter(1.9, "Omega", "rad/s"))


def mathieu(damping: float, depth: float) -> sym.CompiledSystem:
    """x'' + damping x' + (1 - 2 depth cos(Omega t)) x = 0: a = 4/Omega^2, q = 4 depth/Omega^2."""
    x = sym.coordinate("x")
    return sym.compile(sym.Mass(x, 1.0) + sym.Damper(x, damping) + sym.Spring(x, 1.0) + Parametric(x, depth))


def index(system: sym.CompiledSystem, name: str) -> int:
    """Index of a parameter."""
    return [p.name for p in system.parameters].index(name)


@kept
def fold_curve(which: int) -> per.Branch:
    """The curve of folds of Duffing A over Omega and F, begun at its upper (0) or lower (1) fold."""
    fold = duffing(accuracy=FINE).labelled(per.Label.FOLD)[which]
    return per.trace(
        duffing_system(*DUFFING_A),
        "Omega",
        (0.9, 3.0),
        guess=fold.orbit,
        determined={"F": per.FoldCondition()},
        at=[1.3, 2.0],
        tol=FINE,
    )


@pytest.mark.parametrize("Omega", [1.3, 2.0])
def test_fold_curve_meets_the_folds_of_branches(Omega: float) -> None:
    """Assert that both sheets of the curve lie where branches at their forces turn, to 1e-9."""
    system = duffing_system(*DUFFING_A)
    points = user_points(fold_curve(0), Omega)
    assert len(points) == 2
    for point in points:
        force = float(point.orbit.parameter[index(system, "F")])
        branch = per.trace(
            system,
            "Omega",
            (1.0, 6.0),
            start=4.0,
            values={"F": force},
            watch=per.Watch(stop={"LP": 2}),
            tol=FINE,
        )
        folds = branch.labelled(per.Label.FOLD)
        assert min(abs(p.parameter / Omega - 1) for p in folds) < 1e-11
        assert point.marginal and not point.stable
        assert np.abs(point.multipliers - 1).min() < 1e-9


def test_cusp_of_duffing() -> None:
    """Assert that the curve has one cusp, the same from either fold, that folds appear just there."""
    system = duffing_system(*DUFFING_A)
    cusps = [fold_curve(k).labelled(per.Label.CUSP) for k in (0, 1)]
    assert [len(c) for c in cusps] == [1, 1]
    assert cusps[0][0].parameter == pytest.approx(cusps[1][0].parameter, rel=1e-11)
    force = [float(c[0].orbit.parameter[index(system, "F")]) for c in cusps]
    assert force[0] == pytest.approx(force[1], rel=1e-10)
    for relative, count in ((0.99, 0), (1.01, 2)):
        branch = duffing((0.1, 1.0, relative * force[0]), FINE, (1.0, 1.2))
        assert len(branch.labelled(per.Label.FOLD)) == count
    # One harmonic: F^2/A^2 = (1 - W^2 + 3/4 A^2)^2 + c^2 W^2 has its cusp near sqrt(3) c to leading order.
    assert cusps[0][0].parameter == pytest.approx(1 + math.sqrt(3) * 0.1 / 2, abs=5e-3)


@pytest.mark.parametrize("depth", [0.05, 0.15, 0.4])
def test_doubling_curve_of_mathieu(depth: float) -> None:
    """Assert that the doublings of the undamped equation follow both boundaries a1, b1 over the depth."""
    system = mathieu(0.0, 0.1)
    branch = per.trace(system, "Omega", (1.7, 2.3), tol=FINE)
    doublings = branch.labelled(per.Label.DOUBLING)
    assert len(doublings) == 2
    for begin in doublings:
        curve = per.trace(
            system,
            "depth",
            (0.03, 0.5),
            guess=begin.orbit,
            determined={"Omega": per.DoublingCondition()},
            at=[depth],
            tol=FINE,
        )
        assert len(user_points(curve, depth)) == 1
        boundary = mathieu_a if begin.parameter < 2 else mathieu_b
        # undamped, -1 is a double multiplier there and the place is known to its digits all the same
        for Omega, modulation in zip(curve.column("Omega"), curve.column("depth"), strict=True):
            a, q = 4 / Omega**2, 4 * modulation / Omega**2
            assert min(abs(a - float(boundary(1, s * q))) for s in (1, -1)) < 1e-9


def test_doubling_curve_of_the_disc() -> None:
    """Assert that the disc's doublings over speed and preload lie on branches at another preload."""
    system = disc_system("vitrea79-810N")
    small = per.trace(system, "speed", (540 * RPM, 600 * RPM), start=600 * RPM)
    begin = small.labelled(per.Label.DOUBLING)[0]
    assert begin.parameter / RPM == pytest.approx(569.961132, rel=1e-8)
    curve = per.trace(
        system,
        "preload",
        (600.0, 1300.0),
        guess=begin.orbit,
        determined={"speed": per.DoublingCondition()},
        at=[1200.0],
    )
    (point,) = user_points(curve, 1200.0)
    speed = float(point.orbit.parameter[index(system, "speed")])
    assert point.multipliers[0] == pytest.approx(-1, abs=1e-9)
    bounds = (speed - 10 * RPM, speed + 10 * RPM)
    other = per.trace(system, "speed", bounds, start=bounds[1], values={"preload": 1200.0})
    found = [p.parameter for p in other.labelled(per.Label.DOUBLING)]
    assert min(abs(value / speed - 1) for value in found) < 1e-9


def test_doubling_curve_stays_on_its_side_of_the_tongue() -> None:
    """Assert that long steps do not cross to the other side, whose orbits are nearly the same."""
    system = disc_system("vitrea79-810N")
    small = per.trace(system, "speed", (540 * RPM, 560 * RPM), start=560 * RPM)
    (begin,) = small.labelled(per.Label.DOUBLING)
    assert begin.parameter / RPM == pytest.approx(545.397607, rel=1e-8)
    curve = per.trace(
        system,
        "speed",
        (500 * RPM, 1980 * RPM),
        guess=begin.orbit,
        determined={"preload": per.DoublingCondition()},
        watch=per.Watch(
            limits={"preload": (700.0, 20000.0)}, events={"heavy": per.Level(per.Value("preload"), 2100.0)}
        ),
    )
    (point,) = [p for p in curve if p.event == "heavy"]
    # the sides at 2100 N, found as doublings by tests/reports/studies/paper/test_unseen.py: 651.17, 665.88
    assert point.parameter / RPM == pytest.approx(651.170989, rel=1e-8)


def test_folds_of_the_disc_over_preload() -> None:
    """Assert that the lower fold's curve passes, at 200 rev/min, the fold of a branch over preload."""
    system = disc_system("vitrea79-810N")
    fold = disc("vitrea79-810N", STANDARD).labelled(per.Label.FOLD)[1]
    curve = per.trace(
        system,
        "speed",
        (195 * RPM, 260 * RPM),
        guess=fold.orbit,
        determined={"preload": per.FoldCondition()},
        at=[200 * RPM],
    )
    (point,) = user_points(curve, 200 * RPM)
    # found as a fold over preload at 200 rev/min by tests/reports/studies/paper/test_frequency.py
    assert point.orbit.parameter[index(system, "preload")] == pytest.approx(300.021108, rel=1e-8)


def test_torus_curve_of_a_linear_oscillator() -> None:
    """Assert that tori have the damping 0 at every frequency, and resonances where the angle is theirs."""
    x = sym.coordinate("x")
    parts = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 0.3)
    system = sym.compile(parts)
    begin = per.trace(system, "c", (-0.05, 0.1), start=0.1, values={"Omega": 0.9}, tol=FINE)
    (torus,) = begin.labelled(per.Label.TORUS)
    curve = per.trace(
        system,
        "Omega",
        (0.72, 0.95),
        guess=torus.orbit,
        determined={"c": per.TorusCondition()},
        tol=FINE,
    )
    assert curve.column("c") == pytest.approx(np.zeros(len(curve)), abs=1e-11)
    found = [(p.label.value, p.parameter) for p in curve.special_points if p.label is not per.Label.END]
    # the angle is 2 pi/Omega: a quarter past a turn at 4/5, a third past it at 3/4
    assert [label for label, _ in found] == ["R3", "R4"]
    assert [Omega for _, Omega in found] == pytest.approx([0.75, 0.8], rel=1e-11)


def test_torus_curve_passes_neutral_saddles() -> None:
    """Assert that beyond R1, where exp(2 pi (-k)^.5/Omega) and its inverse are real, the curve says so."""
    x = sym.coordinate("x")
    parts = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 0.3)
    system = sym.compile(parts)
    given = {"Omega": 0.9, "k": 0.02}
    begin = per.trace(system, "c", (-0.05, 0.1), start=0.1, values=given, tol=FINE)
    (torus,) = begin.labelled(per.Label.TORUS)
    held = {"c": per.TorusCondition()}
    curve = per.trace(system, "k", (-0.05, 0.02), guess=torus.orbit, determined=held, tol=FINE)
    assert [p.label.value for p in curve.special_points] == ["EP", "R1", "EP"]
    beyond = [p for p in curve if p.parameter < -1e-9]
    growth = np.exp(2 * np.pi / 0.9 * np.sqrt(0.05))
    end = min(curve, key=lambda point: point.parameter)
    assert end.multipliers == pytest.approx(np.array([growth, 1 / growth]), rel=1e-9)
    (placed,) = curve.labelled(per.Label.RESONANCE_1)
    assert placed.parameter == pytest.approx(0, abs=5e-8)
    # at R1, k = 0, nothing holds the mean: an orbit that rounding places within 1e-8 of it may miss tol
    missed = [p for p in curve if p.error.worst > FINE]
    assert missed in ([], [placed])
    saddles = f"{len(beyond)} of {len(curve)} points are neutral saddles, no tori (NS): the pair"
    _remarks_are(curve, len(missed), saddles)
    worse = replace(placed, error=replace(placed.error, orbit=3e-9))
    points = tuple(worse if point is placed else point for point in curve)
    _remarks_are(replace(curve, points=points), 1, saddles)


def _remarks_are(curve: per.Branch, missed: int, saddles: str) -> None:
    """Assert what is said of a curve of which so many points, at most the one at R1, miss the tolerance."""
    *singular, told = curve.remarks
    assert told.startswith(saddles)
    assert singular == [curve.shortfall] * missed
    assert bool(curve.shortfall) == bool(missed)
    assert not missed or curve.shortfall.startswith(f"1 of {len(curve)} points: orbits to 1e-")
    assert not missed or "near k = " in curve.shortfall


def test_curve_is_saved_with_what_it_is(tmp_path: object) -> None:
    """Assert that a curve's points stay marginal, and its labels, through a file."""
    path = f"{tmp_path}/curve.nc"
    fold_curve(0).save(path)
    again = per.Branch.load(path)
    assert all(p.marginal for p in again)
    assert [p.label for p in again] == [p.label for p in fold_curve(0)]
