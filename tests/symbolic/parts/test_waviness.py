"""Corrugations that begin gradually: the profile over the phase."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

import symbolic as sym
from symbolic.arrays import Array
from symbolic.equations.assembly import Assembly
from symbolic.parts.contact.pair import junction_of

PAIR = sym.ContactPair(sym.coordinate("x"))
A, WAVES, SPEED = 2e-6, 12.0, 5.0
OMEGA = WAVES * SPEED


def profile(part: sym.Waviness | sym.RampedWaviness, phase: Array) -> tuple[Array, float]:
    """What it adds to the gap at some phases, and the frequency of the excitation in rad/s."""
    assembly = Assembly()
    part.contribute(assembly)
    tau, numbers = ca.SX.sym("tau"), list(assembly.numbers.named().values())
    given = ca.vertcat(*[symbol for _, symbols in numbers for symbol in symbols])
    values = [parameter.value for parameter, symbols in numbers for _ in symbols]
    excitation = assembly.excitation
    over = assembly.with_frequency(excitation.timed(junction_of(assembly, PAIR).profile, tau))
    over = ca.substitute(over, excitation.symbols, excitation.values(tau))
    call = ca.Function("profile", [tau, given], [over, assembly.with_frequency(assembly.omega)])
    found, omega = call(phase[None, :], np.tile(values, (len(phase), 1)).T)
    return np.array(found)[0], float(omega[0])


def test_waves_of_one_amplitude() -> None:
    """Assert a sine of the phase whose frequency is that of waves passing."""
    phase = np.linspace(-4.0, 9.0, 27)
    found, omega = profile(sym.Waviness(PAIR, A, WAVES, SPEED), phase)
    assert omega == pytest.approx(OMEGA)
    assert found == pytest.approx(A * np.sin(phase), abs=1e-12 * A)


@pytest.mark.parametrize("rate", [0.1 * OMEGA, OMEGA, 5 * OMEGA])
def test_ramp_goes_over_into_waves(rate: float) -> None:
    """Assert a rise exp(rate t) before the joint, waves after it, and one height and slope at it."""
    joint = np.arctan(OMEGA / rate)
    part = sym.RampedWaviness(PAIR, A, WAVES, SPEED, rate)
    after = joint + np.linspace(0.0, 6.0, 25)
    assert profile(part, after)[0] == pytest.approx(A * np.sin(after), abs=1e-12 * A)
    before = joint - np.linspace(0.0, 4.0, 17)
    found, omega = profile(part, before)
    assert omega == pytest.approx(OMEGA)
    risen = np.exp((before - joint) * rate / OMEGA)
    assert found == pytest.approx(A * np.sin(joint) * risen, rel=1e-12)
    step = 1e-5
    below, at, above = profile(part, joint + step * np.array([-1.0, 0.0, 1.0]))[0]
    assert (above - at) / step == pytest.approx(
        (at - below) / step, abs=2 * A * step * (1 + rate / OMEGA) ** 2
    )
