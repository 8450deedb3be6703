"""Small functions of the integration: values by hand."""

from __future__ import annotations

import signal
from typing import Any

import numpy as np
import pytest

import symbolic as sym
from symbolic.interrupts import interruptible


def test_handlers_are_put_back() -> None:
    """Assert that the user's handler of Ctrl-C is heard, raised at the end, and in its place again.

    One that another has put in the place of ours meanwhile is left.
    """
    before, told = signal.getsignal(signal.SIGINT), list[int]()

    def own(number: int, frame: Any) -> None:
        told.append(number)
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, own)
    try:
        with pytest.raises(KeyboardInterrupt), interruptible() as raised:
            assert signal.getsignal(signal.SIGINT) is not own
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
            assert len(raised) == 1
        assert told == [signal.SIGINT] and signal.getsignal(signal.SIGINT) is own
        with interruptible():
            signal.signal(signal.SIGINT, signal.SIG_IGN)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


def test_sensitivities_through_kinks() -> None:
    """Assert derivatives in states and parameters by differences, over two periods with several contacts."""
    x, step = sym.coordinate("x"), 1e-6
    parts = [sym.Mass(x, 1.0), sym.Damper(x, 0.1), sym.Spring(x, 1.0), sym.OneSidedSpring(x, 3.0, 0.2)]
    system = sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 1.0, 0.8)]))
    start, values, phase = np.array([0.5, 0.1]), system.nominal, np.linspace(0, 4 * np.pi, 9)

    def states(start: np.ndarray, values: np.ndarray) -> np.ndarray:
        found: np.ndarray = system.flow(start, np.zeros(0), values, phase, (), 1e-12).state
        return found

    found = system.flow(start, np.zeros(0), values, phase, (0, 1), 1e-11).state_gradient
    for k in range(4):
        own, other = step * np.eye(2)[k % 2], step * np.eye(len(values))[k % 2]
        ends = [
            states(start + way * own, values) if k < 2 else states(start, values + way * other)
            for way in (1, -1)
        ]
        assert found[:, :, k] == pytest.approx((ends[0] - ends[1]) / (2 * step), abs=1e-6)


def bouncing() -> sym.CompiledSystem:
    """A mass on a spring beside a stop."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.RigidStop(x, 0.2, 0.5), sym.HarmonicForce(x, 1.0, 0.8)]
    return sym.compile(sym.combine(parts))


def test_sensitivities_through_impacts_are_refused() -> None:
    """Assert the sentence with the phase at which the motion meets the stop."""
    system = bouncing()
    with pytest.raises(
        ValueError, match=r"^the motion meets .* at tau = \d.*; derivatives are known through kinks"
    ):
        system.flow(np.zeros(2), np.zeros(0), system.nominal, np.array([0.0, 6.0]), (), 1e-9)


def kinked() -> sym.CompiledSystem:
    """x'' = -x - 3 max(x - 0.2, 0), without damping."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.OneSidedSpring(x, 3.0, 0.2)]
    return sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 0.0, 1.0)]))


def test_sensitivities_beside_a_kink() -> None:
    """Assert x = sin tau up to the kink at x = 0.2, and frequency 2 after it, however near the phases are."""
    system, meets = kinked(), np.arcsin(0.2)
    offsets = np.array([1e-3, 1e-6, 1e-9, 1e-12])
    phase = np.concatenate([[0.0], meets - offsets, [meets], (meets + offsets)[::-1], [meets + 0.5]])
    found = system.flow(np.array([0.0, 1.0]), np.zeros(0), system.nominal, phase, (), 1e-11)
    assert len(found.state) == len(phase)
    before = phase <= meets
    since, speed = phase - meets, np.cos(meets)
    exact = np.where(before, np.sin(phase), 0.15 + 0.05 * np.cos(2 * since) + speed / 2 * np.sin(2 * since))
    assert found.state[:, 0] == pytest.approx(exact, abs=1e-9)
    rates = np.where(before, np.cos(phase), -0.1 * np.sin(2 * since) + speed * np.cos(2 * since))
    assert found.state[:, 1] == pytest.approx(rates, abs=1e-9)
    turned = np.stack([np.cos(phase), np.sin(phase)], axis=1)
    assert found.state_gradient[before, 0] == pytest.approx(turned[before], abs=1e-8)
    early = np.array([[np.cos(meets), np.sin(meets)], [-np.sin(meets), np.cos(meets)]])
    for k in np.flatnonzero(~before):
        c, s = np.cos(2 * since[k]), np.sin(2 * since[k])
        assert found.state_gradient[k] == pytest.approx(np.array([[c, s / 2], [-2 * s, c]]) @ early, abs=1e-7)


def test_sensitivities_of_what_begins_at_a_kink() -> None:
    """Assert the motion that leaves it into the spring."""
    system = kinked()
    found = system.flow(
        np.array([0.2, 1.0]), np.zeros(0), system.nominal, np.array([0.0, 0.3, 0.6]), (), 1e-11
    )
    tau = np.array([0.0, 0.3, 0.6])
    assert found.state[:, 0] == pytest.approx(0.15 + 0.05 * np.cos(2 * tau) + 0.5 * np.sin(2 * tau), abs=1e-8)
