"""Orbits read by name in SI units, and by equal systems that were built with other scales."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.kept import kept
from support.numpy_systems import LinearOscillator
from support.traces import RPM, disc, duffing, duffing_system

import periodic as per
import symbolic as sym
from periodic.orbit.layout import layout_of
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

SCENE = "vitrea79-810N"
METHODS = {
    "collocation": per.Collocation(),
    "shooting": per.Shooting(),
    "harmonic balance": per.HarmonicBalance(),
}


@cache
def loaded(preload: float) -> sym.CompiledSystem:
    """The disc built at another preload: its lengths are in units of another deflection."""
    return build(load(SCENE, [("contact.preload", str(preload))]))


@kept
def traced(preload: float) -> per.Branch:
    """A short stretch of its branch."""
    return per.trace(loaded(preload), "speed", (300 * RPM, 280 * RPM), tol=per.Accuracy.DRAFT)


@pytest.mark.parametrize("which", ["duffing", "disc"])
def test_velocities_are_derivatives_in_time(which: str) -> None:
    """Assert that x' is dx/dt in m/s and x'' its derivative, where the state x' is dx/dtau."""
    orbit = {"duffing": duffing, "disc": disc}[which]()[12].orbit
    t = np.linspace(0.0, orbit.period, 40)
    step = 1e-6 * orbit.period
    for name, unit in (("x", "m/s"), ("x'", "m/s^2")):
        slope = (orbit[name](t + step) - orbit[name](t - step)) / (2 * step)
        found = orbit[f"{name}'"]
        assert found.unit == unit
        assert found(t) == pytest.approx(slope, abs=2e-3 * np.abs(slope).max())


def test_positions_are_the_outputs() -> None:
    """Assert that a state read at times in s is the output of that name at tau = Omega t."""
    point, system = disc()[12], loaded(810)
    t = np.linspace(0.0, point.orbit.period, 50).reshape(5, 10)
    omega = 120 * point.parameter
    expected = per.outputs(system, point.orbit, omega * t.ravel())[:, 0]
    x = point.orbit["x"]
    assert x(t).shape == t.shape and x.unit == "m" and x.name == "x"
    assert x(t).ravel() == pytest.approx(expected, rel=1e-12)
    assert float(x(0.0)) == pytest.approx(expected[0])
    assert point.orbit.period == pytest.approx(2 * math.pi / omega)
    assert point.orbit.omega == pytest.approx(omega)


def test_names_and_parameters() -> None:
    """Assert that an orbit tells its states, unknowns and parameters, and refuses other names."""
    orbit = disc()[0].orbit
    assert orbit.names[:3] == ("x", "x'", "h") and len(orbit.names) == 4
    assert orbit.parameters["preload"] == 810.0 and orbit.parameters["speed"] == disc()[0].parameter
    assert np.isfinite(orbit[orbit.names[3]](np.linspace(0, 1, 5))).all()
    with pytest.raises(ValueError, match=r"^orbit has no 'y'; it has x, x', h, "):
        orbit["y"]


def test_equilibria_are_constants() -> None:
    """Assert that an equilibrium can be read at any time, and has no period."""
    cycle = sym.Equations(
        states={"u": 0.01, "v": 0.0},
        parameters={"mu": sym.parameter("mu", -0.1)},
        function=lambda x, p: {"u": x.v, "v": p.mu * x.v - x.u - x.u**2 * x.v},
    )
    system = sym.compile(cycle)
    assert system.frequency == ("omega",)
    rest = per.trace(system, "mu", (-0.1, 0.2), method=per.Equilibrium())
    still = rest[0].orbit
    assert still["u"](np.zeros(3)) == pytest.approx(0.0, abs=1e-9) and still["u'"].unit == "1/s"
    with pytest.raises(ValueError, match="^orbit is an equilibrium; it has no period$"):
        _ = still.period


@pytest.mark.parametrize("method", list(METHODS))
def test_every_method_names_its_orbits(method: str) -> None:
    """Assert that the orbits of every method can be read, from rest and from a guess."""
    branch = per.trace(duffing_system(0.1, 1.0, 0.5), "Omega", (0.3, 0.5), method=METHODS[method])
    again = per.trace(
        duffing_system(0.1, 1.0, 0.5), "Omega", (3.0, 2.9), method=METHODS[method], guess=duffing()[-1].orbit
    )
    for point in (*branch, *again):
        orbit = point.orbit
        swing = np.ptp(orbit["x"](np.linspace(0, orbit.period, 2001)))
        assert swing == pytest.approx(point.peak_to_peak("x"), rel=1e-5)


def test_a_system_that_does_not_tell_its_frequency() -> None:
    """Assert that without a frequency times are refused, and names still there."""
    orbit = per.trace(LinearOscillator(), "Omega", (0.4, 0.6))[0].orbit
    assert orbit.names == ("x", "v") and orbit.parameters["Omega"] == 0.4
    with pytest.raises(ValueError, match="^times in s are not known; the system must name the parameters"):
        orbit["x"]


def test_an_orbit_measured_by_a_system_of_other_scales() -> None:
    """Assert that every number of an orbit is the same for the disc built at another preload."""
    own, other = loaded(810), loaded(1200)
    assert own.states[0].scale != pytest.approx(other.states[0].scale, rel=0.1)
    orbit, tau = traced(810)[-1].orbit, np.linspace(0, 6, 7)
    expected, found = per.extrema(own, orbit), per.extrema(other, orbit)
    assert found.maximum == pytest.approx(expected.maximum, rel=1e-11)
    assert found.minimum == pytest.approx(expected.minimum, rel=1e-12)
    assert per.outputs(other, orbit, tau) == pytest.approx(per.outputs(own, orbit, tau), rel=1e-9)
    for functional in (per.PeakToPeak("x"), per.Amplitude("load"), per.Multiplier(), per.Value("preload")):
        assert functional(other, orbit) == pytest.approx(functional(own, orbit), rel=1e-11)


def test_a_guess_of_other_scales() -> None:
    """Assert that a branch goes on from an orbit that the system of another preload has found."""
    begin, speed = traced(1200)[0], 300 * RPM
    branch = per.trace(
        loaded(810),
        "speed",
        (speed, 295 * RPM),
        guess=begin.orbit,
        tol=per.Accuracy.DRAFT,
    )
    assert branch[0].orbit.parameters["preload"] == 1200.0
    assert branch[0].peak_to_peak("x") == pytest.approx(begin.peak_to_peak("x"), rel=1e-4)


@pytest.mark.parametrize("scale", [1e-300, 1e-9, 3e-6, 1.0, 7e12])
def test_a_round_trip_over_many_orders(scale: float) -> None:
    """Assert that an orbit expressed in other scales and back is itself, to rounding."""
    orbit = duffing()[12].orbit
    layout = orbit.layout
    assert layout is not None
    other = replace(layout, states=tuple(replace(q, scale=scale) for q in layout.states))
    there = orbit.expressed_in(other)
    assert there["x'"](0.3) == pytest.approx(orbit["x'"](0.3), rel=1e-14)
    np.testing.assert_allclose(there.expressed_in(layout).stages, orbit.stages, rtol=1e-15)
    assert orbit.expressed_in(layout) is orbit


def test_an_orbit_of_another_system_is_refused() -> None:
    """Assert that names that differ are told in one sentence, by measuring and by tracing."""
    y = sym.coordinate("y", unit="rad")
    other = sym.compile(
        sym.Mass(y, 1.0) + sym.Damper(y, 0.1) + sym.Spring(y, 1.0) + sym.HarmonicForce(y, 0.5)
    )
    orbit = replace(duffing()[0].orbit, parameter=np.zeros(5))
    told = "has the states x (m), x' (m); it must have the system's, y (rad), y' (rad)"
    orbit = replace(orbit, parameter=other.nominal)
    with pytest.raises(ValueError, match=f"^{re.escape(f'orbit {told}')}$"):
        per.extrema(other, orbit)
    with pytest.raises(ValueError, match=f"^{re.escape(f'guess {told}')}$"):
        per.trace(other, "Omega", (0.3, 0.5), guess=orbit)


def test_switching_to_a_branch_from_an_orbit_of_other_scales() -> None:
    """Assert that the doubled orbit of a system built at another preload is the same one."""
    own, other = loaded(810), loaded(1200)
    doubling = per.trace(
        own, "speed", (480 * RPM, 640 * RPM), start=640 * RPM, watch=per.Watch(stop={"PD": 1})
    )[-1]
    assert doubling.label is per.Label.DOUBLING
    found, expected = (per.doubled(system, doubling.orbit, "speed") for system in (other, own))
    t = np.linspace(0, expected.period, 50)
    swing = np.ptp(expected["x"](t))
    assert found.period == pytest.approx(expected.period, rel=1e-12)
    assert found["x"](t) == pytest.approx(expected["x"](t), abs=0.2 * swing)


def test_a_layout_fits_its_own_system_alone() -> None:
    """Assert that a system with a state or a parameter more, or another unit, has another layout."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 0.5)
    one = sym.compile(model)
    more = sym.compile(model + sym.Damper(x, 0.1))
    two = sym.compile(model + sym.Mass(y, 1.0) + sym.Spring(y, 1.0))
    turned = sym.coordinate("x", unit="rad")
    other = sym.compile(sym.Mass(turned, 1.0) + sym.Spring(turned, 1.0) + sym.HarmonicForce(turned, 0.5))
    systems = (one, more, two, other)
    for system in systems:
        assert [layout_of(system).fits(another) for another in systems] == [
            another is system for another in systems
        ]
