"""A trace spends no more Newton iterations than it may, says so, and goes on from there when asked."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from test_periodic_resume import disc_options, duffing_options, whole

import periodic as per
import symbolic as sym
from periodic.settings import Accuracy


def allowed(iterations: int) -> per.Settings:
    """Standard accuracy with so many Newton iterations."""
    return Accuracy.STANDARD.settings(per.StepSettings(max_newton=iterations))


@pytest.mark.parametrize("iterations", [1, 10, 60, 200])
def test_no_more_is_spent(iterations: int) -> None:
    """Assert that no more than one correction exceeds what is allowed, and that this is the named reason."""
    settings = allowed(iterations)
    branch = per.trace(**duffing_options(), settings=settings)
    assert iterations < branch.newton_iterations <= iterations + settings.newton.max_iterations
    assert branch.stop == per.Stop.max_newton(iterations) and branch.stop.reason.numerical
    assert str(branch.stop) == f"largest number of Newton iterations reached: {iterations} iterations"


def test_goes_on_with_more() -> None:
    """Assert that a branch that spent all it was allowed, again and again, ends as one that was not cut."""
    options, expected = duffing_options(), whole("duffing")
    branch = per.trace(**options, settings=allowed(150))
    parts = [len(branch)]
    while branch.stop.reason is per.Reason.MAX_NEWTON and len(parts) < 40:
        branch = per.trace(**options, settings=allowed(151), resume=branch)
        parts.append(len(branch))
    assert len(parts) > 3 and parts == sorted(parts)
    assert branch.values == pytest.approx(expected.values, rel=1e-11)
    assert branch.stop == expected.stop


def test_search_for_a_first_orbit_is_bounded() -> None:
    """Assert that the way to a first orbit, from elsewhere, counts too."""
    options = {**disc_options(), "start": 270 * 2 * np.pi / 60}
    branch = per.trace(**options, settings=allowed(40))
    assert len(branch) == 0 and branch.stop.reason is per.Reason.MAX_NEWTON


def test_other_direction_is_not_begun() -> None:
    """Assert that what is spent on one way from the start is not there for the other."""
    branch = per.trace(**{**duffing_options(), "start": 0.5}, settings=allowed(30))
    assert branch.stop.reason is per.Reason.MAX_NEWTON and branch.stop_backwards is None


def rough(order: float) -> sym.CompiledSystem:
    """An oscillator with a spring force of |x|^order, a kink that no switch tells of."""
    x = sym.coordinate("x")
    F = sym.functions

    def rates(s: Any, p: Any) -> dict[str, Any]:
        force = F.fabs(s.x) ** order * F.sign(s.x) if hasattr(F, "sign") else F.fabs(s.x) * s.x
        return {"x": s.v, "v": -0.1 * s.v - force}

    del x
    return sym.compile(sym.Equations(rates, states={"x": 0.0, "v": 0.0}, parameters={}))


@pytest.mark.parametrize("name", ["max_newton", "max_points"])
@pytest.mark.parametrize("value", [0, -3])
def test_refused(name: str, value: int) -> None:
    """Assert the sentence about numbers that allow nothing."""
    with pytest.raises(ValueError, match=f"^{name} is {value}; it must be at least 1$"):
        per.StepSettings(**{name: value})
