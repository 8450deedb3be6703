"""Curves of folds and of Hopf points of equilibria in two parameters, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.equations import brusselator, stuart_landau

import periodic as per
import symbolic as sym


def cubic() -> sym.CompiledSystem:
    """x' = a + b / 2 + b x - x^3 by way of an unknown z = x^3, with y' = x - y beside it."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        return {"x": p.a + p.b / 2 + p.b * x.x - x.z, "y": x.x - x.y, "z": x.z - x.x**3}

    parameters, states = {"a": 0.0, "b": 1.0}, {"x": 0.0, "y": 0.0}
    return sym.compile(sym.Equations(rates, states, parameters, unknowns={"z": 0.0}))


def test_curve_of_folds_with_its_cusp() -> None:
    """Assert 27 (a + b/2)^2 = 4 b^3 along the folds, through the cusp at a = b = 0, to 10 digits."""
    system = cubic()
    branch = per.trace(
        system, "a", (-2, 1), guess={"x": -1.5, "y": -1.5, "z": -3.4}, method=per.Equilibrium()
    )
    fold = branch.labelled("LP")[0]
    held = {"b": per.FoldCondition()}
    curve = per.trace(system, "a", (-1, 1), guess=fold.orbit, determined=held, method=per.Equilibrium())
    assert len(curve) > 10
    a, b = curve.values, curve.column("b")
    assert 27 * (a + b / 2) ** 2 == pytest.approx(4 * b**3, rel=1e-10, abs=1e-10)
    assert all(np.abs(p.multipliers).min() < 1e-9 for p in curve)
    other = per.trace(
        system,
        "b",
        (-0.5, 1.5),
        guess=fold.orbit,
        determined={"a": per.FoldCondition()},
        method=per.Equilibrium(),
    )
    (cusp,) = other.labelled("CP")
    assert cusp.parameter == pytest.approx(0.0, abs=1e-9)
    assert cusp.orbit.parameters["a"] == pytest.approx(0.0, abs=1e-9)


def test_curve_of_hopf_points() -> None:
    """Assert B = 1 + A^2 along the Hopf points of the Brusselator, whose frequency is A, to 10 digits."""
    system = brusselator()
    names = [p.name for p in system.parameters]
    (hopf,) = per.trace(system, "B", (1, 4), method=per.Equilibrium()).labelled("HB")
    curve = per.trace(
        system,
        "A",
        (0.5, 2.0),
        guess=hopf.orbit,
        determined={"B": per.HopfCondition()},
        method=per.Equilibrium(),
    )
    assert {"A", "B"} <= set(names) and {curve[0].parameter, curve[-1].parameter} == {0.5, 2.0}
    assert curve.column("B") == pytest.approx(1 + curve.values**2, rel=1e-10)
    for point in curve:
        assert np.abs(point.multipliers.real).max() < 1e-9
        assert np.abs(point.multipliers.imag) == pytest.approx(point.parameter, rel=1e-9)
        assert per.eigenvalues(system, point.orbit) == pytest.approx(point.multipliers)


def test_what_a_hopf_curve_passes() -> None:
    """Assert GH where the normal form's cubic term vanishes, and ZH where a real eigenvalue passes 0."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        square = x.x**2 + x.y**2
        growth = p.a + (p.b - 0.3) * square - square**2
        return {"x": growth * x.x - x.y, "y": x.x + growth * x.y, "z": (p.b - 0.6) * x.z - x.z**3}

    system = sym.compile(sym.Equations(rates, dict.fromkeys("xyz", 0.0), {"a": -1.0, "b": 0.1}))
    (hopf,) = per.trace(system, "a", (-1, 1), method=per.Equilibrium()).labelled("HB")
    curve = per.trace(
        system, "b", (0, 1), guess=hopf.orbit, determined={"a": per.HopfCondition()}, method=per.Equilibrium()
    )
    found = [(p.label.value, p.parameter) for p in curve.special_points if p.label != "EP"]
    assert found == [("GH", pytest.approx(0.3, abs=1e-9)), ("ZH", pytest.approx(0.6, abs=1e-9))]


def test_hopf_condition_is_for_equilibria() -> None:
    """Assert the sentence for orbits."""
    system = stuart_landau()
    (hopf,) = per.trace(system, "mu", (-1, 1), method=per.Equilibrium()).labelled("HB")
    orbit = per.hopf(system, hopf.orbit, "mu")
    with pytest.raises(ValueError, match="HopfCondition.., which holds equilibria"):
        per.trace(system, "mu", (-1, 1), guess=orbit, determined={"omega": per.HopfCondition()})
