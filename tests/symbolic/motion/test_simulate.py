"""Simulation: from rest or another motion to a settled one, and what is read from it."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from symbolic import meter
from symbolic.integration import field, flow
from symbolic.integration.cvodes import Cvodes

RPM = 2 * np.pi / 60


X = sym.coordinate("x")
PARTS = [sym.Mass(X, 1.0), sym.Damper(X, 0.2), sym.Spring(X, 1.0), sym.HarmonicForce(X, 0.5)]


def oscillator() -> sym.CompiledSystem:
    """x'' + 0.2 x' + x = 0.5 cos Omega t, x in units of 0.1 m inside."""
    x = sym.coordinate("x", scale=0.1)
    return sym.compile(sym.Mass(x, 1.0) + sym.Damper(x, 0.2) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 0.5))


def test_settles_to_the_linear_response() -> None:
    """Assert displacement and velocity of a linear oscillator over time, in SI."""
    system = oscillator()
    motion = sym.simulate(system, {"Omega": 0.8}, settle=40, samples=50, tolerance=1e-11)
    amplitude = 0.5 / (1 - 0.8**2 + 0.2j * 0.8)
    exact = (amplitude * np.exp(1j * motion.phase)).real
    assert motion["x"] == pytest.approx(exact, abs=1e-9)
    assert motion["x'"] == pytest.approx((0.8j * amplitude * np.exp(0.8j * motion.time)).real, abs=1e-9)
    assert motion.phase[[0, -1]] == pytest.approx([0, 2 * np.pi])
    assert dict(zip([p.name for p in system.parameters], motion.parameter, strict=True))["Omega"] == 0.8


def test_knock_and_start() -> None:
    """Assert that a knock is in SI, and that a second simulation goes on where the first ended."""
    system = oscillator()
    knock = {"x": 0.3, "x'": -0.2}
    first = sym.simulate(system, {"F": 0.0, "Omega": 0.7}, knock=knock, settle=0, periods=2, samples=10)
    assert (first["x"][0], first["x'"][0]) == pytest.approx((0.3, -0.2))
    second = sym.simulate(system, {"F": 0.0, "Omega": 0.7}, start=first, settle=0, samples=10)
    whole = sym.simulate(system, {"F": 0.0, "Omega": 0.7}, knock=knock, settle=0, periods=3, samples=10)
    assert second["x"] == pytest.approx(whole["x"][20:], abs=1e-6)


def test_start_by_name() -> None:
    """Assert that states are taken in SI, x' as dx/dt, others as where the search for a rest begins."""
    system = oscillator()
    one = sym.simulate(system, {"F": 0.0, "Omega": 0.7}, start={"x": 0.3, "x'": -0.2}, settle=0, samples=10)
    other = sym.simulate(system, {"F": 0.0, "Omega": 0.7}, knock={"x": 0.3, "x'": -0.2}, settle=0, samples=10)
    assert (one["x"][0], one["x'"][0]) == pytest.approx((0.3, -0.2))
    assert one["x"] == pytest.approx(other["x"], abs=1e-12)
    x, y = sym.coordinate("x", start=0.25), sym.coordinate("y")
    parts = [part for q in (x, y) for part in (sym.Mass(q, 1.0), sym.Spring(q, 1.0))]
    both = sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 0.5)]))
    motion = sym.simulate(both, start={"y'": 1.0}, settle=0, samples=3)
    assert [motion[name][0] for name in ("x", "x'", "y", "y'")] == pytest.approx([0.25, 0.0, 0.0, 1.0])


def test_start_where_there_is_no_rest() -> None:
    """Assert that a mass that nothing holds falls from where it is said to be: x = x0 + v t - t^2/2 here."""
    x = sym.coordinate("x")
    model = sym.Mass(x, 1.0) + sym.ConstantForce(x, -1.0) + sym.HarmonicForce(x, 0.0)
    system = sym.compile(model)
    with pytest.raises(sym.NoRestError):
        sym.simulate(system, settle=0)
    motion = sym.simulate(system, start={"x": 2.0, "x'": 3.0}, settle=0, samples=20)
    t = motion.time
    assert motion["x"] == pytest.approx(2 + 3 * t - t**2 / 2, abs=1e-6)


def test_outputs_and_branch_of_a_disc() -> None:
    """Assert that a disc knocked hard settles to a motion of two periods, whose load balances the preload."""
    disc = sym.scene("vitrea79-810N")
    knock = {"x": -1e-5, "x'": -0.06}
    motion = sym.simulate(disc, {"speed": 500 * RPM}, knock=knock, settle=120, periods=2)
    assert np.trapezoid(motion["load"], motion.phase) / (4 * np.pi) == pytest.approx(810, rel=1e-4)
    guess = per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter)
    branch = per.trace(disc, "speed", (499 * RPM, 500 * RPM), start=500 * RPM, guess=guess)
    assert branch.peak_to_peak("x")[0] == pytest.approx(np.ptp(motion["x"]), rel=1e-3)
    half = len(motion.phase) // 2
    assert np.abs(motion["x"][:half] - motion["x"][half:-1]).max() > 0.1 * np.ptp(motion["x"])


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"knock": {"y": 1.0}}, "knock has 'y'; it must be one of x, x'"),
        ({"values": {"omega": 1.0}}, "parameter is 'omega'; it must be one of m, c, k, F, Omega"),
        ({"periods": 0}, "periods is 0; it must be a whole number of at least 1"),
        ({"settle": -1}, "settle is -1; it must be a whole number of at least 0"),
        ({"periods": np.nan}, "periods is nan; it must be a whole number of at least 1"),
        ({"settle": "a"}, "settle is 'a'; it must be a whole number of at least 0"),
        ({"settle": 1.5}, "settle is 1.5; it must be a whole number of at least 0"),
        ({"samples": 2.5}, "samples is 2.5; it must be a whole number of at least 3"),
        ({"samples": True}, "samples is True; it must be a whole number of at least 3"),
        ({"values": 3}, "values is 3; it must be a mapping of names to numbers"),
        ({"values": {"k": np.nan}}, "value of k is nan; it must be a finite number"),
        (
            {"values": {"Omega": -1}},
            "the frequency of the excitation in rad/s is -1.0; it must be greater than 0",
        ),
        ({"knock": 3}, "knock is 3; it must be a mapping of names to numbers"),
        ({"knock": {"x": np.nan}}, "knock of x is nan; it must be a finite number"),
        (
            {"start": 3},
            "start is 3; it must be a Simulation, as symbolic.simulate returns it, or states by name",
        ),
        ({"start": {"y": 1.0}}, "start has 'y'; it must be one of x, x'"),
        ({"start": {"x": np.inf}}, "start of x is inf; it must be a finite number"),
        ({"tolerance": "a"}, "tolerance is 'a'; it must be a finite number"),
        ({"tolerance": 1.0}, "tolerance is 1.0; it must lie between 1e-13 and 0.01"),
    ],
)
def test_refused(wrong: dict, said: str) -> None:
    """Assert that what cannot be is refused in one sentence."""
    with pytest.raises(ValueError, match=f"^{said}$"):
        sym.simulate(oscillator(), **wrong)


def test_start_of_another_system() -> None:
    """Assert that the motion of a system with other variables is no start."""
    other = sym.simulate(sym.scene("vitrea79-810N"), settle=0, samples=3)
    with pytest.raises(ValueError, match="^start is a motion of x, x', h, xi; it must be one of x, x'$"):
        sym.simulate(oscillator(), start=other)


def test_start_in_other_scales() -> None:
    """Assert that a start is taken in SI, whatever the scales inside."""
    first = sym.simulate(oscillator(), settle=3, samples=5)
    x = sym.coordinate("x", scale=0.7)
    parts = [sym.Mass(x, 1.0), sym.Damper(x, 0.2), sym.Spring(x, 1.0), sym.HarmonicForce(x, 0.5)]
    second = sym.simulate(sym.compile(sym.combine(parts)), start=first, settle=0, samples=5)
    assert second["x"][0] == pytest.approx(first["x"][-1], rel=1e-12)


@pytest.mark.parametrize("knock", [1e100, 1e300])
def test_motion_that_cannot_be_followed(knock: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that an absurd motion ends with how far it was followed, not after ever more work."""
    monkeypatch.setattr("symbolic.integration.lsoda.EVALUATIONS", 1000)
    hard = sym.compile(sym.combine([*PARTS, sym.CubicSpring(X, 1.0)]))
    with pytest.raises(sym.IntegrationError, match="^the motion could not be followed past .* s; CVODES and"):
        sym.simulate(hard, knock={"x": knock})


def test_lsoda_takes_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that where CVODES gives up LSODA goes on, as accurate, and there only."""
    run, followed = Cvodes.run, field.followed
    asked, by_lsoda = itertools.count(), []

    def gives_up(*arguments: Any) -> Any:
        return None if next(asked) in (3, 4, 8) else run(*arguments)

    def noted(*arguments: Any) -> Any:
        by_lsoda.append(arguments[3][-1])
        return followed(*arguments)

    system = sym.compile(sym.combine([*PARTS, sym.CubicSpring(X, 3.0)]))
    settings: dict[str, Any] = {"settle": 8, "samples": 50, "tolerance": 1e-12}
    whole = sym.simulate(system, **settings)
    monkeypatch.setattr(Cvodes, "run", gives_up)
    monkeypatch.setattr(field, "followed", noted)
    motion = sym.simulate(system, **settings)
    assert by_lsoda == [2 * np.pi] * 3
    for name in ("x", "x'"):
        assert motion[name] == pytest.approx(whole[name], abs=1e-8)


def test_unknown_quantity() -> None:
    """Assert that a name that is none lists those that there are."""
    motion = sym.simulate(oscillator(), settle=0, samples=5)
    with pytest.raises(KeyError, match="the simulation has no 'y'; it has x, x'"):
        motion["y"]


def test_interrupted_simulation_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that Ctrl-C leaves what the next call goes on from, to the motion that was to be found."""
    system, runs = oscillator(), itertools.count()
    whole = sym.simulate(system, settle=7)
    original = flow.Flow.run

    def run(self: flow.Flow, *args: Any, **kwargs: Any) -> flow.Trajectory:
        if next(runs) == 4:
            raise KeyboardInterrupt
        return original(self, *args, **kwargs)

    with monkeypatch.context() as patch:
        patch.setattr(flow.Flow, "run", run)
        with pytest.raises(sym.SimulationInterrupted, match="after 4 periods") as caught:
            sym.simulate(system, settle=7)
    again = sym.simulate(system, start=caught.value.motion, settle=3)
    assert again["x"] == pytest.approx(whole["x"], abs=1e-7)


def test_progress_of_a_simulation(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert a bar where somebody looks on, and none elsewhere."""
    sym.simulate(oscillator(), settle=5)
    assert capsys.readouterr().err == ""
    monkeypatch.setenv(meter.VARIABLE, "1")
    monkeypatch.setattr(meter, "DELAY", 0.0)
    sym.simulate(oscillator(), settle=5)
    assert "settling" in capsys.readouterr().err


@pytest.mark.parametrize("settle", [0, 3])
def test_time_at_which_a_motion_is_lost(settle: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert (2 pi done + phase) / omega, the periods done and the phase in the one that was not."""
    run, asked = flow.Flow.run, itertools.count()

    def lost(self: Any, *arguments: Any) -> Any:
        if next(asked) == settle:
            raise sym.IntegrationError("it is lost", phase=1.5)
        return run(self, *arguments)

    monkeypatch.setattr(flow.Flow, "run", lost)
    time = (2 * np.pi * settle + 1.5) / 0.5
    with pytest.raises(
        sym.IntegrationError, match=f"^the motion could not be followed past {time:.6g} s; it is lost"
    ):
        sym.simulate(oscillator(), {"Omega": 0.5}, settle=settle, samples=5)
