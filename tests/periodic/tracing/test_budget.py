"""A trace spends no more Newton iterations than it may, says so, and goes on from there when asked."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.resumed import disc_options, duffing_options, whole

import periodic as per
import symbolic as sym


def allowed(iterations: int) -> per.ArclengthControl:
    """So many Newton iterations."""
    return per.ArclengthControl(max_newton=iterations)


@pytest.mark.parametrize("iterations", [10, 60, 200])
def test_no_more_is_spent(iterations: int) -> None:
    """Assert that no more than one correction exceeds what is allowed, and that this is the named reason."""
    branch = per.trace(**duffing_options(), control=allowed(iterations))
    most = per.Tolerance.of(per.Accuracy.STANDARD).newton.max_iterations
    assert iterations < branch.newton_iterations <= iterations + most
    assert branch.stop == per.Stop.max_newton(iterations) and branch.stop.reason.numerical
    assert str(branch.stop) == f"largest number of Newton iterations reached: {iterations} iterations"


def test_goes_on_with_more() -> None:
    """Assert that a branch that spent all it was allowed, again and again, ends as one that was not cut.

    What is allowed is allowed to the branch: as much again gives no further point.
    """
    options, expected = duffing_options(), whole("duffing")
    branch = per.trace(**options, control=allowed(100))
    parts = [len(branch)]
    while branch.stop.reason is per.Reason.MAX_NEWTON and len(parts) < 40:
        assert len(per.trace(**options, control=allowed(100 * len(parts)), guess=branch)) == len(branch)
        branch = per.trace(**options, control=allowed(100 * (len(parts) + 1)), guess=branch)
        parts.append(len(branch))
    assert len(parts) > 2 and parts == sorted(parts)
    assert branch.values == pytest.approx(expected.values, rel=1e-11)
    assert branch.stop == expected.stop


def test_search_for_a_first_orbit_is_bounded() -> None:
    """Assert that the way to a first orbit, from elsewhere, counts too."""
    options = {**disc_options(), "start": 270 * 2 * np.pi / 60}
    branch = per.trace(**options, control=allowed(40))
    assert len(branch) == 0 and branch.stop.reason is per.Reason.MAX_NEWTON
    assert branch.stop.detail == (
        "40 iterations, all before a first orbit: none was found at the start itself; more iterations, "
        "another start or guess=per.sampled(...), a motion from a simulation, may lead to one"
    )


def test_start_itself_may_take_all() -> None:
    """Assert that it is said where not even the guess could be tried to its end."""
    branch = per.trace(**duffing_options(), control=allowed(1))
    assert len(branch) == 0 and branch.newton_iterations <= 20
    assert branch.stop.detail.startswith(
        "1 iteration, all before a first orbit: none was found at the start itself; more iterations"
    )


def test_other_direction_is_not_begun() -> None:
    """Assert that what is spent on one way from the start is not there for the other."""
    branch = per.trace(**{**duffing_options(), "start": 0.5}, control=allowed(30))
    assert branch.stop.reason is per.Reason.MAX_NEWTON and branch.stop_backwards is None


def rubbing() -> sym.CompiledSystem:
    """An oscillator with dry friction, whose all but jumps no switch tells of: no mesh will do."""
    F = sym.functions

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        friction = p.dry * F.tanh(1e12 * x.v)
        return {"x": x.v, "v": -0.02 * x.v - x.x - x.x**3 - friction + wave.cos}

    parameters = {"Omega": 0.3, "dry": 0.3}
    states = {"x": 0.0, "v": 0.0}
    return sym.compile(sym.Equations(rates, states=states, parameters=parameters, frequency="Omega"))


@pytest.mark.parametrize("start, intervals, most", [(0.8, 400, 1000), (0.3, 1000, 5000)])
def test_hopeless_equations_end_soon(start: float, intervals: int, most: int) -> None:
    """Assert that each step of a trace that no mesh is right for costs a bounded number of iterations."""
    method = per.Collocation(ntst_max=intervals)
    branch = per.trace(rubbing(), "Omega", (start, 2.0), method=method, control=allowed(most))
    assert branch.stop.reason in (per.Reason.NO_START, per.Reason.INACCURATE, per.Reason.SMALL_STEP)
    assert branch.newton_iterations < most


@pytest.mark.parametrize("name", ["max_newton", "max_points"])
@pytest.mark.parametrize("value", [0, -3])
def test_refused(name: str, value: int) -> None:
    """Assert the sentence about numbers that allow nothing."""
    with pytest.raises(ValueError, match=f"^{name} is {value}; it must be a whole number of at least 1$"):
        per.ArclengthControl(**{name: value})
