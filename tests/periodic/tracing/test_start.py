"""First orbits that Newton does not find from rest: settled, grown from 0, sampled; what is said if none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from reference.integration import path
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym
from periodic.results.stop import Stop
from periodic.tracing.start import Start

F = sym.functions
FEW = per.ArclengthControl(max_points=3)


def forced(rates: Any, **parameters: float) -> sym.CompiledSystem:
    """A system with the states x and v at rest at 0, forced with the frequency Omega."""
    states = {"x": 0.0, "v": 0.0}
    return sym.compile(sym.Equations(rates, states, parameters, frequency="Omega"))


def returns(branch: per.Branch, acceleration: Any) -> None:
    """Assert by DOP853 that the first orbit is periodic."""
    orbit, Omega = branch[0].orbit, branch[0].parameter
    start = orbit.state(np.zeros(1))[0]

    def rates(tau: float, y: np.ndarray) -> list[float]:
        return [y[1] / Omega, acceleration(y[0], y[1], np.cos(tau)) / Omega]

    assert path(rates, start)[:, -1] == pytest.approx(start, abs=1e-7)


def test_backlash_from_rest() -> None:
    """Assert that a mass loose within its backlash is started by a simulation that settles."""

    def acceleration(x: Any, v: Any, wave: Any) -> Any:
        return -0.05 * v - max(x - 1, 0.0) - min(x + 1, 0.0) + 0.1 + 0.05 * wave

    system = forced(
        lambda x, p, wave: {
            "x": x.v,
            "v": -0.05 * x.v - F.fmax(x.x - 1, 0) - F.fmin(x.x + 1, 0) + 0.1 + 0.05 * wave.cos,
        },
        Omega=0.8,
    )
    branch = per.trace(system, "Omega", (0.8, 1.5), control=FEW)
    assert len(branch) == 3
    returns(branch, acceleration)


def test_forcing_grown_from_rest() -> None:
    """Assert that orbits to which nothing settles, of negative damping, are reached by growing the force."""
    system = forced(
        lambda x, p, wave: {"x": x.v, "v": 0.05 * x.v - x.x - x.x**3 + p.F * wave.cos}, Omega=2.0, F=30.0
    )
    branch = per.trace(system, "Omega", (2.0, 2.1), control=FEW)
    assert len(branch) == 3 and not branch[0].stable
    returns(branch, lambda x, v, wave: 0.05 * v - x - x**3 + 30 * wave)


def test_what_was_tried_is_said() -> None:
    """Assert that a branch without a first orbit says what was tried and what else there is."""
    system = forced(
        lambda x, p, wave: {"x": x.v, "v": 1 + x.x**2 + x.v**2 + p.F * wave.cos}, Omega=1.0, F=0.3
    )
    branch = per.trace(system, "Omega", (1.0, 2.0), control=FEW)
    assert branch.stop.reason is per.Reason.NO_START and len(branch) == 0
    assert "nor was one found from other values of Omega, a simulation left to settle (" in branch.stop.detail
    assert branch.stop.detail.endswith("); guess=per.sampled(...) takes a motion from a simulation")


def test_rest_on_a_jump_that_nothing_pushes_is_an_orbit() -> None:
    """Assert equilibria of a mass with friction, and the motion of another one beside it while it rests."""

    def rubbed(x: Any, p: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.f - x.x - 0.1 * x.v - 0.5 * sym.functions.sign(x.v)}

    alone = sym.compile(sym.Equations(rubbed, {"x": 0.0, "v": 0.0}, {"f": 0.3}))
    rests = per.trace(alone, "f", (-1.0, 1.0), method=per.Equilibrium())
    assert rests.stop.reason is per.Reason.BOUND
    assert [point.maximum["x"] for point in rests] == pytest.approx(rests.values, abs=1e-9)

    def beside(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        first = -x.x - 0.1 * x.v - 0.5 * sym.functions.sign(x.v)
        return {"x": x.v, "v": first, "y": x.u, "u": wave.cos - x.y - 0.1 * x.u}

    both = sym.Equations(beside, dict.fromkeys(("x", "v", "y", "u"), 0.0), {"Omega": 0.5}, frequency="Omega")
    branch = per.trace(sym.compile(both), "Omega", (0.5, 0.6))
    assert branch.stop.reason is per.Reason.BOUND
    for point in branch:
        assert point.peak_to_peak("x") == 0.0
        exact = 2 / abs(1 - point.parameter**2 + 0.1j * point.parameter)
        assert point.peak_to_peak("y") == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_way_that_ends_before_the_wanted_value_is_none(factor: float) -> None:
    """Assert that an approach from below or above counts only where it arrives; there it gives its orbit."""
    system = forced(lambda x, p, wave: {"x": x.v, "v": -0.1 * x.v - x.x + p.F * wave.cos}, Omega=0.8, F=0.2)
    run = per.continuation(per.Problem(system, "F", (0.1, 0.3)), start=0.2)
    there = next(run).orbit
    stop = Stop(per.Reason.SMALL_STEP, "")
    short = Start(run.solver, lambda solver, orbit, sign, most: (orbit, stop))
    assert short._approached(there, factor) is None
    whole = Start(run.solver, lambda solver, orbit, sign, most: (there, stop))
    assert whole._approached(there, factor) is there


@pytest.mark.parametrize(("friction", "holds"), [(0.6, True), (0.1, False)])
def test_what_friction_holds_is_followed(friction: float, holds: bool) -> None:
    """Assert that two masses that friction does not let slide move as one, where they were put: to 1e-8.

    2 q'' + .1 q' + 5 q = .5 cos(w t).
    """
    x, y = sym.coordinate("x"), sym.coordinate("y")
    parts: list[sym.Part] = [sym.HarmonicForce(x, 0.5, 0.6), sym.CoulombFriction(x, friction, to=y)]
    for q, k in ((x, 1.0), (y, 4.0)):
        parts += [sym.Mass(q, 1.0), sym.Spring(q, k), sym.Damper(q, 0.05)]
    branch = per.trace(sym.compile(sym.combine(parts)), "Omega", (0.6, 0.7), control=FEW)
    assert branch.stop.reason is per.Reason.MAX_POINTS
    for point in branch:
        assert (point.orbit.mesh.modes != ()) is holds
        w = point.parameter
        as_one = 2 * 0.5 / abs(5 - 2 * w**2 + 0.1j * w)
        apart = [abs(point.peak_to_peak(q) - as_one) for q in "xy"]
        assert (max(apart) < 1e-8 * as_one) is holds


EPS = 1e-3


@pytest.mark.parametrize("begin", [0, 700])
def test_relaxation_oscillation_from_samples(begin: int) -> None:
    """Assert that 2001 even samples with jumps are a start, from any phase; the period to 9 digits."""

    def rates(t: float, u: np.ndarray) -> list[float]:
        return [(u[1] - u[0] ** 3 / 3 + u[0]) / EPS, -u[0]]

    def rising(t: float, u: np.ndarray) -> float:
        return float(u[1])

    rising.direction = 1.0  # type: ignore[attr-defined]
    exact = {"method": "Radau", "rtol": 1e-10, "atol": 1e-12}
    found = solve_ivp(rates, (0, 5), [2.0, 0.1], events=rising, **exact)
    period = float(np.diff(found.t_events[0][-2:])[0])
    omega, times = 2 * np.pi / period, np.linspace(0, period, 2001)
    motion = solve_ivp(rates, (0, period), found.y_events[0][-2], t_eval=times, **exact).y.T
    motion = np.concatenate([motion[begin:-1], motion[: begin + 1]])
    system = sym.compile(
        sym.Equations(
            lambda x, p: {"x": (x.y - x.x**3 / 3 + x.x) / EPS, "y": p.a - x.x},
            states={"x": 0.0, "y": 0.0},
            parameters={"a": 0.0},
        )
    )
    parameter = [omega if q.name == "omega" else q.value for q in system.parameters]
    phase = omega * times + (omega * times[begin])
    guess = per.sampled(phase, motion, np.zeros((2001, 0)), parameter)
    free = {"omega": per.PhaseCondition()}
    branch = per.trace(system, "a", (0.0, 0.5), guess=guess, determined=free, control=FEW)
    assert len(branch) == 3
    assert 2 * np.pi / branch[0].orbit.omega == pytest.approx(period, rel=1e-11)


def test_what_nothing_holds_is_named() -> None:
    """Assert that two masses joined to each other alone have no first orbit, and that this is said."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    model = sym.Mass(x, 1.0) + sym.Mass(y, 2.0) + sym.Spring(x, 1.0, to=y) + sym.Damper(x, 0.1, to=y)
    free = sym.compile(model + sym.HarmonicForce(x, 1.0))
    few = per.ArclengthControl(max_newton=2000)
    branch = per.trace(free, "Omega", (0.5, 2.0), tol=per.Accuracy.DRAFT, control=few)
    assert branch.stop.reason is per.Reason.NO_START
    assert "; nothing holds x and y; nor was one found from" in branch.stop.detail


@pytest.mark.parametrize("method", [per.Collocation(), per.Shooting(), per.HarmonicBalance()])
def test_well_by_name(method: per.extend.Discretisation) -> None:
    """Assert that of two wells, -x + x^3, the orbit in the one named is found: about 1 or -1, mirrored."""
    system = forced(
        lambda x, p, wave: {"x": x.v, "v": -0.2 * x.v + x.x - x.x**3 + 0.05 * wave.cos}, Omega=0.6
    )
    left, right = (
        per.trace(system, "Omega", (0.6, 0.8), guess={"x": well}, method=method, control=FEW, tol=1e-8)
        for well in (-1.0, 1.0)
    )
    assert left[0].maximum["x"] < -0.9 and right[0].minimum["x"] > 0.9
    assert left[0].minimum["x"] == pytest.approx(-right[0].maximum["x"], rel=1e-8)
    returns(right, lambda x, v, wave: -0.2 * v + x - x**3 + 0.05 * wave)


def test_well_that_is_no_state_is_refused() -> None:
    """Assert that a guess by names takes states and unknowns with finite values alone."""
    system = forced(lambda x, p, wave: {"x": x.v, "v": -x.v - x.x + wave.cos}, Omega=0.6)
    for guess, said in (({"u": 1.0}, "guess has 'u'; it must be one of x, v"), ({"x": np.inf}, "finite")):
        with pytest.raises(ValueError, match=said):
            per.trace(system, "Omega", (0.6, 0.8), guess=guess)
