"""Nonlinear modes with damping against closed forms, elliptic functions and linear eigenvalues."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipj, ellipk

import periodic as per
import symbolic as sym

X = sym.coordinate("x")


def oscillator(*parts: sym.Part) -> sym.CompiledSystem:
    """A mass on a spring, m = k = 1, with parts and a force that its modes do not see."""
    model = sym.Mass(X, 1.0) + sym.Spring(X, 1.0) + sym.HarmonicForce(X, 0.1)
    for part in parts:
        model += part
    return sym.compile(model)


def test_jenkins_has_the_frequency_and_damping_of_the_literature() -> None:
    """Assert both anchors: stuck (exact), and slipping (to the eight digits that are known)."""
    system = oscillator(sym.Damper(X, 0.01), sym.Jenkins(X, 0.25, 0.2))
    branch = per.mode_branch(system, "x", (0.5, 2.0))
    stuck, slipping = branch[0], branch[-1]
    assert stuck.orbit.omega == pytest.approx(math.sqrt(1.25), rel=1e-9)
    assert stuck.columns["damping ratio"] == pytest.approx(0.01 / (2 * math.sqrt(1.25)), rel=1e-9)
    assert slipping.parameter == 2.0
    assert slipping.orbit.omega == pytest.approx(1.04568564, rel=2e-8)
    assert slipping.columns["damping ratio"] == pytest.approx(0.03976646, rel=2e-7)


def test_energy_is_what_dampers_and_joints_dissipate() -> None:
    """Assert that xi puts in what the damper takes, and the joint 4 F (a_max - F / k) in a closed loop."""
    system = oscillator(sym.Damper(X, 0.01), sym.Jenkins(X, 0.25, 0.2))
    point = per.mode_branch(system, "x", (2.0, 2.5), at=2.0, guess=_slipping(system))[0]
    orbit = point.orbit
    t = np.linspace(0, orbit.period, 20001)
    speed = orbit["x'"](t)
    damper = 0.01 * np.trapezoid(speed**2, t)
    top = (orbit["x"](t).max() - orbit["x"](t).min()) / 2
    joint = 4 * 0.2 * (top - 0.2 / 0.25)
    assert point.columns["energy per period"] == pytest.approx(damper + joint, rel=1e-6)


def _slipping(system: sym.CompiledSystem) -> per.Orbit:
    """The mode at an amplitude of 2."""
    return per.mode_branch(system, "x", (0.5, 2.0))[-1].orbit


def test_cubic_backbone_is_that_of_elliptic_functions() -> None:
    """Assert frequency over first harmonic of x'' + x + x^3 = 0 against Jacobi's cn to 1e-8, xi being 0."""
    branch = per.mode_branch(oscillator(sym.CubicSpring(X, 1.0)), "x", (0.1, 2.0), tol=1e-9)
    for point in (branch[0], branch[len(branch) // 2], branch[-1]):
        top = float(point.maximum["x"])
        turn = math.sqrt(1 + top**2)
        m = top**2 / (2 * turn**2)
        quarter = float(ellipk(m))
        omega = math.pi * turn / (2 * quarter)
        harmonic = quad(lambda s, k=quarter, m=m: ellipj(4 * k * s, m)[1] * math.cos(2 * math.pi * s), 0, 1)[
            0
        ]
        assert point.orbit.omega == pytest.approx(omega, rel=1e-8)
        assert point.parameter == pytest.approx(2 * top * harmonic, rel=1e-8)
        assert abs(point.columns["damping ratio"]) < 1e-8


def test_one_sided_spring_has_the_period_of_two_half_waves() -> None:
    """Assert an exact backbone with events: a free oscillation that meets a second spring behind no gap."""
    branch = per.mode_branch(oscillator(sym.OneSidedSpring(X, 3.0)), "x", (0.5, 1.0))
    half = math.pi * (1 + 1 / 2)  # half a period of omega 1 and half of omega 2
    for point in branch:
        assert point.orbit.period == pytest.approx(half, rel=1e-7)


def test_small_amplitudes_have_the_linear_modes_of_a_beam() -> None:
    """Assert frequencies and damping ratios of two modes of a cantilever against its matrices."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2)
    structure = sym.Structure(beam, rayleigh=(0.05, 0.001))
    tip = structure["tip"]
    system = sym.compile(structure + sym.CubicSpring(tip, 3.0) + sym.HarmonicForce(tip, 0.01, 3.0))
    omegas = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(beam.M, beam.K)).real))
    for which in (0, 1):
        point = per.mode_branch(system, "tip", (1e-4, 1e-3), which=which)[0]
        assert point.orbit.omega == pytest.approx(omegas[which], rel=1e-6)
        expected = 0.05 / (2 * omegas[which]) + 0.001 * omegas[which] / 2
        assert point.columns["damping ratio"] == pytest.approx(expected, rel=1e-6)
        form = per.decisions.shape(system.let_go(), point.orbit)
        assert abs(form["tip"]) == pytest.approx(1e-4, rel=1e-6)


def test_synthesis_is_near_the_traced_response() -> None:
    """Assert that the mode alone gives the resonance of a weakly damped oscillator to 1 % of its peak."""
    system = oscillator(sym.Damper(X, 0.05), sym.CubicSpring(X, 0.2))
    modes = per.mode_branch(system, "x", (0.2, 2.5), at=list(np.linspace(0.3, 2.4, 85)))
    found = per.decisions.synthesised(system, modes, "x", {"x": 0.1})
    columns = {"a": per.Amplitude("x")}
    branch = per.trace(system, "Omega", (0.5, 2.0), watch=per.Watch(columns=columns, peaks={}))
    highest = max(point.columns["a"] for point in branch)
    there = found["amplitude"][np.isfinite(found["above"])]
    assert there.max() == pytest.approx(highest, abs=0.03)  # a step of the amplitudes
    for amplitude, below in zip(found["amplitude"], found["below"], strict=True):
        if np.isfinite(below) and 0.8 < amplitude < there.max():
            (point, *_) = branch.at(Omega=float(below))
            assert per.Amplitude("x")(system, point.orbit) == pytest.approx(amplitude, rel=0.01)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"output": "y"}, "output is 'y'; it must be one of x"),
        ({"amplitudes": (0.0, 1.0)}, "must be two different positive numbers"),
        ({"amplitudes": 3}, "must be two positive numbers"),
        ({"which": 1}, "which is 1; the system at rest has 1 modes"),
        ({"values": {"c": math.nan}}, "c"),
    ],
)
def test_bad_input(arguments: dict[str, object], said: str) -> None:
    """Assert one sentence for what is not allowed."""
    given = {"output": "x", "amplitudes": (0.1, 1.0), **arguments}
    with pytest.raises(ValueError, match=said.replace("(", r"\(")):
        per.mode_branch(oscillator(sym.Damper(X, 0.05)), **given)  # type: ignore[arg-type]


def test_equations_have_no_masses() -> None:
    """Assert that what has no inertia that is known is refused in a sentence."""
    equations = sym.Equations(lambda x, p: {"q": x.v, "v": -x.q}, states={"q": 0.0, "v": 0.0})
    with pytest.raises(ValueError, match="the model has no coordinates with masses"):
        per.mode_branch(sym.compile(equations), "q", (0.1, 0.5))


def test_names_that_free_vibrations_need() -> None:
    """Assert that a model with a parameter xi of its own is refused in a sentence."""
    system = sym.compile(
        sym.Mass(X, 1.0) + sym.Spring(X, sym.Parameter("modal damping", 1.0)) + sym.HarmonicForce(X, 0.1)
    )
    with pytest.raises(ValueError, match="parameter .modal damping. has the name"):
        per.mode_branch(system, "x", (0.1, 1.0))
