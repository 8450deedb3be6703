"""Lyapunov exponents: known numbers, multipliers of orbits, and motions beside one another."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.equations import lorenz
from support.oscillators import SYSTEMS, X, oscillator

import periodic as per
import symbolic as sym
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.following.onebyone import OneByOne

pytestmark = pytest.mark.usefixtures("users_kernels")


def test_lorenz() -> None:
    """Assert the known exponents to four standard errors, their sum exactly, and the dimension 2.062."""
    found = per.lyapunov(lorenz(), start={"x": 1.0, "y": 2.0, "z": 20.0}, periods=4000, tol=1e-11)
    assert found.values[0] == pytest.approx(0.9056, abs=4 * found.errors[0])
    assert found.errors[0] < 0.005
    assert found.values[1] == pytest.approx(0.0, abs=1e-3)
    assert found.values.sum() == pytest.approx(-41 / 3, abs=1e-7)
    assert found.dimension == pytest.approx(2.062, abs=0.002)
    assert found.chaotic


@pytest.mark.parametrize(("kind", "parameter"), [("gears", "Omega"), ("impact", "F"), ("gap", "F")])
def test_exponents_of_orbits_are_their_multipliers(kind: str, parameter: str) -> None:
    """Assert log |multiplier| / period through kinks and impacts: the pairs' mean, which converges fast."""
    system = SYSTEMS[kind]()
    found = per.lyapunov(system, periods=400)
    motion = sym.simulate(system, settle=300)
    guess = per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter, system=system)
    value = float(motion.parameter[[p.name for p in system.parameters].index(parameter)])
    once = per.ArclengthControl(max_points=1)
    point = per.trace(system, parameter, (value, 1.01 * value), guess=guess, control=once)[0]
    rates = np.log(np.abs(point.multipliers)) * system.omega(system.nominal) / (2 * math.pi)
    assert found.values.sum() == pytest.approx(rates.sum(), rel=1e-6)
    assert found.values == pytest.approx(np.sort(rates)[::-1], abs=0.02 * np.abs(rates).max())
    assert not found.chaotic and found.dimension == 0.0


@pytest.mark.parametrize("kind", ["gears", "impact", "friction and impact", "rub"])
def test_tangents_are_motions_beside(kind: str) -> None:
    """Assert the growth of tangents by saltation against differences of motions followed one by one."""
    system = SYSTEMS[kind]()
    crowd = Crowd(system, system.nominal, 1e-11)
    begin = crowd.run(crowd.begin(system.rest(system.nominal)[0][None] + 0.05), 30, 2 * math.pi)
    basis = crowd.tangents(begin.ends)
    given = {"modes": begin.modes, "tangents": basis}
    exact = crowd.run(begin.ends, 4, 2 * math.pi, **given)
    beside = OneByOne(system, system.nominal, 1e-11, 1e8).run(begin.ends, 4, 2 * math.pi, **given)
    grown = exact.growth[0, :, 0]
    assert grown == pytest.approx(beside.growth[0, :, 0], abs=2e-3)


def test_neighbours_that_become_one() -> None:
    """Assert minus infinity where friction comes to stick: neighbours are one from then on."""
    found = per.lyapunov(oscillator(sym.CoulombFriction(X, 0.5), omega=0.5), periods=50)
    assert found.values[-1] == -math.inf


def test_without_a_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the same exponents of a system in NumPy, whose motions are followed one by one."""
    monkeypatch.setenv("ORBITRACE_KERNELS", "numpy")
    plain = oscillator(c=0.2)
    assert plain.ensemble(plain.nominal, 1e-9, 1e8) is None
    found = per.lyapunov(plain, periods=20, settle=1)
    assert found.values == pytest.approx([-0.1, -0.1], abs=0.02)
    assert found.values.sum() == pytest.approx(-0.2, rel=1e-5)


def test_refusals() -> None:
    """Assert the sentences for what is not allowed, and for a motion that diverges."""
    system = oscillator()
    with pytest.raises(ValueError, match="exponents is 3; the system has 2 states"):
        per.lyapunov(system, exponents=3)
    with pytest.raises(ValueError, match="a state in start is 'y'; it must be one of x, x'"):
        per.lyapunov(system, start={"y": 1.0})
    with pytest.raises(ValueError, match="periods is 5; it must be a whole number of at least 20"):
        per.lyapunov(system, periods=5)
    with pytest.raises(ValueError, match=r"tol is 0\.1; it must lie between 1e-13 and 0\.001"):
        per.lyapunov(system, tol=0.1)
    with pytest.raises(ValueError, match="value of F is nan; it must be finite"):
        per.lyapunov(system, {"F": math.nan})
    runaway = sym.compile(sym.Equations(lambda x, p: {"x": x.x**2}, states={"x": 1.0}))
    with pytest.raises(per.LyapunovError, match="the motion could not be followed: it diverges"):
        per.lyapunov(runaway)
