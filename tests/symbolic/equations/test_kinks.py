"""Kinks and jumps found in any equations: which become switches, by what name, of what size."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import pytest

import symbolic as sym
from symbolic.equations import kinks
from symbolic.equations.assembly import Assembly

F = sym.functions
Force = Callable[[Any, Any, Any], Any]

FORCES: dict[str, tuple[Force, list[str]]] = {
    "max": (lambda x, p, w: -F.fmax(x.x - 1, 0), ["x - 1"]),
    "max of an expression": (lambda x, p, w: -F.fmax(x.x, p.g), ["x - g"]),
    "min of two": (lambda x, p, w: F.fmin(-x.x, w.cos), ["x + cos theta"]),
    "absolute": (lambda x, p, w: -F.fabs(x.v) * x.v, ["v"]),
    "root of a square": (lambda x, p, w: -F.sqrt(x.v**2) * x.v, ["v"]),
    "sign": (lambda x, p, w: -p.g * F.sign(x.v), ["v", "v: slips up", "v: slips down"]),
    "condition": (lambda x, p, w: F.if_else(x.x > 1, 1 - x.x, 0), ["x - 1"]),
    "two conditions": (lambda x, p, w: F.if_else(ca.logic_and(x.x > 1, x.v < 0), -x.x, 0), ["x - 1", "v"]),
    "factor": (lambda x, p, w: -x.x * (x.x >= p.g), ["x - g"]),
    "nested": (lambda x, p, w: -F.fmax(F.fmax(x.x, 0) - 1, x.v), ["x", "(fmax(x,0) - 1) - v"]),
    "twice the same": (lambda x, p, w: -F.fmax(x.x - 1, 0) - F.fmin(3 - 3 * x.x, 0), ["x - 1"]),
    "two clearances": (lambda x, p, w: -F.fmax(x.x - p.g, 0) - F.fmax(x.x - p.h, 0), ["x - g", "x - h"]),
    "phase": (lambda x, p, w: F.fmax(w.cos, 0), ["cos theta"]),
    "parameters alone": (lambda x, p, w: -F.fmax(p.g, 2) * x.x, []),
    "constants": (lambda x, p, w: -float(F.fmax(1.0, 2.0)) * x.x, []),
    "never": (lambda x, p, w: -F.fmax(F.exp(x.x), 1e-300), []),
    "no adhesion": (
        lambda x, p, w: -F.fmax(0, p.g * F.fmax(x.x - 1, 0) ** 1.5 * (1 + x.v)),
        ["x - 1", "1 + v"],
    ),
    "no adhesion in contact": (
        lambda x, p, w: F.fmin(0, -F.if_else(x.x > 1, x.x - 1 + p.g * x.v, 0)),
        ["x - 1", "(x - 1) + (g*v)"],
    ),
    "product": (lambda x, p, w: -F.fabs(2 * x.x * x.v / (1 + x.x**2)), ["2*x", "v"]),
    "never less": (lambda x, p, w: -F.fmax(F.fabs(x.x) * x.v**2, 0), ["x"]),
    "equality": (lambda x, p, w: -F.if_else(x.x == 0, 1, F.sin(x.x) / x.x), []),
}
"""A force each, and the switches that it has; g and h are parameters of one value."""


def compiled(force: Force, **more: Any) -> sym.CompiledSystem:
    """x' = v, v' = force."""
    states, values = {"x": 0.0, "v": 0.0}, {"g": 0.5, "h": 0.5, "w": 1.0}
    function = lambda x, p, w: {"x": x.v, "v": force(x, p, w)}  # noqa: E731
    return sym.compile(sym.Equations(function, states, values, frequency="w", **more))


def names(system: sym.CompiledSystem) -> list[str]:
    """Names of the switches."""
    return [s.name for s in system.switches]


@pytest.mark.parametrize("name", FORCES)
def test_kinks_of_equations_are_switches(name: str) -> None:
    """Assert which switches equations have, and that all are kinks both ways at one level."""
    force, expected = FORCES[name]
    system = compiled(force)
    assert names(system) == expected
    ways = [1 if name.endswith("up") else -1 if name.endswith("down") else 0 for name in expected]
    assert [(s.direction, s.levels) for s in system.switches] == [(way, (0.0,)) for way in ways]


def test_switches_are_of_order_one() -> None:
    """Assert the value of a switch in micrometres, in units of its state."""
    system = compiled(lambda x, p, w: -1e9 * F.fmax(1e3 * (x.x - 2e-6), 0), scales={"x": 1e-6, "v": 1.0})
    values = system.switch(np.array([[3.0, 0.0], [2.0, 0.0]]), np.zeros(2), system.nominal)
    np.testing.assert_allclose(values.ravel(), [1.0, 0.0], atol=1e-12)


def test_declared_switches_count_once() -> None:
    """Assert that declared switches keep their names and that multiples of them are not found again."""
    kinked: Force = lambda x, p, w: -F.fmax(p.h * (x.x - p.g), 0)  # noqa: E731
    system = compiled(kinked, switches=lambda x, p, w: {"touch": (p.g - x.x) / p.g, "edge": x.v})
    assert names(system) == ["touch", "edge"]
    values = system.switch(np.array([[0.25, 3.0]]), np.zeros(1), system.nominal)
    np.testing.assert_allclose(values, [[0.5, 3.0]])


def test_stop_has_its_own_switch_alone() -> None:
    """Assert that a stop, whose law is a max, is not found a second time."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Stop(x, sym.HertzLaw(2.0, 1.0), 0.3)]
    assert names(sym.compile(sym.combine(parts))) == ["x = gap"]


def test_kinks_of_laws_and_parts_of_ones_own() -> None:
    """Assert that a part with a kink that it does not declare has it, named by the velocity in SI."""

    class Ratchet(sym.Part):
        def contribute(self, assembly: Assembly) -> None:
            assembly.motion(x).force -= F.fmax(assembly.speed_of(x), 0)

    x = sym.coordinate("x")
    assert names(sym.compile(sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + Ratchet())) == ["dx/dt"]


@pytest.mark.parametrize("scene", sym.scene_names())
def test_scenes_have_declared_switches_alone(scene: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that no guard against overflow in a part is taken for a kink, and no kink is undeclared."""
    found = names(sym.scene(scene))
    monkeypatch.setattr(kinks, "find", lambda assembly: None)
    assert names(sym.scene(scene)) == found


def test_switches_of_unknowns_are_refused() -> None:
    """Assert the sentence for a switch that is no function of state and phase; a kink in one is no switch.

    Of a product the factors of the states are.
    """
    with pytest.raises(ValueError, match="switch 'closed' depends on the unknown z; it must be a"):
        sym.compile(
            sym.Equations(
                lambda x, p: {"x": -x.z, "z": x.z - x.x},
                {"x": 0.0},
                unknowns={"z": 0.0},
                switches=lambda x, p: {"closed": x.z},
            )
        )
    kinked = sym.Equations(
        lambda x, p: {"x": -F.fmax(x.z, 0), "z": x.z - x.x}, {"x": 0.0}, unknowns={"z": 0.0}
    )
    assert names(sym.compile(kinked)) == []
    product = sym.Equations(
        lambda x, p: {"x": -F.fmax(x.x * x.z, 0), "z": x.z - x.x}, {"x": 0.0}, unknowns={"z": 0.0}
    )
    assert names(sym.compile(product)) == ["x"]
    with pytest.raises(ValueError, match="switches is 3; it must be a function of x and p"):
        sym.Equations(lambda x, p: {"x": -x.x}, {"x": 0.0}, switches=3)
