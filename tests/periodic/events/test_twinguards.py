"""Guards that are one function, always or where friction holds masses together."""

from __future__ import annotations

import symbolic as sym
from periodic.events.rewrites.together import together
from periodic.events.twinguards import holding, twins
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, surfaces_of


def two_masses(*joints: sym.Part) -> sym.CompiledSystem:
    """Two masses x and y, driven, with some joints."""
    model = sym.Mass(X, 1.0) + sym.Mass(Y, 1.0) + sym.Spring(X, 1.0) + sym.Spring(Y, 1.5)
    model = model + sym.Damper(X, 0.05) + sym.Damper(Y, 0.05) + sym.HarmonicForce(X, 1.0)
    for joint in joints:
        model = model + joint
    return sym.compile(model)


X, Y = (sym.coordinate(name, unit="m") for name in "xy")


def guard(system: sym.CompiledSystem, k: int) -> int:
    """The guard of the joint that was added as the k-th, as the surfaces are in that order."""
    return [s for s in surfaces_of(system) if s.releases is not None][k].switch


def test_friction_between_two_masses_makes_guards_one() -> None:
    """Assert that sliders at both are strained alike where it holds."""
    system = two_masses(
        sym.CoulombFriction(X, 0.2, to=Y), sym.Jenkins(X, 0.6, 0.15), sym.Jenkins(Y, 0.5, 0.1)
    )
    friction, one, other = (guard(system, k) for k in range(3))
    assert twins(system, one) == {one: 1}
    assert twins(system, one, [friction]) == {one: 1, other: 1}
    assert twins(system, friction) == {friction: 1}


def test_ends_the_other_way_round() -> None:
    """Assert that a slider between the masses from y to x is beside friction from x to y, with a sign."""
    between = sym.CoulombFriction(X, 0.2, to=Y)
    system = two_masses(between, sym.Jenkins(X, 0.6, 0.15), sym.Jenkins(Y, 0.5, 0.1, to=X))
    friction, one, other = (guard(system, k) for k in range(3))
    assert twins(system, friction) == {friction: 1, other: -1}
    assert twins(system, one, [friction]) == {one: 1}


def test_friction_that_holds_a_strain_between_others() -> None:
    """Assert that friction at x to the ground and to y holds what is strained by y, with signs."""
    ground, between = sym.CoulombFriction(X, 0.2), sym.CoulombFriction(X, 0.3, to=Y)
    system = two_masses(ground, between, sym.Jenkins(Y, 0.5, 0.1))
    to_ground, to_other, slider = (guard(system, k) for k in range(3))
    assert holding(system, slider, [to_ground]) == {}
    assert holding(system, slider, [to_ground, to_other]) == {to_ground: 1, to_other: -1}


def test_a_slider_goes_with_the_friction_that_held_it() -> None:
    """Assert that a slider stopped by friction at its mass, held to another one, is let go with that one."""
    ground, between = sym.CoulombFriction(X, 0.2), sym.CoulombFriction(X, 0.3, to=Y)
    system = two_masses(ground, between, sym.Jenkins(Y, 0.5, 0.1))
    surfaces = [s for s in surfaces_of(system) if s.releases is not None]
    (g, up_g, _), (b, up_b, down_b), (z, up_z, _) = [(s.switch, *(s.releases or ())) for s in surfaces]
    word = [
        (EventNode(b, 1, modes=((b, STUCK),)), 0.5),
        (EventNode(g, -1, modes=((g, STUCK), (z, STUCK))), 1.0),
        (EventNode(down_b, -1), 1.5),
        (EventNode(up_z, 1), 1.5001),
        (EventNode(up_g, 1), 2.0),
        (EventNode(z, -1, modes=((z, STUCK),)), 3.0),
        (EventNode(up_z, 1), 4.0),
    ]
    found = together(system, word, 1e-5)
    assert len(found) == len(word) - 1
    assert (EventNode(down_b, -1, modes=((z, 1),)), 1.5) in found
