"""Branches whose orbits lose their size: where that is their end, and where not."""

from __future__ import annotations

from typing import Any

import pytest

import periodic as per
import symbolic as sym


@pytest.mark.parametrize("cubic", [0.0, 1.0])
def test_passing_through_rest_is_no_end(cubic: float) -> None:
    """Assert that a branch in a force goes on where the force, and with it the motion, is nothing."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.F * wave.cos - 0.1 * x.v - x.x - cubic * x.x**3}

    names, values = {"x": 0.0, "v": 0.0}, {"F": 1.0, "Omega": 0.5}
    system = sym.compile(sym.Equations(rates, names, values, frequency="Omega"))
    branch = per.trace(system, "F", (-0.5, 0.5), at=(-1e-14, 0.0, 1e-14))
    assert branch.stop.reason is per.Reason.BOUND and branch[-1].parameter == 0.5
    assert len(branch.labelled("UZ")) == 3


def test_staying_at_rest_is_no_end() -> None:
    """Assert that a branch of orbits at rest is followed to its bound."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": -(1 + 0.2 * wave.cos) * x.x - p.c * x.v}

    names, values = {"x": 0.0, "v": 0.0}, {"c": 0.1, "Omega": 1.0}
    system = sym.compile(sym.Equations(rates, names, values, frequency="Omega"))
    branch = per.trace(system, "Omega", (0.5, 3.0))
    assert branch.stop.reason is per.Reason.BOUND and branch[-1].orbit.span() < 1e-12
