"""Shooting against collocation, closed forms and known answers: two methods that share no equation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
import pytest
from support.flows import AUTONOMOUS
from support.flows import feedback as numpy_feedback
from support.flows import van_der_pol as numpy_van_der_pol
from support.kept import kept
from support.numpy_systems import LinearOscillator
from support.traces import (
    DUFFING_A,
    FINE,
    RPM,
    disc,
    disc_system,
    duffing_system,
    fold_speeds,
    largest_multiplier,
    user_points,
)

import periodic as per
import symbolic as sym
from periodic.correction.newton import NewtonSettings, correct
from periodic.correction.outcome import Outcome
from periodic.orbit.construction import at_rest, transfer
from periodic.orbit.mesh import Mesh, uniform
from periodic.orbit.scheme import Array
from periodic.shooting import flow as shooting
from periodic.stability.product import multipliers
from periodic.system import index_of
from symbolic.equations.assembly import Assembly

DRAFT = per.Accuracy.DRAFT
DISC_FOLDS = [237.486585931, 252.035056984]
DUFFING_FOLDS = [2.211935317020, 1.438670145514]
SPEEDS = (450.0, 360.0, 300.0, 285.0)
PEAK_TO_PEAK = [1.615395e-6, 3.865414e-6, 11.964066e-6, 15.716579e-6]
"""Of x at SPEEDS in metres, by stiff integration at 1e-9 (see reference.squeeze)."""

LARGEST = {360.0: 0.965143, 300.0: 0.940676, 285.0: 0.691304}
FEW_STEPS = per.ArclengthControl(ds=0.5, ds_max=1.0)
AHEAD = 0.1
"""How far above each of SPEEDS its branch begins (rev/min)."""


def disc_scene() -> sym.CompiledSystem:
    """The wavy disc."""
    return disc_system("vitrea79-810N")


@dataclass(frozen=True)
class Autonomous(sym.Part):
    """omega x' = f(x, p) of one parameter p."""

    field: Callable[[list[ca.SX], ca.SX], list[ca.SX]]
    order: int
    name: str
    value: float

    def contribute(self, assembly: Assembly) -> None:
        """Add states, rows and the first state as output."""
        assembly.excite(assembly.parameter(1.0, "omega", "rad/s"))
        p = assembly.parameter(self.value, self.name)
        states = [assembly.state(f"x{k + 1}", "", 1.0, ca.SX(0)) for k in range(self.order)]
        for state, rate in zip(states, self.field([x.symbol for x in states], p), strict=True):
            assembly.differential_rows.append(assembly.omega * state.derivative - rate)
        assembly.output("x", "", states[0].symbol)


VAN_DER_POL = Autonomous(lambda x, mu: [x[1], mu * (1 - x[0] ** 2) * x[1] - x[0]], 2, "mu", 1.0)
FEEDBACK = Autonomous(lambda x, alpha: [x[1], x[2], -alpha * x[2] - x[1] - x[0] + x[0] ** 2], 3, "alpha", 0.7)
EXPLOSION = Autonomous(lambda x, p: [1 + p * x[0] ** 2], 1, "p", 100.0)
"""Without any orbit: its solutions end within a period."""


@cache
def linear_system() -> sym.CompiledSystem:
    """x'' + 0.1 x' + x = cos(0.8 t)."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Damper(x, 0.1), sym.Spring(x, 1.0), sym.HarmonicForce(x, 1.0, 0.8)]
    return sym.compile(sym.combine(parts))


@kept
def by_collocation() -> per.Branch:
    """The disc's branch with its two folds, with points at SPEEDS and a little above."""
    return disc(rpm=(500.0, 235.0), at=(*SPEEDS, *(v + AHEAD for v in SPEEDS)))


def collocated(speed: float) -> list[per.Point]:
    """Its points at a speed in rev/min, in order along it."""
    return user_points(by_collocation(), speed * RPM)


def shot(guess: per.Orbit, rpm: tuple[float, float], method: per.extend.Discretisation) -> per.Branch:
    """The disc's branch from an orbit at one of two speeds in rev/min to the other, in few steps."""
    bounds = (rpm[0] * RPM, rpm[1] * RPM)
    return per.trace(disc_scene(), "speed", bounds, guess=guess, method=method, control=FEW_STEPS)


@kept
def disc_by_shooting(segments: int) -> list[per.Point]:
    """The disc's orbits at SPEEDS, each at the end of a short branch from an orbit of collocation."""
    method = per.Shooting(segments=segments)
    guesses = [collocated(speed + AHEAD)[0].orbit for speed in SPEEDS]
    return [shot(guess, (v, v + AHEAD), method)[-1] for v, guess in zip(SPEEDS, guesses, strict=True)]


@pytest.mark.parametrize("segments", [1, 3])
def test_linear_oscillator(segments: int) -> None:
    """Assert that orbit and multipliers of the linear oscillator are those of the closed form."""
    exact = LinearOscillator(Omega=0.8)
    branch = per.trace(
        linear_system(), "Omega", (0.7, 0.8), start=0.8, tol=FINE, method=per.Shooting(segments=segments)
    )
    point = branch[0]
    assert point.parameter == 0.8
    assert branch.stop.reason is per.Reason.BOUND
    tau = np.linspace(0, 2 * np.pi, 50)
    assert point.orbit.state(tau) == pytest.approx(exact.exact_state(tau), abs=3e-9)
    multipliers = point.multipliers[np.argsort(-point.multipliers.imag)]
    assert multipliers == pytest.approx(exact.exact_multipliers(), abs=1e-9)
    # Liouville: x'' + 0.1 x' + ... loses area at the rate 0.1.
    assert np.prod(point.multipliers).real == pytest.approx(np.exp(-0.1 * 2 * np.pi / 0.8), rel=1e-9)


@pytest.mark.parametrize("segments", [1, 4])
def test_duffing_folds(segments: int) -> None:
    """Assert the folds of problem A, by one segment and by several."""
    method = per.Shooting(segments, tolerance=1e-11)
    branch = per.trace(duffing_system(*DUFFING_A), "Omega", (1.3, 2.4), method=method, tol=DRAFT)
    folds = branch.labelled(per.Label.FOLD)
    assert [p.parameter for p in folds] == pytest.approx(DUFFING_FOLDS, rel=1e-8)
    assert all(abs(p.multipliers[0] - 1) < 1e-4 for p in folds)
    assert branch.special_points == (branch[0], *folds, branch[-1])


@pytest.mark.parametrize("segments", [1, 4])
def test_disc(segments: int) -> None:
    """Assert that both methods find the same orbits and multipliers of the disc, which has an unknown."""
    points = disc_by_shooting(segments)
    assert [p.parameter for p in points] == [v * RPM for v in SPEEDS]
    assert [p.peak_to_peak("x") for p in points] == pytest.approx(PEAK_TO_PEAK, rel=5e-7)
    for speed, point in zip(SPEEDS, points, strict=True):
        (other,) = collocated(speed)
        assert point.multipliers == pytest.approx(other.multipliers, abs=1e-8)
        assert point.peak_to_peak("x") == pytest.approx(other.peak_to_peak("x"), rel=1e-7)
        assert point.maximum["load"] == pytest.approx(other.maximum["load"], rel=1e-7)
        if speed in LARGEST:
            assert largest_multiplier(point) == pytest.approx(LARGEST[speed], abs=5e-7)


@pytest.mark.long
def test_folds_of_the_disc() -> None:
    """Assert both folds of the disc by shooting alone, through contact lost over dozens of powers of ten.

    Shooting's orbits do not depend on the mesh that interpolates them: a coarse one will do.
    """
    method, bounds = per.Shooting(tolerance=1e-11), (235 * RPM, 300 * RPM)
    branch = per.trace(disc_scene(), "speed", bounds, start=300 * RPM, method=method, tol=DRAFT)
    assert branch.stop.reason is per.Reason.BOUND
    assert fold_speeds(branch) == pytest.approx(DISC_FOLDS, rel=1e-8)
    assert fold_speeds(branch) == pytest.approx(fold_speeds(by_collocation()), rel=1e-8)


def test_autonomous() -> None:
    """Assert van der Pol's period, its trivial multiplier and Liouville's product."""
    guess = numpy_van_der_pol(1.0).simulated([2.0, 0.0], 100.0, crossing=0)
    branch = per.trace(
        sym.compile(VAN_DER_POL),
        "mu",
        (1.0, 1.2),
        guess=guess,
        determined=AUTONOMOUS,
        tol=FINE,
        method=per.Shooting(segments=2),
    )
    point = branch[0]
    assert branch.stop.reason is per.Reason.BOUND
    omega = point.orbit.parameter[0]
    assert 2 * np.pi / omega == pytest.approx(6.6632868593, rel=2e-11)
    assert point.trivial == pytest.approx(0, abs=1e-9)
    tau = np.linspace(0, 2 * np.pi, 20001)[:-1]
    trace = 1 - point.orbit.state(tau)[:, 0] ** 2
    product = np.exp(trace.mean() * 2 * np.pi / omega)
    assert np.prod(np.abs(point.multipliers)) == pytest.approx(product, rel=1e-8)


def test_doubling_of_an_autonomous_orbit() -> None:
    """Assert the doubling of the feedback control system, and the doubled orbits that begin there."""
    method, system = per.Shooting(), sym.compile(FEEDBACK)
    guess = numpy_feedback(0.65).simulated([0.3, 0.0, 0.0], 1000.0, crossing=0)
    branch = per.trace(system, "alpha", (0.61, 0.65), guess=guess, determined=AUTONOMOUS, method=method)
    (doubling,) = branch.labelled(per.Label.DOUBLING)
    assert doubling.parameter == pytest.approx(0.630302006160, rel=1e-9)
    assert 2 * np.pi / doubling.orbit.parameter[0] == pytest.approx(6.364071339441, rel=1e-9)
    twice = per.doubled(system, doubling.orbit, "alpha", determined=AUTONOMOUS)
    begin = float(twice.parameter[1])
    later = per.trace(system, "alpha", (0.62, begin), guess=twice, determined=AUTONOMOUS, method=method)
    assert later.stop.reason is per.Reason.BOUND
    assert {p.orbit.periods for p in later} == {2}
    assert later[0].stable


def test_methods_take_over_from_each_other(tmp_path: Path) -> None:
    """Assert that collocation goes on from an orbit of shooting, and that the orbit is the same from disk."""
    point = disc_by_shooting(1)[-1]
    onward = shot(point.orbit, (285.0, 285.2), per.Collocation())
    assert onward[0].multipliers == pytest.approx(point.multipliers, abs=1e-8)
    assert len(onward[0].orbit.phases) > 0
    branch = shot(point.orbit, (285.0, 285.2), per.Shooting(segments=2))
    branch.save(tmp_path / "branch.nc")
    again = per.Branch.load(tmp_path / "branch.nc")[0].orbit
    tau = np.linspace(0, 2 * np.pi, 100)
    assert (again.state(tau) == branch[0].orbit.state(tau)).all()


@pytest.mark.parametrize("scheme", [per.Scheme(per.Family.RADAU, 3), per.Scheme(per.Family.GAUSS, 3)])
def test_sensitivities(scheme: per.Scheme) -> None:
    """Assert that the maps of a segment are the flow's derivatives, states and unknowns, by differences."""
    orbit, speed = small_orbit(scheme), index_of(disc_scene(), "speed")
    n, step = orbit.nodes.shape[1], 1e-5

    def flowed(direction: Array, size: float) -> per.Orbit:
        nodes, parameter = orbit.nodes.copy(), orbit.parameter.copy()
        nodes[shooting.starts(8, 2)] += size * direction[:n]
        parameter[speed] *= 1 + size * direction[n]
        moved = replace(orbit, nodes=nodes, parameter=parameter)
        return shooting.segment_maps(disc_scene(), moved, (), 2, 1e-13).orbit

    maps = shooting.segment_maps(disc_scene(), orbit, (speed,), 2, 1e-13)
    for direction in np.eye(n + 1):
        low, high = flowed(direction, -step), flowed(direction, step)
        outer = orbit.parameter[[speed]] * direction[n:]
        stages, algebraic = maps.recover(np.tile(direction[:n], (9, 1)), outer, 0.0)
        assert stages == pytest.approx((high.stages - low.stages) / (2 * step), abs=2e-7)
        assert algebraic == pytest.approx((high.algebraic - low.algebraic) / (2 * step), abs=2e-7)


@pytest.mark.parametrize("segments", [1, 3])
def test_closures_in_stages_and_unknowns(segments: int) -> None:
    """Assert that a closure in the load, a function of unknowns, determines the speed as in collocation."""
    orbit, free = small_orbit(per.Scheme(ncol=5), 24), (index_of(disc_scene(), "speed"),)
    load = per.Amplitude("load")
    level = per.Level(load, load(disc_scene(), orbit) * 1.001).at(orbit, per.Given(free[0]))
    methods = (per.Collocation(), per.Shooting(segments=segments))
    settings = NewtonSettings(tolerance=1e-7)
    found = [correct(m.linearise, disc_scene(), orbit, free, [level], settings) for m in methods]
    assert all(f.outcome is Outcome.CONVERGED and f.iterations <= 5 for f in found)
    assert abs(level.linearise(disc_scene(), found[1].orbit, free).value) < 1e-7 * load(disc_scene(), orbit)
    collocated, shot = (f.orbit.parameter[free[0]] for f in found)
    assert abs(shot / orbit.parameter[free[0]] - 1) > 1e-5
    assert shot == pytest.approx(collocated, rel=1e-8)


def small_orbit(scheme: per.Scheme, ntst: int = 8) -> per.Orbit:
    """The disc's orbit at 360 rev/min on a mesh of equal intervals."""
    (point,) = collocated(360.0)
    return transfer(point.orbit, uniform(scheme, ntst), np.zeros(0))


@pytest.mark.parametrize("place", [1e-13, 1 - 1e-13])
def test_breaks_beside_the_ends_of_the_period(place: float) -> None:
    """Assert that a break of another mesh that is within rounding of an end is that end."""
    system, breaks = duffing_system(*DUFFING_A), np.sort([0.0, place, 0.4, 1.0])
    near = at_rest(system, Mesh(per.Scheme(), (breaks,), (), 2 * np.pi), system.nominal)
    found = per.Shooting().guess(system, system.nominal, near)
    assert found.mesh.breaks[0] == pytest.approx([0.0, 0.4, 1.0], abs=1e-15)


def test_unknowns_a_million_times_as_large_as_states() -> None:
    """Assert that their rounding does not keep shooting from its start: as collocation to 1e-8."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        force = 1e6 * (x.x + 0.1 * x.x**3)
        return {"x": x.v, "v": wave.cos - 0.2 * x.v - x.force / 1e6, "force": x.force - force}

    given = sym.Equations(
        rates, {"x": 1.0, "v": 0.0}, {"Omega": 0.7}, unknowns={"force": 1.0}, frequency="Omega"
    )
    system, found = sym.compile(given), []
    for method in (per.Collocation(), per.Shooting()):
        branch = per.trace(system, "Omega", (0.7, 0.71), method=method, tol=1e-8, control=FEW_STEPS)
        found.append([branch[0].peak_to_peak("x"), *branch[0].multipliers])
    assert found[1] == pytest.approx(found[0], rel=1e-8)


def test_failed_integration_is_named() -> None:
    """Assert that a system whose solutions end within a period has no start, for the reason given."""
    branch = per.trace(sym.compile(EXPLOSION), "omega", (1.0, 2.0), method=per.Shooting())
    assert branch.stop.reason is per.Reason.NO_START
    tried, remedy = branch.stop.detail.split(" (CVODES and LSODA both failed at tau = ")
    assert tried == (
        f"{Outcome.NOT_INTEGRATED.value}; nor was one found from other values of omega, "
        "a simulation left to settle"
    )
    assert remedy.endswith("); guess=per.sampled(...) takes a motion from a simulation")
    assert len(branch) == 0


def test_bad_input() -> None:
    """Assert that a system without flow and settings out of range are refused in one sentence."""
    with pytest.raises(ValueError, match="^system is a LinearOscillator without flow, which shooting needs"):
        per.trace(LinearOscillator(), "Omega", (0.7, 0.8), method=per.Shooting())
    with pytest.raises(ValueError, match="^segments is 0; it must be a whole number of at least 1$"):
        per.Shooting(segments=0)
    with pytest.raises(ValueError, match="^tolerance is 1.0; it must lie between 1e-12 and 0.01$"):
        per.Shooting(tolerance=1.0)
    with pytest.raises(ValueError, match="^tolerance of Shooting is 1e-09; for orbits to 1e-07 it"):
        per.trace(linear_system(), "Omega", (0.7, 0.8), tol=1e-7, method=per.Shooting(tolerance=1e-9))


def test_segments_carry_what_grows_by_many_decades() -> None:
    """Assert orbit and both multipliers, e**63 and e**-63, beside collocation."""
    system = sym.compile(
        sym.Equations(
            lambda x, p, w: {"x": x.v, "v": 100 * x.x - 0.1 * x.x**3 + w.cos},
            {"x": 0.0, "v": 0.0},
            {"W": 1.0},
            frequency="W",
        )
    )
    expected = per.trace(system, "W", (1.0, 1.05))[0]
    for segments in (8, 20):
        branch = per.trace(system, "W", (1.0, 1.05), method=per.Shooting(segments=segments))
        assert "bound reached" in str(branch.stop)
        assert branch[0].maximum["x"] == pytest.approx(expected.maximum["x"], rel=1e-9)
        large, least = np.abs(branch[0].multipliers)
        assert large == pytest.approx(np.abs(expected.multipliers[0]), rel=1e-6)
        assert large * least == pytest.approx(1.0, rel=1e-6)


def test_multipliers_that_steps_do_not_carry() -> None:
    """Assert that a multiplier is 0 of which an error of the steps leaves nothing, and kept where it does."""
    steps = np.array([np.diag([1e7, 1e-7]), np.diag([10.0, 0.1])])
    assert multipliers(steps, 1e-15) == pytest.approx([1e8, 1e-8])
    assert multipliers(steps, 1e-12) == pytest.approx([1e8, 0.0])
