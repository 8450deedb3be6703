"""Period doublings, branches of doubled orbits, and branches that come back to their start."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from reference import squeeze
from support.kept import kept
from support.mathieu import Mathieu
from support.numpy_systems import Array, LinearOscillator
from support.surfaces import along
from support.traces import RPM, disc_system

import periodic as per
import symbolic as sym
from periodic.bifurcations import switching
from periodic.linear.unknowns import parameter_only
from periodic.orbit.mesh import EventNode
from periodic.system import index_of
from symbolic.integration.flow import Flow, Trajectory
from symbolic.motion.linear import modes
from symbolic.system.compiled import with_values

SCENE = "vitrea79-810N"


@pytest.mark.parametrize("q, a", [(1.0, 1.859108072514), (5.0, 1.858187541548)])
def test_mathieu(q: float, a: float) -> None:
    """Assert that a doubling of Mathieu's equation lies at its tabulated boundary a1(q), to ten digits."""
    Omega = 2 / math.sqrt(a)
    branch = per.trace(Mathieu(q / a), "Omega", (0.97 * Omega, 1.03 * Omega), tol=per.Accuracy.FINE)
    found = branch.labelled(per.Label.DOUBLING)
    assert [p.parameter for p in found] == [pytest.approx(Omega, rel=1e-10)]
    # Undamped, the pair meets at -1 in a double root: the multipliers are known to half the digits.
    assert found[0].multipliers == pytest.approx([-1, -1], abs=1e-4)
    assert not found[0].stable


@kept
def small_orbits() -> per.Branch:
    """The disc's small orbits, from above the 1:2 resonance down."""
    return per.trace(disc_system(SCENE), "speed", (480 * RPM, 640 * RPM), start=640 * RPM, at=[556 * RPM])


@cache
def simulated() -> Trajectory:
    """The motion at 500 rev/min once settled from a hard knock, over two excitation periods."""
    system, values = disc_system(SCENE), {"speed": 500 * RPM}
    rest, flow = modes(system, values), Flow(system, 1e-9)
    state, unknown = rest.state + [-1.0, -1.0, 0.0], rest.algebraic
    for _ in range(60):
        last = flow.run(state, unknown, with_values(system, values), np.linspace(0, 4 * np.pi, 801))
        state, unknown = last.state[-1], last.algebraic[-1]
    return last


@kept
def doubled_orbits() -> per.Branch:
    """The branch through that motion."""
    system, motion = disc_system(SCENE), simulated()
    parameter = with_values(system, {"speed": 500 * RPM})
    guess = per.sampled(motion.phase, motion.state, motion.algebraic, parameter)
    return per.trace(system, "speed", (400 * RPM, 640 * RPM), start=500 * RPM, guess=guess)


def speeds(points: tuple[per.Point, ...]) -> list[float]:
    """Speeds of points in rev/min."""
    return [p.parameter / RPM for p in points]


def test_small_orbits_double_twice() -> None:
    """Assert that the small orbits lose and regain stability by period doublings, and nowhere else."""
    branch = small_orbits()
    upper, lower = speeds(branch.labelled(per.Label.DOUBLING))
    assert (upper, lower) == (pytest.approx(569.96113, abs=1e-4), pytest.approx(545.39761, abs=1e-4))
    inside = (branch.values / RPM < upper) & (branch.values / RPM > lower)
    special = [p.label is per.Label.DOUBLING for p in branch]
    assert (branch.stable == ~(inside | special)).all()


def test_instability_by_shooting() -> None:
    """Assert that independent stiff shooting finds the same multiplier beyond -1 between the doublings."""
    period = squeeze.periodic_orbit(squeeze.Scene(speed_rpm=556.0))
    (point,) = [p for p in small_orbits().labelled(per.Label.USER)]
    assert point.multipliers[0].real < -1.04
    assert point.multipliers[0] == pytest.approx(period.multipliers[0], abs=1e-8)


def test_doubled_branch_closes() -> None:
    """Assert that the doubled orbits close on themselves: each fold is met twice, each doubling once."""
    branch = doubled_orbits()
    assert branch.stop.reason is per.Reason.CLOSED
    assert {p.orbit.periods for p in branch} == {2}
    folds = speeds(branch.labelled(per.Label.FOLD))
    assert folds == [pytest.approx(449.410772, abs=1e-5)] * 2
    assert branch[0].peak_to_peak("x") == pytest.approx(branch[-1].peak_to_peak("x"), rel=1e-10)


def test_doubled_branch_starts_at_the_doublings() -> None:
    """Assert that both branches meet at the same speeds, to the root of the tolerance."""
    here = sorted(speeds(small_orbits().labelled(per.Label.DOUBLING)))
    assert sorted(speeds(doubled_orbits().labelled(per.Label.BRANCH))) == pytest.approx(here, abs=1e-4)


def test_doubled_orbit_by_integration() -> None:
    """Assert that the orbit traced from a simulation is the simulated motion."""
    x = simulated().state[:, 0] * disc_system(SCENE).states[0].scale
    assert doubled_orbits()[0].peak_to_peak("x") == pytest.approx(np.ptp(x), rel=1e-6)


def test_values_replace_nominal_ones() -> None:
    """Assert that a trace with other values is the trace of a system with those values."""
    given = per.trace(LinearOscillator(), "Omega", (0.5, 0.9), values={"zeta": 0.1, "F": 2.0})
    built = per.trace(LinearOscillator(zeta=0.1, F=2.0), "Omega", (0.5, 0.9))
    assert given.values == pytest.approx(built.values, rel=1e-14)
    assert given.peak_to_peak("x") == pytest.approx(built.peak_to_peak("x"), rel=1e-12)


@pytest.mark.parametrize(
    "values, sentence",
    [
        ({"mass": 1.0}, "parameter is 'mass'; it must be one of Omega, zeta, F"),
        ({"F": math.nan}, "value of F is nan; it must be a finite number"),
        ({"F": "strong"}, "value of F is 'strong'; it must be a finite number"),
        ({"Omega": 0.7}, "values has 'Omega', which is continued in; give it as start"),
    ],
)
def test_refused_values(values: dict[str, Any], sentence: str) -> None:
    """Assert that values that make no sense are refused in one sentence."""
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        per.trace(LinearOscillator(), "Omega", (0.5, 0.9), values=values)


@pytest.mark.parametrize(
    "phase, rows, sentence",
    [
        (
            np.linspace(0, 3 * math.pi, 9),
            9,
            "the samples last 1.5 excitation periods; they must",
        ),
        (np.zeros(9), 9, "phases of the samples must be at least 4 rising numbers"),
        (
            np.linspace(0, 2 * math.pi, 9),
            8,
            "states and unknowns have shapes (8, 2) and (8, 0); each",
        ),
    ],
)
def test_refused_samples(phase: Array, rows: int, sentence: str) -> None:
    """Assert that samples that make no orbit are refused in one sentence."""
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}"):
        per.sampled(phase, np.zeros((rows, 2)), np.zeros((rows, 0)), np.zeros(3))


def test_doubled_orbits_from_the_doubling() -> None:
    """Assert that the doubled orbits reached from either doubling are those found by simulation."""
    system, expected = disc_system(SCENE), doubled_orbits()[0].peak_to_peak("x")
    upper, lower = small_orbits().labelled(per.Label.DOUBLING)
    for point in (upper, lower):
        guess = per.doubled(system, point.orbit, "speed")
        begin = float(guess.parameter[index_of(system, "speed")])
        branch = per.trace(system, "speed", (440 * RPM, begin), start=begin, guess=guess, at=[500 * RPM])
        sheets = [p.peak_to_peak("x") for p in branch.labelled(per.Label.USER)]
        assert min(abs(swing / expected - 1) for swing in sheets) < 1e-8


def escape() -> sym.CompiledSystem:
    """x'' + .1 x' + x - x^2 = F cos(.85 t)."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.F * wave.cos - 0.1 * x.v - x.x + x.x**2}

    names, values = {"x": 0.0, "v": 0.0}, {"F": 0.02, "Omega": 0.85}
    return sym.compile(sym.Equations(rates, names, values, frequency="Omega"))


def test_cascade() -> None:
    """Assert that doubled orbits double in turn, that their branch begins anew at its PD, and ends as BP.

    Where each begins the orbits of the branch before double, to 1e-6.
    """
    system = escape()
    orbit = per.trace(system, "F", (0.02, 0.2), watch=per.Watch(stop={"PD": 1}))[-1].orbit
    for periods in (2, 4):
        begun = float(orbit.parameters["F"])
        branch = per.trace(system, "F", (0.09, 0.12), guess=per.doubled(system, orbit, "F"))
        assert [p.parameter for p in branch.labelled("BP")] == [pytest.approx(begun, rel=1e-6)]
        assert {p.orbit.periods for p in branch} == {periods} and not branch.unaccounted
        orbit = branch.labelled("PD")[0].orbit
        again = per.trace(system, "F", (0.09, 0.12), guess=orbit)
        assert not again.unaccounted
        for branches in (branch, again):
            places = [p.parameter for p in branches.labelled("PD")]
            assert places == pytest.approx([orbit.parameters["F"]] * len(places), rel=1e-6)
    assert 0.1005 < begun < orbit.parameters["F"] < 0.1085


def test_doubled_direction_of_an_orbit_with_event_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it has the opposite sign in the second period, and moves no event node of either."""
    orbit = along(
        lambda tau: np.sin(tau)[:, None], [(EventNode(0, 1), 0.5), (EventNode(0, -1), 3.0)], intervals=8
    )
    once = replace(parameter_only(orbit, 0.0), nodes=orbit.nodes, stages=orbit.stages)
    asked: dict[str, Any] = {}

    def switched(system: Any, twice: Any, direction: Any, *others: Any) -> Any:
        asked.update(twice=twice, direction=direction, others=others)
        return twice

    monkeypatch.setattr(switching, "away", lambda system, orbit, sign, autonomous: once)
    monkeypatch.setattr(switching, "switched", switched)
    monkeypatch.setattr(switching, "as_read_by", lambda system, orbit: orbit)
    monkeypatch.setattr(switching, "open_phase", lambda system, values, parameter: "")
    switching.doubled(None, orbit, "Omega", distance=0.5)  # type: ignore[arg-type]
    twice, direction = asked["twice"], asked["direction"]
    assert direction.phases.tolist() == [0.0] * len(twice.phases) and len(twice.phases) == 4
    n = len(orbit.nodes) - 1
    assert direction.nodes[:n] == pytest.approx(orbit.nodes[:-1])
    assert direction.nodes[n:] == pytest.approx(-orbit.nodes)
    assert direction.stages[n:] == pytest.approx(-orbit.stages)
    assert direction.profile is direction.nodes and direction.parameters.tolist() == [0.0]
    assert asked["others"] == ("Omega", {}, 0.5)
