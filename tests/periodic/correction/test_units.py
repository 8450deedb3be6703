"""The second parameter in the metric of curves: where it alone moves they are followed all the same."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym


@cache
def mathieu() -> sym.CompiledSystem:
    """x'' + .05 x' + (1 - 2 depth cos(Omega t)) x = 0: orbits at rest, which double within a tongue."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": -0.05 * x.v - (1 - 2 * p.depth * wave.cos) * x.x}

    names, values = {"x": 0.0, "v": 0.0}, {"depth": 0.2, "Omega": 1.9}
    return sym.compile(sym.Equations(rates, names, values, frequency="Omega"))


def test_tip_of_a_tongue() -> None:
    """Assert that the curve of doublings goes round the tip, where only the second parameter moves.

    Its two ends are where branches at their depth double, to 1e-8, and its steps are no longer than asked.
    """
    system = mathieu()
    upper = per.trace(system, "Omega", (1.5, 2.6)).labelled("PD")[0]
    held = {"Omega": per.DoublingCondition()}
    curve = per.trace(system, "depth", (0.01, 0.5), guess=upper.orbit, determined=held)
    assert [curve[0].parameter, curve[-1].parameter] == [0.5, 0.5]
    assert curve.values.min() == pytest.approx(0.05, rel=1e-3)  # the damping, to leading order
    doublings = per.trace(system, "Omega", (1.2, 3.0), values={"depth": 0.5}).labelled("PD")
    ends = [point.orbit.parameters["Omega"] for point in (curve[-1], curve[0])]
    assert sorted(ends) == pytest.approx([point.parameter for point in doublings[-2:]], rel=1e-8)
    assert np.abs(np.diff(np.log(curve.column("Omega")))).max() < 0.2


def test_tip_of_a_tongue_over_a_detuning() -> None:
    """Assert that a second parameter which is 0 in the system has the size that it begins with.

    Its curve goes round the tip as that of the stiffness 1 + d does, to the same ends.
    """
    ends = []
    for zero in (0.0, 1.0):

        def rates(x: Any, p: Any, wave: Any, own: float = 1.0 - zero) -> dict[str, Any]:
            return {"x": x.v, "v": -0.05 * x.v - (own + p.d - 2 * p.depth * wave.cos) * x.x}

        names, values = {"x": 0.0, "v": 0.0}, {"depth": 0.2, "d": zero, "Omega": 2.0}
        system = sym.compile(sym.Equations(rates, names, values, frequency="Omega"))
        doubling = per.trace(system, "d", (zero - 0.6, zero + 0.6)).labelled("PD")[-1]
        held = {"d": per.DoublingCondition()}
        curve = per.trace(system, "depth", (0.01, 0.5), guess=doubling.orbit, determined=held)
        assert [curve[0].parameter, curve[-1].parameter] == [0.5, 0.5]
        assert 0.05 < curve.values.min() < 0.055
        ends.append(curve.column("d")[[0, -1]] - zero)
    assert ends[0] == pytest.approx(ends[1], rel=1e-8)


def test_units() -> None:
    """Assert which parameters count: not those that all orbits have a condition for."""
    system = mathieu()
    orbit = per.trace(system, "depth", (0.1, 0.2))[0].orbit
    plain = per.Problem(system, "depth", (0.0, 0.5))
    curve = per.Problem(system, "depth", (0.0, 0.5), {"Omega": per.DoublingCondition()})
    free = per.Problem(system, "depth", (0.0, 0.5), {"Omega": per.PhaseCondition()})
    assert plain.units(orbit) == free.units(orbit) == 0.5
    assert curve.units(orbit) == pytest.approx([0.5, 1.9])
