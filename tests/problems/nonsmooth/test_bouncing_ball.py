"""A ball on a shaken table, which nothing holds: it is thrown in time, and its branch has closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym

GRAVITY, SHAKEN, RESTITUTION = 9.81, 0.3, 0.5


def ball() -> sym.CompiledSystem:
    """q'' = -g above A cos(Omega t), with restitution e of the speed relative to the table."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"q": x.v, "v": -GRAVITY}

    def table(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        moved = -SHAKEN * p.Omega * wave.sin
        return {"table": (x.q - SHAKEN * wave.cos, {"v": moved - RESTITUTION * (x.v - moved)})}

    states = {"q": 1.0, "v": 0.0}
    return sym.compile(sym.Equations(rates, states, {"Omega": 6.5}, frequency="Omega", resets=table))


def test_reason_says_that_impacts_pile_up() -> None:
    """Assert that one thrown too low comes to rest on the table, and that the branch says so."""
    branch = per.trace(ball(), "Omega", (5.0, 10.0), start=6.5)
    assert branch.stop.reason is per.Reason.NO_START
    assert "; nothing holds q; " in branch.stop.detail
    assert "a simulation left to settle (events pile up at tau = " in branch.stop.detail


def thrown(high: float) -> per.Branch:
    """The branch of the motion that bounces once a period, up to a speed."""
    system = ball()
    motion = sym.simulate(system, start={"q": 2.0})
    guess = per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter, system=system)
    return per.trace(system, "Omega", (5.0, high), start=6.5, guess=guess)


@pytest.mark.parametrize("high", [7.1, pytest.param(10.0, marks=pytest.mark.long)])
def test_thrown_higher_it_bounces_once_a_period(high: float) -> None:
    """Assert fold and period doubling of that motion in closed form, to 9 digits.

    With G = A Omega^2 / g they are at G = pi (1 - e)/(1 + e) and G^2 = that^2 + (2 (1 + e^2)/(1 + e)^2)^2
    (Holmes, J. Sound Vib. 84 (1982) 173). Towards 7.23 rad/s the branch has thousands of points.
    """
    branch = thrown(high)
    assert branch.stop.reason is per.Reason.BOUND
    e = RESTITUTION
    least = np.pi * (1 - e) / (1 + e)
    doubled = np.hypot(least, 2 * (1 + e**2) / (1 + e) ** 2)
    fold, doubling = (np.sqrt(ratio * GRAVITY / SHAKEN) for ratio in (least, doubled))
    folds, doublings = (branch.labelled(label) for label in ("LP", "PD"))
    assert min(point.parameter for point in folds) == pytest.approx(fold, rel=1e-9)
    assert doublings[-1].parameter == pytest.approx(doubling, rel=1e-9)
