"""A contact pair of which parts have spoken: loads and damping, evaluated at numbers."""

from __future__ import annotations

import math

import casadi as ca
import pytest

import symbolic as sym
from symbolic.equations.assembly import Assembly


def at(expression: ca.SX, *given: tuple[ca.SX, float]) -> float:
    """An expression at numbers for symbols."""
    symbols, numbers = ca.vertcat(*(s for s, _ in given)), [number for _, number in given]
    return float(ca.Function("f", [symbols], [ca.SX(expression)])(numbers))


def test_dry_contact_of_two_bodies() -> None:
    """Assert 1 + 2 zeta omega_0 mu v of Q, with K delta^n = Q, on both bodies, and what is put out."""
    x, y, assembly = sym.coordinate("x"), sym.coordinate("y"), Assembly()
    pair = sym.ContactPair(x, y)
    parts = [
        sym.Mass(x, 2.0),
        sym.Mass(y, 6.0),
        sym.Preload(pair, 8.0),
        sym.Hertz(pair, 64.0, 1.5),
        sym.ContactDamping(pair, 0.1),
    ]
    assembly.lay(parts)
    assembly.close()
    motions = [assembly.motion(q) for q in (x, y)]
    given = [(assembly.omega, 3.0)]
    for motion, place, speed in zip(motions, (-0.1, -0.65), (0.5, 0.25), strict=True):
        given += [(motion.position.symbol, place), (motion.velocity.symbol, speed)]
    given += [(s, v) for s, v in ((p, assembly.nominal(p)) for p in parameters(assembly, motions))]
    delta0, mu = 0.25, 1.5
    load = 64.0 * (delta0 + 0.75) ** 1.5
    damping = 2 * 0.1 * math.sqrt(1.5 * 8.0 / delta0 * mu) * 3.0 * 0.75
    for motion in motions:
        assert at(motion.force, *given) == pytest.approx(load - 8.0 - damping)
        assert motion.position.scale == pytest.approx(delta0)
    outputs = {v.name: e for v, e in assembly.outputs}
    assert sorted(outputs) == ["deflection", "load"]
    assert at(outputs["load"], *given) == pytest.approx(load)
    assert at(outputs["deflection"], *given) == pytest.approx(1.0)
    ((info, switch),) = assembly.switches
    assert info.direction == 0 and at(switch, *given) == pytest.approx(4.0)


def parameters(assembly: Assembly, motions: list[sym.equations.terms.Motion]) -> list[ca.SX]:
    """The symbols of the parameters in forces."""
    states = {s.symbol.name() for s in assembly.states} | {"omega"}
    return [s for s in ca.symvar(ca.vertcat(*[m.force for m in motions])) if s.name() not in states]


def test_contact_that_lacks_a_part() -> None:
    """Assert the sentence."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x, name="gap")
    for part in (sym.Preload(pair, 8.0), sym.Hertz(pair, 64.0, 1.5)):
        assembly = Assembly()
        assembly.lay([sym.Mass(x, 1.0), part])
        with pytest.raises(ValueError, match="^contact 'gap' lacks a part; it needs both Preload and Hertz$"):
            assembly.close()
