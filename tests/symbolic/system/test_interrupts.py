"""Ctrl-C within CasADi's own conversion of arguments, which drops the exception of the signal's handler."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import pytest

import symbolic as sym
from symbolic.motion.explicit import rates

System = sym.CompiledSystem


def model() -> sym.Model:
    """A mass on a spring that meets a stop."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Damper(x, 0.1), sym.Spring(x, 1.0), sym.RigidStop(x, 0.2, 0.5)]
    return sym.combine([*parts, sym.HarmonicForce(x, 1.0, 0.8)])


def smooth() -> System:
    """The same without the stop."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Damper(x, 0.1), sym.Spring(x, 1.0), sym.HarmonicForce(x, 1.0, 0.8)]
    return sym.compile(sym.combine(parts))


def linearised(system: System) -> object:
    point = np.zeros((1, 2)), np.zeros((1, 2)), np.zeros((1, 0)), np.zeros(1), system.nominal
    return system.linearise(*point, free=(0,))


def switched(system: System) -> object:
    return system.switch_gradient(np.zeros((1, 2)), np.zeros(1), system.nominal)


MADE: dict[str, Callable[[], Callable[[], object]]] = {
    "compile": lambda: lambda: sym.compile(model()),
    "linearise": lambda: (lambda system: lambda: linearised(system))(smooth()),
    "switches": lambda: (lambda system: lambda: switched(system))(sym.compile(model())),
    "rates": lambda: (lambda system: lambda: rates(system))(smooth()),
    "modes": lambda: (lambda system: lambda: sym.modes(system))(smooth()),
    "response": lambda: (lambda system: lambda: sym.response(system, "Omega", [0.8]))(smooth()),
    "simulate": lambda: (lambda system: lambda: sym.simulate(system, periods=1))(smooth()),
}


@pytest.mark.parametrize("what", MADE)
def test_interrupt_within_a_conversion_is_raised(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert KeyboardInterrupt, and the handler in its place again, where CasADi drops the exception."""
    run, sent = MADE[what](), list[str]()
    monkeypatch.setattr(ca, "DM_from_array", struck(sent, ca.DM_from_array))
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        run()
    assert len(sent) == 1 and signal.getsignal(signal.SIGINT) is before
    run()


def struck(sent: list[str], convert: Callable[..., Any]) -> Callable[..., Any]:
    """The conversion, during whose first call Ctrl-C arrives."""

    def converted(*given: Any) -> Any:
        if not sent:
            sent.append("SIGINT")
            signal.raise_signal(signal.SIGINT)
        return convert(*given)

    return converted
