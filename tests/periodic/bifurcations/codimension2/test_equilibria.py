"""BT, ZH and GH on curves of folds and of Hopf points of equilibria, against closed forms."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym


@cache
def takens() -> sym.CompiledSystem:
    """x' = y, y' = a + b x + x^2 + x y, of which z = x y is an unknown, beside a stiff state.

    Folds at b^2 = 4 a, x = -b / 2; Hopf points at a = x = 0, of frequency (-b)^(1/2); BT at a = b = 0.
    """

    def rates(x: Any, p: Any) -> dict[str, Any]:
        return {"x": x.y, "y": p.a + p.b * x.x + x.x**2 + x.z, "w": x.x - 50 * x.w, "z": x.z - x.x * x.y}

    states, unknowns = dict.fromkeys("xyw", 0.0), {"z": 0.0}
    return sym.compile(sym.Equations(rates, states, {"a": 0.2, "b": -1.0}, unknowns=unknowns))


def special(branch: per.Branch) -> list[str]:
    """Labels but for the ends."""
    return [p.label.value for p in branch.special_points if p.label is not per.Label.END]


def start() -> per.Branch:
    """Equilibria over a at b = -1: a fold at a = .25, x = .5, a Hopf point at a = 0 = x."""
    return per.trace(takens(), "a", (-0.5, 1.0), guess={"x": -0.36, "w": -0.0072}, method=per.Equilibrium())


def test_fold_curve_passes_takens() -> None:
    """Assert BT at the origin along the folds b^2 = 4 a, to 1e-9."""
    (fold,) = start().labelled("LP")
    held = {"a": per.FoldCondition()}
    curve = per.trace(takens(), "b", (-1, 1), guess=fold.orbit, determined=held, method=per.Equilibrium())
    assert curve.column("a") == pytest.approx(curve.values**2 / 4, abs=1e-10)
    assert special(curve) == ["BT"]
    (point,) = curve.labelled("BT")
    assert [point.parameter, point.orbit.parameters["a"]] == pytest.approx([0, 0], abs=1e-9)


def test_hopf_curve_passes_takens() -> None:
    """Assert BT at the origin along the Hopf points a = 0, and neutral saddles beyond it, to 1e-9."""
    (hopf,) = start().labelled("HB")
    held = {"a": per.HopfCondition()}
    curve = per.trace(takens(), "b", (-1, 1), guess=hopf.orbit, determined=held, method=per.Equilibrium())
    assert special(curve) == ["BT"]
    (point,) = curve.labelled("BT")
    assert point.parameter == pytest.approx(0, abs=1e-9)
    assert {curve[0].parameter, curve[-1].parameter} == {-1.0, 1.0}
    assert curve.column("a") == pytest.approx(np.zeros(len(curve)), abs=1e-10)
    for found in curve:
        root = np.sqrt(complex(found.parameter))
        assert np.abs(found.multipliers**2 - root**2).min() < 1e-9
    beyond = sum(found.parameter > 1e-8 for found in curve)
    (told,) = curve.remarks
    assert "points are neutral saddles, no Hopf points (HB): the pair that is held is real" in told
    assert beyond <= int(told.split()[0]) <= beyond + 1  # one may lie on BT to rounding
    assert told.endswith(" to 1")


def test_predator_and_prey() -> None:
    """Assert the BT that folds and Hopf points share of Bazykin's predator and prey, where tr J = det J = 0.

    x' = x - x y / (1 + a x) - e x^2, y' = -c y + x y / (1 + a x) - d y^2 with c = 1, e = .01.
    """

    def rates(x: Any, p: Any) -> dict[str, Any]:
        eaten = x.x * x.y / (1 + p.a * x.x)
        return {"x": x.x - eaten - 0.01 * x.x**2, "y": -x.y + eaten - p.d * x.y**2}

    system = sym.compile(sym.Equations(rates, {"x": 1.0, "y": 1.0}, {"a": 0.3, "d": 0.1}))
    branch = per.trace(
        system, "d", (0.0, 1.0), start=0.1, guess={"x": 70.0, "y": 6.0}, method=per.Equilibrium()
    )
    found = []
    for label, condition in (("LP", per.FoldCondition()), ("HB", per.HopfCondition())):
        begin = branch.labelled(label)[0].orbit
        curve = per.trace(
            system, "a", (0.05, 0.6), guess=begin, determined={"d": condition}, method=per.Equilibrium()
        )
        found.append([(p.parameter, p.orbit.parameters["d"]) for p in curve.labelled("BT")])
        for point in curve.labelled("BT"):
            assert np.abs(np.poly(per.eigenvalues(system, point.orbit))[1:]).max() < 1e-9
    assert len(found[0]) and found[0][0] == pytest.approx(found[1][0], rel=1e-8)


def test_fold_curve_passes_a_pair() -> None:
    """Assert ZH where a pair reaches the imaginary axis beside a fold, and nothing at a neutral saddle."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        growth = p.b - 0.6
        saddle = {"s": x.r, "r": (0.2 - p.b) * x.r + 2 * x.s}
        return {"x": p.a - x.x**2, "u": growth * x.u - 3 * x.v, "v": 3 * x.u + growth * x.v, **saddle}

    system = sym.compile(sym.Equations(rates, dict.fromkeys("xuvsr", 0.0), {"a": 1.0, "b": 0.0}))
    (fold,) = per.trace(system, "a", (-1, 1), start=1.0, guess={"x": 1.0}, method=per.Equilibrium()).labelled(
        "LP"
    )
    held = {"a": per.FoldCondition()}
    curve = per.trace(system, "b", (0, 1), guess=fold.orbit, determined=held, method=per.Equilibrium())
    assert [(p.label.value, p.parameter) for p in curve.special_points if p.label != "EP"] == [
        ("ZH", pytest.approx(0.6, abs=1e-9))
    ]
