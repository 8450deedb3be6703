"""Events and limits that a branch grazes within one step."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.tracing.steps.leveltest import comes_back

DAMPING = 0.02
HEIGHT = per.PeakToPeak("x")


@cache
def parabola() -> sym.CompiledSystem:
    """Equilibria x = mu, y = 10 (mu - .51)^2."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        return {"x": p.mu - x.x, "y": 10 * (x.x - 0.51) ** 2 - x.y}

    return sym.compile(sym.Equations(rates, {"x": 0.0, "y": 0.0}, {"mu": 0.0}))


@pytest.mark.parametrize("start", [0.47, 0.5, 0.505, 0.508])
@pytest.mark.parametrize("level", [1e-5, 1e-8])
def test_both_passages_in_a_first_step(start: float, level: float) -> None:
    """Assert that a level which a branch goes below and comes back to in its first steps is met twice."""
    watch = per.Watch(events={"low": per.Level(per.mean("y"), level)})
    branch = per.trace(parabola(), "mu", (0, 1), start=start, watch=watch, method=per.Equilibrium())
    places = [point.parameter for point in branch.labelled("UZ")]
    half = np.sqrt(level / 10)
    assert places == [pytest.approx(0.51 + side * half, abs=1e-8) for side in (-1, 1)]


@pytest.mark.parametrize(("start", "depth"), [(0.9998, 1e-5), (0.998, 1e-3), (0.9, 1e-4)])
def test_limit_that_is_grazed(start: float, depth: float) -> None:
    """Assert that orbits of one height end where their force is at its limit, just above the least force.

    With the amplitude A the force of a linear oscillator is A ((1 - Omega^2)^2 + (c Omega)^2)^(1/2).
    """

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.F * wave.cos - DAMPING * x.v - x.x}

    names, values = {"x": 0.0, "v": 0.0}, {"F": 0.05, "Omega": 1.0}
    system = sym.compile(sym.Equations(rates, names, values, frequency="Omega"))
    (begin,) = per.trace(system, "Omega", (0.8, 1.1), at=start).labelled("UZ")
    height, least = HEIGHT(system, begin.orbit), np.sqrt(1 - DAMPING**2 / 2)
    low = height / 2 * np.hypot(1 - least**2, DAMPING * least) * (1 + depth)
    curve = per.trace(
        system,
        "Omega",
        (0.8, 1.1),
        guess=begin.orbit,
        determined={"F": per.Level(HEIGHT, height)},
        watch=per.Watch(limits={"F": (low, 9.0)}),
    )
    assert curve.stop.detail == "lower limit of F"
    assert curve[-1].orbit.parameters["F"] == pytest.approx(low, rel=1e-9)
    assert curve[-1].parameter < least


@pytest.mark.parametrize(
    ("ends", "rates", "near"),
    [
        ((1, 1), (-8, 8), True),
        ((-1, -1), (8, -8), True),
        ((1, 1), (-1, 1), False),
        ((1, 2), (1, 1), False),
        ((0.1, 0.1 + 17 / 12), (1, 1.5), False),
        ((0.1 + 17 / 12, 0.1), (-1.5, -1), False),
    ],
)
def test_cubic(ends: tuple[float, float], rates: tuple[float, float], near: bool) -> None:
    """Assert which cubics come near 0: 1 - 8 t (1 - t) has its least value -1.

    The last two are 0.1 + t + 3 t^2 / 4 - t^3 / 3 and its mirror image: below 0 at -1/2 and 3/2 alone.
    """
    assert comes_back(ends, rates) is near
