"""Tests of the surfaces that a compiled system stores."""

from types import SimpleNamespace
from typing import Any, cast

import pytest
from support.models import PARTS, scene

import symbolic as sym
from periodic.system import MINUS, PLUS, STUCK, Kind, System, surfaces_of
from symbolic.equations import surfaces


def machine() -> sym.CompiledSystem:
    """A mass with dry friction, a rigid stop, a soft one and a harmonic force."""
    x, Omega = sym.coordinate("x"), sym.parameter("Omega", 1.3, "rad/s")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.RigidStop(x, 2.0, 0.8), sym.CoulombFriction(x, 0.2)]
    parts += [sym.OneSidedSpring(x, 3.0, gap=1.0), sym.HarmonicForce(x, 1.0, Omega)]
    return sym.compile(sym.combine(parts))


def test_kinds() -> None:
    """Assert kind, guard, releases and column of every surface of a machine."""
    found = [(s.kind, s.switch, s.releases, s.column) for s in machine().surfaces]
    assert found == [
        (Kind.IMPACT, 0, None, None),
        (Kind.SLIDING, 1, (3, 4), 0),
        (Kind.KINK, 2, None, None),
    ]


def test_jump_and_markers() -> None:
    """Assert that a jump of position is a JUMP, and a switch of several levels a MARKER."""
    steep = sym.Equations(
        lambda x, p, wave: {"x": x.v, "v": wave.cos - x.v - sym.functions.sign(x.x)},
        {"x": 0.0, "v": 0.0},
        {"w": 1.0},
        frequency="w",
    )
    assert [(s.kind, s.column) for s in sym.compile(steep).surfaces] == [(Kind.JUMP, 0)]
    assert Kind.MARKER in {s.kind for s in scene("squeeze").surfaces}


@pytest.mark.parametrize("name", ["machine", *PARTS])
def test_every_switch_has_one_surface(name: str) -> None:
    """Assert that guards and releases are all switches; a system that stores no surfaces has the same.

    But for where they may be held, which the system alone knows.
    """
    system = machine() if name == "machine" else scene(name)
    used = [k for s in system.surfaces for k in (s.switch, *(s.releases or ()))]
    assert sorted(used) == list(range(len(system.switches)))
    plain: Any = SimpleNamespace(
        switches=system.switches, jumps=system.jumps, slides=system.slides, resets=system.resets
    )
    for one, other in zip(system.surfaces, surfaces_of(cast(System, plain)), strict=True):
        mine, theirs = ({**vars(each), "place": None} for each in (one, other))
        assert mine == theirs and str(one.kind) == str(other.kind)


def test_same_words_in_both_packages() -> None:
    """Assert that kinds and modes of the two packages are the same."""
    assert list(Kind) == list(surfaces.Kind) and {*Kind} == {*surfaces.Kind}
    assert (MINUS, PLUS, STUCK) == (surfaces.MINUS, surfaces.PLUS, surfaces.STUCK)
