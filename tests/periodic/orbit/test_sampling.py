"""Simulated motions given by name, in SI and at times, as a start of a branch."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from support.traces import RPM, disc, disc_system, duffing_system

import periodic as per
import symbolic as sym

DUFFING = duffing_system(0.1, 1.0, 0.5)
T = np.linspace(0, 2 * math.pi / 2.0, 201)
SAMPLES: dict[str, Any] = {
    "times": T,
    "state": {"x": np.cos(2 * T), "x'": -2 * np.sin(2 * T)},
    "parameter": {"Omega": 2.0},
    "system": DUFFING,
}


def test_samples_by_name_are_those_of_the_orbit() -> None:
    """Assert that positions and velocities at times come back as they were given."""
    orbit = per.sampled(**SAMPLES)
    assert orbit.parameters["Omega"] == 2.0 and orbit.parameters["F"] == 0.5
    assert orbit.period == pytest.approx(math.pi)
    for name, values in SAMPLES["state"].items():
        assert orbit[name](T) == pytest.approx(values, abs=1e-3)


def test_samples_by_name_and_as_arrays_agree() -> None:
    """Assert that scaled arrays over phases give the same orbit."""
    x = np.stack([np.cos(2 * T), -np.sin(2 * T)], axis=1)
    values = DUFFING.nominal.copy()
    values[[p.name for p in DUFFING.parameters].index("Omega")] = 2.0
    orbit, other = per.sampled(**SAMPLES), per.sampled(2 * T, x, np.zeros((len(T), 0)), values)
    assert (
        other.stages == pytest.approx(orbit.stages) and other.parameter.tolist() == orbit.parameter.tolist()
    )


def test_a_disc_by_name_with_unknowns_left_to_the_system() -> None:
    """Assert that an orbit read by name is a guess for the branch that it lies on."""
    point = disc(rpm=(290.0, 270.0), accuracy=per.Accuracy.DRAFT)[0]
    orbit, system = point.orbit, disc_system("vitrea79-810N")
    t = np.linspace(0, orbit.period, 400)
    states = {name: orbit[name](t) for name in ("x", "x'", "h")}
    guess = per.sampled(times=t, state=states, parameter=orbit.parameters, system=system)
    draft = per.Accuracy.DRAFT
    branch = per.trace(system, "speed", (290 * RPM, 289 * RPM), guess=guess, tol=draft)
    assert branch[0].peak_to_peak("x") == pytest.approx(point.peak_to_peak("x"), rel=1e-4)


def test_an_autonomous_orbit_in_time() -> None:
    """Assert that a limit cycle from samples at times has the period that its omega says."""
    mu, period = 0.1, 2 * math.pi
    system = sym.compile(
        sym.Equations(
            states={"u": 0.0, "v": 0.0},
            parameters={"mu": sym.parameter("mu", mu)},
            function=lambda x, p: {"u": x.v, "v": p.mu * (1 - x.u**2) * x.v - x.u},
        )
    )
    t = np.linspace(0, period, 201)
    state = {"u": 2 * np.cos(t), "v": -2 * np.sin(t)}
    guess = per.sampled(times=t, state=state, parameter={"omega": 1.0}, system=system)
    branch = per.trace(system, "mu", (mu, 1.0), guess=guess, determined={"omega": per.PhaseCondition()})
    for point in branch:
        orbit = point.orbit
        assert orbit.period == pytest.approx(2 * math.pi / orbit.parameters["omega"])
        t = np.linspace(0, orbit.period, 9)
        assert orbit["u'"](t) == pytest.approx(orbit["v"](t), abs=1e-4)
    assert branch[-1].orbit.period == pytest.approx(6.6632868593, rel=1e-9)  # van der Pol at mu = 1


REFUSED = {
    "no samples": (
        {"times": None},
        "phase and times are both given or both missing; just one of them must be",
    ),
    "no system": (
        {"system": None},
        "samples by name and times are those of a system; it must be given, system=",
    ),
    "other state": ({"state": {"x": T, "y": T}}, "state has x, y; it must have x, x'"),
    "lengths": (
        {"state": {"x": T, "x'": T[1:]}},
        "state has columns of different lengths; each must have one",
    ),
    "other parameter": ({"parameter": {"speed": 1.0}}, "parameter is 'speed'; it must be one of "),
    "no frequency": ({"parameter": {"Omega": 0.0}}, "frequency Omega is 0.0; it must be positive"),
    "unknowns": ({"algebraic": {"w": T}}, "algebraic has w; it must have none"),
}


@pytest.mark.parametrize("name", list(REFUSED))
def test_refused_samples_by_name(name: str) -> None:
    """Assert that names, times and lengths that make no sense are refused in one sentence."""
    change, told = REFUSED[name]
    with pytest.raises(ValueError, match=f"^{re.escape(told)}"):
        per.sampled(**{**SAMPLES, **change})


def test_samples_with_two_impacts() -> None:
    """Assert a motion that bounces twice in the samples, which begin between the impacts."""
    q, impacts = sym.coordinate("q", start=-1.0), (0.5, 0.5 + math.pi)
    system = sym.compile(
        sym.Model(
            [
                sym.Mass(q, 1.0),
                sym.Spring(q, 1.0),
                sym.RigidStop(q, 0.0, 1.0),
                sym.HarmonicForce(q, 0.1, sym.parameter("Omega", 1.0, "rad/s")),
            ]
        )
    )
    t = np.concatenate(
        [np.linspace(a, b, 40) for a, b in zip((0.0, *impacts), (*impacts, 2 * math.pi), strict=True)]
    )
    way = np.repeat([1.0, -1.0, 1.0], 40)
    state = np.stack([way * np.sin(t - 0.5), way * np.cos(t - 0.5)], axis=1)
    orbit = per.sampled(t, state, system=system, parameter=system.nominal)
    assert orbit.phases == pytest.approx(impacts)
    seen = np.linspace(0.1, 6.2, 30)
    assert orbit["q"](seen) == pytest.approx(-np.abs(np.sin(seen - 0.5)), abs=1e-3)
