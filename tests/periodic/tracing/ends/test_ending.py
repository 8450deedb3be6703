"""Branches whose orbits lose their size: where that is their end, and where not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym

Array = NDArray[np.float64]


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


@pytest.mark.parametrize("stop", [0.0, 3.0])
@pytest.mark.parametrize("start", [0.5, 3.0])
def test_growth_without_bound(stop: float, start: float) -> None:
    """Assert that a parametric oscillator, free or before a linear stop, ends where its linear system does.

    Far out the stop stands at 0: x'' + .1 x' + (1 + .8 cos + 3 [x > 0]) x = 0, integrated by SciPy with the
    switch at its own places, comes back to where it began.
    """

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        pushed = stop * sym.functions.fmax(x.x - 1.0, 0.0)
        return {"x": x.v, "v": -0.1 * x.v - (1 + 0.8 * wave.cos) * x.x + 0.1 * wave.cos - pushed}

    system = sym.compile(sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"Omega": 1.0}, frequency="Omega"))
    branch = per.trace(system, "Omega", (0.4, 3.0), start=start)
    last = branch[-1]
    assert branch.stop.reason is per.Reason.UNBOUNDED and not branch.unaccounted
    assert len(branch) < 250 and 1e9 < last.orbit.span() < 1e13
    far = np.array([last.orbit["x"](0.0), last.orbit["v"](0.0)]) / last.orbit.span()
    assert _linear(last.parameter, stop, far) == pytest.approx(far, abs=1e-8)


def _linear(omega: float, stop: float, start: Array) -> Array:
    """The state after a period of the system that is left far out."""

    def rates(t: float, y: Array, stiffness: float) -> list[float]:
        return [y[1], -0.1 * y[1] - (1 + 0.8 * np.cos(omega * t) + stiffness) * y[0]]

    def passes(t: float, y: Array, stiffness: float) -> float:
        return float(y[0])

    passes.terminal = True  # type: ignore[attr-defined]
    t, state, options = 0.0, start, {"rtol": 1e-12, "atol": 1e-14, "method": "DOP853"}
    side = state[0] if abs(state[0]) > 1e-9 else state[1]
    while t < 2 * np.pi / omega - 1e-12:
        passes.direction = -np.sign(side)  # type: ignore[attr-defined]
        stiff = stop if side > 0 else 0.0
        found = solve_ivp(rates, (t, 2 * np.pi / omega), state, args=(stiff,), events=passes, **options)
        t, state, side = found.t[-1], found.y[:, -1], -side
    return state
