"""Relays in equations: what a model becomes with them."""

from __future__ import annotations

import pickle
from typing import Any

import casadi as ca
import numpy as np
import pytest

import symbolic as sym
from symbolic.equations.surfaces import MINUS, PLUS, Kind
from symbolic.integration.flow import Flow, Trajectory
from symbolic.relays import expression

F = sym.functions
NAMES = {"on": 0.6, "off": -0.4, "push": 2.0}


def chain(x: Any, p: Any) -> dict[str, Any]:
    """A relay, one that compares what it gives, and a condition on that."""
    first = F.relay(x.a, p.on, p.off)
    second = F.relay(x.b + p.push * first, 1.5, 0.5, low=-1, high=3)
    return {
        "a": second - x.a,
        "b": F.if_else(x.b + first > 0.2, 4 * first, 0) + F.relay(x.a, p.on, p.off) - x.b,
    }


def compiled(kernels: str = "numpy") -> sym.CompiledSystem:
    return sym.compile(sym.Equations(chain, {"a": 0.0, "b": 0.0}, NAMES), kernels)


def rates(system: sym.CompiledSystem, a: float, b: float, side: list[float]) -> Any:
    """(a', b') on sides of the jumps, the two relays and the condition."""
    state, none = np.array([[a, b]]), np.zeros((1, 0))
    line = system.linearise_beside(0 * state, state, none, np.zeros(1), system.nominal, np.array([side]))
    return -line.residual[0]


def test_surfaces_of_relays() -> None:
    """Assert two relays though one is called twice, a jump, and columns of all three."""
    system = compiled()
    assert [(s.kind, s.column) for s in system.surfaces] == [(Kind.RELAY, 0), (Kind.RELAY, 1), (Kind.JUMP, 2)]
    assert system.guards_depend and system.surfaces[0].name == "relay at a - on"


def test_equations_in_modes() -> None:
    """Assert the rates in given modes, whatever the state, and by the state where none is given."""
    for kernels in ("numpy", "c"):
        system = compiled(kernels)
        np.testing.assert_allclose(rates(system, 0.1, 0.7, [PLUS, MINUS, PLUS]), [-1.1, 4.3])
        np.testing.assert_allclose(rates(system, 0.1, 0.7, [MINUS, PLUS, PLUS]), [2.9, -0.7])
        np.testing.assert_allclose(rates(system, 0.1, 0.7, [MINUS, PLUS, MINUS]), [2.9, -0.7])
        np.testing.assert_allclose(rates(system, 0.1, 0.7, [0, 0, 0]), [-1.1, -0.7])
        np.testing.assert_allclose(rates(system, 0.7, 0.7, [0, 0, 0]), [2.3, 4.3])


def test_guards_in_modes() -> None:
    """Assert the thresholds of either mode, that of a relay that depends on another, and of the condition."""
    system, state, phase = compiled(), np.array([[0.1, 0.7]]), np.zeros(1)
    sizes = {s.name: s.switch for s in system.surfaces}
    assert len(sizes) == 3

    def guards(side: list[float]) -> Any:
        return system.switch(state, phase, system.nominal, np.array([side]))[0]

    one = guards([MINUS, MINUS, 0])
    np.testing.assert_allclose(one[:2], [0.1 - 0.6, 0.7 - 1.5])
    np.testing.assert_allclose(guards([PLUS, MINUS, 0])[:2], [0.1 + 0.4, 0.7 + 2 - 1.5])
    np.testing.assert_allclose(guards([PLUS, PLUS, 0])[:2], [0.1 + 0.4, 0.7 + 2 - 0.5])
    np.testing.assert_allclose(guards([PLUS, 0, 0])[2] - one[2], 1.0)
    np.testing.assert_allclose(system.switch(state, phase, system.nominal)[0], one)


def test_relays_that_switch_each_other() -> None:
    """Assert that in time the second relay goes on with the first, at one phase."""

    def equations(x: Any, p: Any) -> dict[str, Any]:
        second = F.relay(x.b + p.push * F.relay(x.a, p.on, p.off), 1.5, 0.5)
        return {"a": 1.0, "b": second - x.b}

    system = sym.compile(sym.Equations(equations, {"a": 0.0, "b": 0.0}, NAMES))
    motion = sym.simulate(system, settle=0, periods=1, samples=10, tolerance=1e-10)
    assert [(e.surface, e.after) for e in motion.events if e.phase < 1] == [(0, PLUS), (1, PLUS)]
    np.testing.assert_allclose([e.phase for e in motion.events], 0.6, atol=1e-9)
    np.testing.assert_allclose(motion["b"][-1], 1 - np.exp(0.6 - 2 * np.pi), atol=1e-9)


def test_rates_in_modes() -> None:
    """Assert an acceleration between the thresholds, where the state does not say it."""
    x = sym.coordinate("x")
    push = sym.Equations(lambda x, p: {"x": F.relay(x.x, 0.5, -9.0, -1)}, {}, coordinates=[x])
    system = sym.compile(sym.Mass(x, 1.0) + sym.ConstantForce(x, 0.5) + push)
    motion = sym.simulate(system, {"omega": 2 * np.pi}, knock={"x'": 2.0}, settle=0, samples=50)
    (switched,) = motion.events
    index = list(system.states).index(next(s for s in system.states if s.name == "x'"))
    found = Flow(system).rates(
        Trajectory(motion.phase, motion.state, motion.algebraic, motion.events, motion.modes),
        motion.parameter,
    )[:, index]
    expected = np.where(motion.phase > switched.phase, 1.5, -0.5) / (2 * np.pi) ** 2
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_copies_of_relays() -> None:
    """Assert that a system with relays is pickled, and written in letters."""
    again = pickle.loads(pickle.dumps(sym.compile(sym.Equations(chain, {"a": 0.0, "b": 0.0}, NAMES))))
    assert [s.kind for s in again.surfaces] == [Kind.RELAY, Kind.RELAY, Kind.JUMP]
    assert "relay" in again.latex


@pytest.mark.parametrize("value", [2, 2.0, np.float64(2.0), np.array(2.0), np.array(2), ca.SX(2.0)])
def test_numbers_of_a_relay(value: Any) -> None:
    """Assert that numbers of any kind are one expression."""
    found = expression("u", value)
    assert isinstance(found, ca.SX) and float(found) == 2.0


@pytest.mark.parametrize(
    "value", [True, None, "2", np.array([2.0]), np.array([[2.0]]), [2.0], np.array(True)]
)
def test_what_is_no_number_of_a_relay(value: Any) -> None:
    """Assert the sentence, of arrays that are no scalars too."""
    with pytest.raises(ValueError, match="^on of a relay is .*; it must be an expression or a number$"):
        expression("on", value)
    with pytest.raises(ValueError, match="^off of a relay is .*; it must be one expression or number$"):
        expression("off", ca.SX.zeros(2))
