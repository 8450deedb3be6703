"""Small functions of the integration: values by hand."""

from __future__ import annotations

import signal
from typing import Any

import numpy as np
import pytest

import symbolic as sym
from symbolic.integration.interrupts import heard


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
        with pytest.raises(KeyboardInterrupt), heard() as raised:
            assert signal.getsignal(signal.SIGINT) is not own
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
            assert len(raised) == 1
        assert told == [signal.SIGINT] and signal.getsignal(signal.SIGINT) is own
        with heard():
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
